#pragma once  // SPDX-License-Identifier: MIT

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Default expansion: a margin of one semi-major axis. Also used where a target is judged or
/// searched again.
inline constexpr double kRoiExpansion = 2.0;

/// Search region around a target, in the next frame or at a finer scale: its box with a margin of
/// (expansion - 1) semi-major axes on every side, clipped to the frame. CalculateROI of
/// [Keipour2021] Algorithm 2.
/// The margin is the same on all sides, because the motion does not depend on the aspect ratio.
///
/// The region starts at multiples of `scale`, so that reduction causes no subpixel shift.
/// Empty if it lies outside the frame.
[[nodiscard]] Rect calculate_roi(
    const Ellipse& target, double expansion, int scale, int frame_width, int frame_height);

}  // namespace ellipse
