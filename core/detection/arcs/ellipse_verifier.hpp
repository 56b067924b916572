#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <vector>

#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// A candidate fitted to the edges around it, and their evidence.
struct MeasuredEllipse {
  Ellipse ellipse;
  Polarity polarity = Polarity::kDarkInside;
  double support = 0.0;     ///< Share of the perimeter inside the picture with edges, by length.
  double matched_px = 0.0;  ///< Length of the perimeter with edges, in the picture.
  double on_ellipse = 0.0;  ///< Share of these edges on the ellipse, by length.
  double gradient = 0.0;    ///< Mean of these edges [units of Gradient].
  Features features{};
  double probability = 0.0;  ///< Of being an ellipse, by the evidence table.
  int candidate = -1;        ///< As in Detection.
  Verdict as_target = {};    ///< As in Detection.
};

/// Fits a candidate ellipse to the edges around it and measures their evidence.
///
/// Rigid and deformed outlines share one model: the edges' deviation from the ellipse is a feature.
/// So do outlines of one and of mixed polarity: the changes of polarity are a feature.
/// Rejects a candidate early once it is unlikely to reach the minimum probability.
class EllipseVerifier {
 public:
  /// Rejects candidates by axes, axis ratio and position before any measurement.
  [[nodiscard]] static Verdict judge_shape(const Ellipse& e,
                                           const GradientMap& map,
                                           const Thresholds& thresholds);

  /// The polarity with more edges on the outline; not kMixed.
  [[nodiscard]] Polarity better_polarity(const GradientMap& map, const Ellipse& e);

  /// @param measured  Always written; its probability only if the last fit has enough edges.
  /// @return Accepted, or why it is rejected.
  [[nodiscard]] Verdict verify(const GradientMap& map,
                               const Ellipse& guess,
                               Polarity polarity,
                               const Thresholds& thresholds,
                               const EvidenceTable& table,
                               MeasuredEllipse& measured);

  /// Largest distance between a deformed pad's edge and its ellipse `e` [px].
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
  std::size_t measure(const GradientMap& map,
                      std::size_t samples,
                      double reach_px,
                      MeasuredEllipse& measured);
  void set_features(const OutlineSupport& found,
                    std::size_t samples,
                    double reach_px,
                    double texture,
                    MeasuredEllipse& measured);

  EdgeMeasurer measurer_;
  std::vector<double> direction_errors_;
};

}  // namespace ellipse
