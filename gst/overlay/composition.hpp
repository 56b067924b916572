#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "gst/overlay/canvas.hpp"

/// Attaches the canvas to a buffer as GstVideoOverlayCompositionMeta, on top of existing overlays.
/// The buffer must be writable; its pixels are neither read nor written. Allocates copies of the
/// drawing in rectangles of at most 256 px a side.
void attach_composition(GstBuffer* buffer, const Canvas& canvas);
