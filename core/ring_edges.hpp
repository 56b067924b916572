#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>
#include <vector>

#include "core/arcs.hpp"
#include "core/detector.hpp"
#include "core/ellipse.hpp"
#include "core/image_view.hpp"
#include "core/picture_refinement.hpp"

namespace ellipse {

/// The two edges of a painted ring.
struct RingEdges {
  Ellipse outer;
  Ellipse inner;
};

/// Where the edges of a thin ring are that were found as crests of the gradient.
///
/// Smoothing draws the two edges of a bar apart, the more, the thinner it is: a bar without width
/// has its crests two standard deviations of the blur from each other. What lies between them stays
/// in place, and the share of the ring in its radius is the same all around; so one number tells
/// both edges. Edges that are far apart stay as they are. The paint is taken to be as different
/// from what is inside as from what is outside, and the lens to be in focus, as for kCrestShift.
///
/// Own derivation, see docs/provenance.md. Allocates nothing.
[[nodiscard]] RingEdges without_repulsion(const RingEdges& crests);

/// A ring cannot be thinner than this to be told from a line: inner over outer radius.
inline constexpr double kThinnestRing = 0.97;

/// Same centre and shape, another radius, as the two edges of a ring at least this thick.
[[nodiscard]] bool are_partners(const Ellipse& a,
                                const Ellipse& b,
                                double largest_ratio = kThinnestRing);

/// Corrects the edges of thin rings among detections.
class RingCorrector {
 public:
  RingCorrector();

  /// Looks for the next edge of each among the others, then on the picture. Where both have the
  /// same contrast, the detection's ellipse becomes the true edge.
  /// @param least_gradient  Of an edge [units of Gradient].
  /// @param polarities      Of the detections.
  /// Allocates only while it has not yet seen as many detections.
  void correct(const ImageView& luma,
               double least_gradient,
               std::span<const Polarity> polarities,
               const LensView& lens,
               std::span<Detection> detections);

 private:
  [[nodiscard]] std::optional<RefinedEllipse> next_edge(const ImageView& luma,
                                                        double least_gradient,
                                                        std::span<const Polarity> polarities,
                                                        const LensView& lens,
                                                        std::size_t i) const;

  std::vector<Ellipse> crests_;  // the detections, not yet corrected
};

}  // namespace ellipse
