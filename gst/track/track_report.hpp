#pragma once  // SPDX-License-Identifier: MIT

#include <gst/base/gstbasetransform.h>

#include <optional>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/load_watch.hpp"

/// The times of a frame [ns], each NONE where it is not known.
struct FrameTimes {
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
  GstClockTime stream = GST_CLOCK_TIME_NONE;   ///< NONE behind a segment that is not in time, as
  GstClockTime running = GST_CLOCK_TIME_NONE;  ///< after a filesrc of raw frames.
};

/// In the streaming thread of the element.
[[nodiscard]] FrameTimes times_of(GstBaseTransform* element, GstBuffer* buffer);

/// Whether there is something to tell between two frames: a target came, went, or is in another
/// state.
[[nodiscard]] bool has_changed(const std::optional<ellipse::Target>& before,
                               const std::optional<ellipse::Target>& now);

/// Posts the element message "ellipse".
/// @param meta           The target's; nullptr where there is none, whose state is "lost".
/// @param tracker_state  See nick_of().
void post_target_message(GstElement* element,
                         const FrameTimes& times,
                         const GstEllipseMeta* meta,
                         const gchar* tracker_state);

/// Posts the element message "ellipse-load": what is done about analyses that take too long.
/// @param processing_time  That of the last frame [ns].
/// @param limit            What it may be [ns].
void post_load_message(GstElement* element,
                       const FrameTimes& times,
                       const LoadWatch& load,
                       GstClockTime processing_time,
                       GstClockTime limit);
