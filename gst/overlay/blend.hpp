#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "gst/overlay/canvas.hpp"

/// Blends what is drawn into a frame of the canvas's size that is mapped for writing, in the
/// frame's own 8-bit format and colorimetry. A sample of chroma gets the mean of the pixels that
/// share it; nothing else is touched. An alpha channel becomes opaque where it is drawn on.
/// Thread-safe, allocates nothing.
void blend(const Canvas& canvas, GstVideoFrame& frame);
