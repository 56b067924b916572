#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <optional>
#include <span>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/track_properties.hpp"

/// Its name in metadata, JSON lines, messages and statistics. Lives as long as the program.
[[nodiscard]] const gchar* nick_of(ellipse::TrackerState state);

/// Attaches what was found in a frame to its buffer: that it was searched, and what the tracker was
/// doing; the target; where the properties ask for it, the target's upright box inside the frame as
/// the standard metadata for a region of interest, with the target's structure as its parameter,
/// and all other ellipses with the role "candidate".
/// @param tracker  That which found it: for its state, its candidates and its lens.
/// @return The target's metadata, owned by the buffer; nullptr where there is no target.
const GstEllipseMeta* attach_metas(GstBuffer* buffer,
                                   const std::optional<ellipse::Target>& target,
                                   const ellipse::Tracker& tracker,
                                   const TrackProperties& properties,
                                   const GstVideoInfo& info,
                                   GstClockTime processing_time);
