#pragma once  // SPDX-License-Identifier: MIT

#include <gst/base/gstbasetransform.h>

#include <optional>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/load_watch.hpp"

/// The times of a frame [ns], NONE if unknown.
struct FrameTimes {
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
  GstClockTime stream = GST_CLOCK_TIME_NONE;   ///< NONE in a segment that is not in time format,
  GstClockTime running = GST_CLOCK_TIME_NONE;  ///< as from a filesrc of raw frames.
};

/// Call it in the streaming thread of the element.
[[nodiscard]] FrameTimes times_of(GstBaseTransform* element, GstBuffer* buffer);

/// Whether the target appeared, was lost, or changed its id or state between two frames.
[[nodiscard]] bool has_changed(const std::optional<ellipse::Target>& before,
                               const std::optional<ellipse::Target>& now);

/// Posts the element message "ellipse".
/// @param meta           The target's metadata; nullptr posts the state "lost".
/// @param tracker_state  See nick_of().
void post_target_message(GstElement* element,
                         const FrameTimes& times,
                         const GstEllipseMeta* meta,
                         const gchar* tracker_state);

/// Posts the element message "ellipse-load": how the search is coarsened and frames are skipped
/// to keep the time limit.
/// @param processing_time  Of the last frame [ns].
/// @param limit            Its maximum [ns].
void post_load_message(GstElement* element,
                       const FrameTimes& times,
                       const LoadWatch& load,
                       GstClockTime processing_time,
                       GstClockTime limit);
