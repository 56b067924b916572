#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// How far from an edge a pixel may be to tell anything of its place [px].
inline constexpr double kPhotometricBandPx = 3.8;
/// A band that is narrower on its inside does not tell the edge from what lies there [px].
inline constexpr double kMinPhotometricBandPx = 2.8;

/// Refines an ellipse that is known within about half a pixel, from the brightness of every pixel
/// beside its perimeter: a step between two levels, blurred by the lens.
///
/// One Gauss-Newton step towards the least squares of brightness, by sectors: each has two levels
/// that it shares with its neighbours, and an offset of its own. An ellipse is laid through the
/// offsets with Tukey's weights, so that sectors that show something else do not count. Within 1.6
/// times the Cramer-Rao bound of the centre for edges in focus, from 12 px on.
///
/// @param inside_px       No other edge of the target is as near to the perimeter, inside it.
/// @param min_contrast  Of the two levels [grey levels].
/// @return nullopt where fewer than half of the sectors inside the picture show the step, or where
///         the band is too narrow. Allocates nothing; O(perimeter), up to a few hundred pixels.
[[nodiscard]] std::optional<FittedEllipse> refined_photometrically(const ImageView& luma,
                                                                   const Ellipse& e,
                                                                   Polarity polarity,
                                                                   double inside_px,
                                                                   double min_contrast);

}  // namespace ellipse
