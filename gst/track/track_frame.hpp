#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay/overlay.hpp"
#include "gst/track/analytics_meta.hpp"
#include "gst/track/gstellipsetrack.h"
#include "gst/track/lateness.hpp"
#include "gst/track/load_watch.hpp"
#include "gst/track/track_properties.hpp"
#include "gst/track/track_stats.hpp"

GST_DEBUG_CATEGORY_EXTERN(gst_ellipse_track_debug);
#define GST_CAT_DEFAULT gst_ellipse_track_debug

/// State of the streaming thread.
struct TrackStream {
  ellipse::Tracker tracker;
  Overlay overlay;
  LoadWatch load;
  guint64 frame = 0;
  bool is_region_empty = false;  ///< Of the property roi, in the last frame; was reported.
  bool is_mosaic = false;        ///< Of a Bayer sensor; the frames' info is that of GRAY8.
  std::optional<ellipse::Target> last_target;
  Sighting sighting;
};

/// State that threads share under the object lock.
struct TrackShared {
  TrackProperties properties;
  std::optional<TrackProperties> preset;  ///< While a preset is being loaded.
  TrackStats stats;
  Lateness lateness;
  std::optional<GstEllipseMeta> target;  ///< In the last analysed frame.
  ellipse::TrackerState tracker_state = ellipse::TrackerState::kSearching;  ///< After that frame.
  GstClockTime reported_latency = 0;
  bool is_live = false;
  bool reset_is_due = false;
  std::set<std::string> rejected;  ///< Properties whose last new value was rejected.
  /// In the state NULL: all requested values, which may not be valid together yet.
  std::optional<TrackProperties> pending;
  /// Errors of values set in the state NULL that are invalid by themselves, by property name.
  std::map<std::string, std::string> value_errors;
};

struct _GstEllipseTrack {
  GstVideoFilter parent;
  TrackShared* shared;
  TrackStream* stream;
};

/// Processes one buffer in the streaming thread: decides whether to analyse it, runs the tracker,
/// and publishes the result. The pixels change only if the overlay is on. Never throws: errors
/// become element warnings.
void track_frame(GstEllipseTrack* self, GstBuffer* buffer);

/// Resets the tracker for a new stream and reports a followed target as lost. Do not call it while
/// a buffer is being processed.
void reset_stream(GstEllipseTrack* self);
