#pragma once  // SPDX-License-Identifier: MIT

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Where to look for the target in the next frame: its box, with a margin of (expansion - 1)
/// semi-major axes on every side, clipped to the frame. CalculateROI of [Keipour2021] Algorithm 2.
/// The margin is the same on all sides, because a target seen flat moves as far as a round one.
///
/// The region starts at multiples of `scale`, so that reducing it moves no pixel by a fraction.
/// Empty where nothing of it lies in the frame.
[[nodiscard]] Rect calculate_roi(
    const Ellipse& target, double expansion, int scale, int frame_width, int frame_height);

}  // namespace ellipse
