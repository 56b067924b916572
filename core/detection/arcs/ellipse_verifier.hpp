#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <vector>

#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// A candidate on the edges around it, and what they say of it.
struct MeasuredEllipse {
  Ellipse ellipse;
  Polarity polarity = Polarity::kDarkInside;
  double support = 0.0;     ///< Share of the inside perimeter that has edges, by length.
  double on_ellipse = 0.0;  ///< Share of these edges that lie on the ellipse.
  Features features{};
  double probability = 0.0;  ///< That it is an ellipse, by the evidence table.
  int candidate = -1;        ///< As in Detection.
  Verdict as_target = {};    ///< As in Detection.
};

/// Fits a guessed ellipse to the edges around it, and measures what they say of it.
///
/// Rigid and deformed outlines are one model: how far the edges leave the ellipse is a feature.
/// A candidate that cannot reach the wanted probability any more is dropped on the way.
class EllipseVerifier {
 public:
  /// Whether axes, ratio and place are such that it is worth a look.
  [[nodiscard]] static Verdict judge_shape(const Ellipse& e,
                                           const GradientMap& map,
                                           const Thresholds& thresholds);

  /// @param measured      Written where edges were found along the outline.
  /// @return Why it is rejected.
  [[nodiscard]] Verdict verify(const GradientMap& map,
                               const Ellipse& guess,
                               Polarity polarity,
                               const Thresholds& thresholds,
                               const EvidenceTable& table,
                               MeasuredEllipse& measured);

  /// How far the edge of a deformed pad of this size may leave its ellipse [px].
  [[nodiscard]] static double deformation_px(const Ellipse& e);

 private:
  [[nodiscard]] Verdict approach(const GradientMap& map,
                                 const Thresholds& thresholds,
                                 const EvidenceTable& table,
                                 MeasuredEllipse& measured);
  [[nodiscard]] Verdict judge_prospect(double max_growth,
                                       const Thresholds& thresholds,
                                       const EvidenceTable& table,
                                       const MeasuredEllipse& measured) const;
  [[nodiscard]] Verdict judge_edges() const;
  [[nodiscard]] std::optional<Ellipse> nearer_to_edges(const Ellipse& e, double reach_px) const;
  void measure(const GradientMap& map,
               std::size_t samples,
               double reach_px,
               MeasuredEllipse& measured);
  [[nodiscard]] double straight_share();

  EdgeMeasurer measurer_;
  std::vector<double> direction_errors_;
  std::vector<double> angles_;
};

}  // namespace ellipse
