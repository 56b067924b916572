#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "gst/overlay/canvas.hpp"

/// Lays what is drawn over a buffer as GstVideoOverlayCompositionMeta, on top of what it carries
/// already. Pixels of the buffer are neither read nor written; the buffer itself must be writable.
/// Allocates copies of what is drawn, in rectangles of at most 256 px a side.
void attach_composition(GstBuffer* buffer, const Canvas& canvas);
