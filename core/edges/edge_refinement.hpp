#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/camera/lens_view.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// An ellipse on the picture.
struct RefinedEllipse {
  Ellipse ellipse;
  RingUncertainty uncertainty;
  double support = 0.0;   ///< Share of the perimeter inside the picture that meets the edge.
  double gradient = 0.0;  ///< Mean of these gradient maxima [units of Gradient].
};

inline constexpr std::size_t kRefinementSamples = 96;

/// Refines an ellipse that is known within a pixel or two, on the picture itself: looks for the
/// gradient maximum across its perimeter at some samples, and computes no gradient elsewhere.
///
/// @param samples  As of OutlineSamples. With fewer it is faster, and the noise tells more.
/// @param min_gradient  Weaker gradient maxima do not count [units of Gradient].
/// @param lens    The ellipse is of the ideal plane, before and after; the perimeter is searched as
///                the lens distorts it.
/// @return nullopt where too few gradient maxima are near. Allocates nothing; the time depends on
/// no size.
[[nodiscard]] std::optional<RefinedEllipse> refined_on_picture(
    const ImageView& luma,
    const Ellipse& e,
    Polarity polarity,
    double min_gradient,
    std::size_t samples = kRefinementSamples,
    const LensView& lens = {});

}  // namespace ellipse
