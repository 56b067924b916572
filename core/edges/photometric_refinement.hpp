#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Refines an ellipse that is known within about half a pixel, from the brightness of every pixel
/// beside its perimeter: a step between two levels, blurred by the lens.
///
/// Two Gauss-Newton steps on the brightness residuals by sectors; the first also fits the blur.
/// Each sector shares two levels with its neighbours and has its own offset. An ellipse is fitted
/// to the offsets with Tukey's weights, which reject outliers. Within 1.6 times the Cramer-Rao
/// bound of the centre for edges in focus, from 12 px on.
///
/// @param inside_px     Distance to the target's next edge inside the perimeter; nothing is
///                      found if the two blurred edges overlap.
/// @param min_contrast  Smallest difference of the two levels [grey levels].
/// @return nullopt if fewer than 8 or than half of the sectors inside the picture show the step, or
///         the band is too narrow. Allocates nothing; O(perimeter), up to a few hundred pixels.
[[nodiscard]] std::optional<FittedEllipse> refined_photometrically(const ImageView& luma,
                                                                   const Ellipse& e,
                                                                   Polarity polarity,
                                                                   double inside_px,
                                                                   double min_contrast);

}  // namespace ellipse
