#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <vector>

#include "core/detection/thresholds.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/edges/perimeter.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// An ellipse that its edges speak for.
struct VerifiedEllipse {
  Ellipse ellipse;
  Polarity polarity = Polarity::kDarkInside;
  double inside_fraction = 0.0;  ///< Of the perimeter inside the picture.
  double support = 0.0;          ///< Share of the inside perimeter that meets edges, by length.
  double turn_support = 0.0;     ///< The same by turn, of which a flat ellipse's ends have most.
  double on_ellipse = 0.0;       ///< Share of these edges that lie on the ellipse.
  double covered = 0.0;          ///< Share of the whole perimeter that fits well.
  double score = 0.0;            ///< Significance: -ln of the odds that chance made it [nats].
  bool is_deformed = false;      ///< Its edge leaves the ellipse, smoothly.
  bool needs_partner = false;    ///< Too little by itself: counts beside a concentric one only.
  int candidate = -1;            ///< As in Detection.
};

/// What it takes to tell an ellipse from chance in a picture.
struct Caution {
  double edge_density = 0.0;  ///< Share of the picture's pixels that are chained gradient maxima.
  double min_score = 62.0;    ///< Of an ellipse [nats].
};

/// Fits a guessed ellipse to the edges around it, and decides whether they make one.
///
/// The evidence is weighed a contrario [Desolneux2000]: by how unlikely it is that edges which lie
/// about by chance agree so well in place and direction. An ellipse that fails as an exact one has
/// a second chance as a deformed one: then its edge may leave it, but along a smooth curve whose
/// slope is the edge's own.
class EllipseVerifier {
 public:
  /// A quick look: whether enough edges are near the guess.
  [[nodiscard]] static Verdict judge_promise(const GradientMap& map,
                                             const Ellipse& guess,
                                             Polarity polarity,
                                             const Thresholds& thresholds);

  /// @param thresholds  Axes, ratio, overlaps and contour size.
  /// @param found       Written where it is accepted.
  /// @return Why not, as an exact ellipse: as a deformed one it was refused too.
  [[nodiscard]] Verdict verify(const GradientMap& map,
                               const Caution& caution,
                               const Ellipse& guess,
                               Polarity polarity,
                               const Thresholds& thresholds,
                               VerifiedEllipse& found);

  /// Whether axes, ratio and place are such that it is worth a look.
  [[nodiscard]] static Verdict judge_shape(const Ellipse& e,
                                           const GradientMap& map,
                                           const Thresholds& thresholds);

  /// How far the edge of a deformed pad of this size may leave its ellipse [px].
  [[nodiscard]] static double deformation_px(const Ellipse& e);

 private:
  struct Request;

  [[nodiscard]] Verdict verify_exact(const Request& request, VerifiedEllipse& result);
  [[nodiscard]] std::optional<VerifiedEllipse> verify_deformed(const Request& request);
  [[nodiscard]] Verdict approach(const Request& request, Ellipse& e);
  [[nodiscard]] Verdict improve(const Request& request, Ellipse& e, double reach_px) const;
  [[nodiscard]] double median_residual();
  [[nodiscard]] double median_direction_error();
  struct Smoothness;
  [[nodiscard]] Smoothness smoothness(int samples, const PerimeterEvidence& evidence);

  PerimeterProbe probe_;
  std::vector<double> values_;
  std::vector<double> slopes_;
  std::vector<int> hit_of_sample_;
};

}  // namespace ellipse
