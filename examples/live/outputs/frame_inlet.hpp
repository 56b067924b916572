#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include "examples/live/pipeline/frame.hpp"

namespace live {

/// The piece of a gst-launch line that push_frame() fills: an appsrc of this name, which forgets
/// its oldest frames rather than let anybody wait.
[[nodiscard]] std::string frame_inlet(const std::string& name, int most_frames);

/// Gives a frame to such an appsrc, stamped with the time of its own pipeline. Any thread; never
/// waits; copies no pixel.
void push_frame(GstAppSrc* inlet, const Frame& frame);

}  // namespace live
