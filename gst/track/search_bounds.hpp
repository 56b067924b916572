#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "core/image/image_view.hpp"
#include "gst/track/track_properties.hpp"

/// The search region of a buffer [px of the whole frame]: the intersection of its GstVideoCropMeta
/// and the region of roi-source, which is the bounding box if there are several. Empty if nothing
/// is to be searched. Allocates nothing; thread-safe.
[[nodiscard]] ellipse::Rect search_bounds(GstBuffer* buffer,
                                          const GstVideoInfo& info,
                                          const TrackProperties& properties);
