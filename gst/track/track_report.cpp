// SPDX-License-Identifier: MIT
#include "gst/track/track_report.hpp"

static void post(GstElement* element, const FrameTimes& times, GstStructure* structure) {
  // clang-format off
  gst_structure_set(
      structure,
      "timestamp", G_TYPE_UINT64, times.pts,
      "stream-time", G_TYPE_UINT64, times.stream,
      "running-time", G_TYPE_UINT64, times.running,
      "duration", G_TYPE_UINT64, times.duration,
      nullptr);
  // clang-format on
  gst_element_post_message(element, gst_message_new_element(GST_OBJECT(element), structure));
}

FrameTimes times_of(GstBaseTransform* element, GstBuffer* buffer) {
  FrameTimes times{.pts = GST_BUFFER_PTS(buffer), .duration = GST_BUFFER_DURATION(buffer)};
  const GstSegment& segment = element->segment;
  if (segment.format != GST_FORMAT_TIME) return times;
  times.stream = gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, times.pts);
  times.running = gst_segment_to_running_time(&segment, GST_FORMAT_TIME, times.pts);
  return times;
}

bool has_changed(const std::optional<ellipse::Target>& before,
                 const std::optional<ellipse::Target>& now) {
  return before.has_value() != now.has_value() ||
         (now && (before->id != now->id || before->state != now->state));
}

void post_target_message(GstElement* element,
                         const FrameTimes& times,
                         const GstEllipseMeta* meta,
                         const gchar* tracker_state) {
  GstStructure* structure =
      meta != nullptr ? gst_ellipse_meta_to_structure(meta)
                      : gst_structure_new("ellipse", "state", G_TYPE_STRING, "lost", nullptr);
  gst_structure_set(structure, "tracker", G_TYPE_STRING, tracker_state, nullptr);
  post(element, times, structure);
}

void post_load_message(GstElement* element,
                       const FrameTimes& times,
                       const LoadWatch& load,
                       GstClockTime processing_time,
                       GstClockTime limit) {
  // clang-format off
  GstStructure* structure = gst_structure_new(
      "ellipse-load",
      "overloaded", G_TYPE_BOOLEAN, load.is_overloaded(),
      "scale", G_TYPE_UINT, static_cast<guint>(load.scale()),
      "skipped-in-a-row", G_TYPE_UINT, static_cast<guint>(load.skipped_in_a_row()),
      "processing-time", G_TYPE_UINT64, processing_time,
      "max-processing-time", G_TYPE_UINT64, limit,
      nullptr);
  // clang-format on
  post(element, times, structure);
}
