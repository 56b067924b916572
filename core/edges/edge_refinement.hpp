#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/camera/picture.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {

/// An ellipse refined on the picture.
struct RefinedEllipse {
  Ellipse ellipse;
  RingUncertainty uncertainty;
  double support = 0.0;   ///< Share of the perimeter inside the picture matched by edges.
  double gradient = 0.0;  ///< Mean gradient of these edges [units of Gradient].
};

/// Samples of the outline, as of OutlineSamples.
inline constexpr std::size_t kRefinementSamples = 96;

/// Refines an ellipse that is known within a pixel or two on the picture itself: finds the gradient
/// maximum across its perimeter at each sample and computes no gradient elsewhere.
///
/// @param samples  As of OutlineSamples. Fewer samples are faster and noisier.
/// @param min_gradient  Weaker gradient maxima do not count [units of Gradient].
/// @param picture  Its lens distorts the perimeter for the search; `e` and the result are in the
///                 ideal plane.
/// @return nullopt if too few gradient maxima are near or the fit fails. Allocates nothing;
///         O(samples).
[[nodiscard]] std::optional<RefinedEllipse> refined_on_picture(
    const Picture& picture,
    const Ellipse& e,
    Polarity polarity,
    double min_gradient,
    std::size_t samples = kRefinementSamples);

}  // namespace ellipse
