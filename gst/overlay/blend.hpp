#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "gst/overlay/canvas.hpp"

/// Blends the canvas into a frame of the same size that is mapped for writing, in the frame's own
/// format and colorimetry. A chroma sample gets the mean of the pixels that share it. Only
/// samples under the drawing change; an alpha channel becomes opaque there. Thread-safe, allocates
/// nothing.
void blend(const Canvas& canvas, GstVideoFrame& frame);
