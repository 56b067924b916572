#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// Looks for a pad's circles in a coarse picture of what surrounds its expected place: 64 x 64
/// cells in which the pad is round, moved over all shifts and three sizes.
///
/// @param view  Where it is expected.
/// @return The view of the ideal plane in which its circles agree best; nullopt where they agree
/// nowhere. Allocates nothing; the time depends on no size.
[[nodiscard]] std::optional<Eigen::Matrix3d> coarse_search(const ImageView& luma,
                                                           const PadModel& model,
                                                           const PadView& view);

}  // namespace ellipse
