#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <optional>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/analytics_meta.hpp"
#include "gst/track/track_properties.hpp"

/// The name of a state in metadata, JSON lines, messages and statistics. Static string.
[[nodiscard]] const gchar* nick_of(ellipse::TrackerState state);

/// Attaches the results of a frame to its buffer: the search metadata with the tracker's state; the
/// target; if the properties enable them, the target's bounding box inside the frame as
/// GstVideoRegionOfInterestMeta, with the target's structure as its parameter, all other ellipses
/// with the role "candidate", and the target and these as objects in GstAnalyticsRelationMeta.
/// @param tracker   Its state, candidates and lens are read.
/// @param sighting  Of the target.
/// @return The target's metadata, owned by the buffer; nullptr if there is no target.
const GstEllipseMeta* attach_metas(GstBuffer* buffer,
                                   const std::optional<ellipse::Target>& target,
                                   const ellipse::Tracker& tracker,
                                   const TrackProperties& properties,
                                   const GstVideoInfo& info,
                                   const Sighting& sighting,
                                   GstClockTime processing_time);
