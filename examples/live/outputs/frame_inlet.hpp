#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Start of a gst-launch line for push_frame(): an appsrc with this name. It never blocks; when
/// full, it drops its oldest frames.
[[nodiscard]] std::string frame_inlet(const std::string& name, int max_frames);

/// Pushes a frame into such an appsrc, timestamped by that pipeline's clock. Thread-safe; never
/// blocks; copies no pixel.
void push_frame(GstAppSrc* inlet, const Frame& frame);

}  // namespace live
