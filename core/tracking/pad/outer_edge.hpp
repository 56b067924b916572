#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {

/// Max difference of an outer edge and its prediction, or of a locked edge and its detection.
inline constexpr Tolerance kOuterEdgeTolerance{1.0, 0.03};

/// Refines the outer edge of a pad whose view is accurate to about a pixel.
///
/// @param gain       Ratio of image contrast to model contrast.
/// @param motion_px  As of motion_blur(); zero = unknown.
/// @return The edge in the image's ideal plane; nullopt with Refinement::kNone, if too little of it
///         is visible, or if it is too far from the predicted edge. Allocates nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_outer_edge(const ImageView& luma,
                                                              const PadView& view,
                                                              const PadModel& model,
                                                              double gain,
                                                              Refinement refinement,
                                                              const Eigen::Vector2d& motion_px);

/// Refines an inner circle of a pad by gradient maxima.
///
/// @return The circle in the image's ideal plane; nullopt if too little of it is visible. Allocates
///         nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_circle(const ImageView& luma,
                                                          const PadView& view,
                                                          const PadCircle& circle,
                                                          double gain,
                                                          const Eigen::Vector2d& motion_px);

}  // namespace ellipse
