#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay/overlay.hpp"
#include "gst/track/gstellipsetrack.h"
#include "gst/track/lateness.hpp"
#include "gst/track/load_watch.hpp"
#include "gst/track/track_properties.hpp"
#include "gst/track/track_stats.hpp"

GST_DEBUG_CATEGORY_EXTERN(gst_ellipse_track_debug);
#define GST_CAT_DEFAULT gst_ellipse_track_debug

/// What the streaming thread keeps from frame to frame.
struct TrackStream {
  ellipse::Tracker tracker;
  Overlay overlay;
  LoadWatch load;
  guint64 frame = 0;
  std::optional<ellipse::Target> last_target;
};

/// What several threads touch, under the object lock.
struct TrackShared {
  TrackProperties properties;
  std::optional<TrackProperties> preset;  ///< While one is being loaded.
  TrackStats stats;
  Lateness lateness;
  std::optional<GstEllipseMeta> target;  ///< In the last analysed frame.
  ellipse::TrackerState tracker_state = ellipse::TrackerState::kSearching;  ///< After it.
  GstClockTime told_latency = 0;
  bool is_live = false;
  bool reset_is_due = false;
  std::set<std::string> refused;  ///< Properties whose last new value was refused.
  /// In the state NULL: all values that were asked for, which may not fit each other yet.
  std::optional<TrackProperties> wanted;
  /// Why a property's value made no sense, by its name; of those set in the state NULL.
  std::map<std::string, std::string> senseless;
};

struct _GstEllipseTrack {
  GstVideoFilter parent;
  TrackShared* shared;
  TrackStream* stream;
};

/// One buffer's way through ellipsetrack, in the streaming thread: whether it is analysed, what is
/// found, and who learns of it. Its pixels change only where the overlay is on. Never throws: what
/// fails becomes an element warning.
void track_frame(GstEllipseTrack* self, GstBuffer* buffer);

/// Starts over, and says so to those who still count on the target. Never while a buffer is on its
/// way.
void forget_stream(GstEllipseTrack* self);
