#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "core/image/image_view.hpp"
#include "gst/track/track_properties.hpp"

/// Where a buffer is searched [px of the whole frame]: what its GstVideoCropMeta leaves of the
/// frame, and of that what roi-source points to. The box around all regions, where there are
/// several. Empty where nothing is to be searched. Allocates nothing; thread-safe.
[[nodiscard]] ellipse::Rect search_bounds(GstBuffer* buffer,
                                          const GstVideoInfo& info,
                                          const TrackProperties& properties);
