#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// Searches a pad's circles around its expected position, in 64 x 64 cells that are resampled so
/// that the pad is round. Tests all shifts and three sizes.
///
/// @param view  Expected view.
/// @return The view in the ideal plane with the best agreement; nullopt if it is too low anywhere.
///         Allocates nothing; the run time does not depend on the size of the image or the pad.
[[nodiscard]] std::optional<Eigen::Matrix3d> coarse_search(const ImageView& luma,
                                                           const PadModel& model,
                                                           const PadView& view);

}  // namespace ellipse
