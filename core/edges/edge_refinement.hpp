#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/camera/picture.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {

/// Samples of the outline, as of OutlineSamples.
inline constexpr std::size_t kRefinementSamples = 96;

/// Refines an ellipse that is known within a pixel or two on the picture itself: finds the gradient
/// maximum across its perimeter at each sample and computes no gradient elsewhere.
///
/// @param picture       Its lens distorts the perimeter for the search; `e` and the result are of
///                      the ideal plane.
/// @param min_gradient  Smallest gradient of an edge [units of Gradient].
/// @return nullopt if too few edges for a fit are near, or the fit fails. Allocates nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_on_picture(const Picture& picture,
                                                              const Ellipse& e,
                                                              Polarity polarity,
                                                              double min_gradient);

/// Refines an ellipse on the edges that were measured along it: the last step of
/// refined_on_picture().
[[nodiscard]] std::optional<FittedEllipse> fitted_to_edges(const EdgeMeasurer& measurer,
                                                           const LensView& lens,
                                                           const Ellipse& e);

}  // namespace ellipse
