#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/arcs.hpp"
#include "core/ellipse.hpp"
#include "core/image_view.hpp"

namespace ellipse {

/// Refines an ellipse that is known within a pixel or two, on the picture itself: looks for the
/// crest of the gradient across its perimeter at some places, and computes no gradient elsewhere.
///
/// @param least_gradient  Weaker crests do not count [units of Gradient].
/// @return nullopt where too few crests are near. Allocates nothing; the time depends on no size.
[[nodiscard]] std::optional<Ellipse> refined_on_picture(const ImageView& luma,
                                                        const Ellipse& e,
                                                        Polarity polarity,
                                                        double least_gradient);

/// How far inside a curved edge the crest of its smoothed gradient lies [px], per curvature
/// [1/px]: smoothing with variance v along an edge of curvature k draws its crest in by v k / 2.
inline constexpr double kCurvatureBias = 0.5;

}  // namespace ellipse
