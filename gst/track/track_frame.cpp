// SPDX-License-Identifier: MIT
#include "gst/track/track_frame.hpp"

#include <bit>
#include <exception>
#include <string>
#include <utility>

#include "gst/meta_ellipse.hpp"
#include "gst/overlay/blend.hpp"
#include "gst/track/search_bounds.hpp"
#include "gst/track/target_meta.hpp"
#include "gst/track/track_report.hpp"
#include "gst/track/video_view.hpp"

// Frames between two checks of the latency; fewer at the beginning.
static constexpr guint64 kLatencyInterval = 32;

// Turns any exception into an element warning. @return Whether none was thrown.
template <class Body>
static bool succeeds(GstEllipseTrack* self, const char* failure, const Body& body) {
  std::string why = "unknown exception";
  try {
    body();
    return true;
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {
  }
  GST_ELEMENT_WARNING(
      self, STREAM, FAILED, ("%s: %s", failure, why.c_str()), ("the stream continues"));
  return false;
}

static void emit_change(GstEllipseTrack* self,
                        const std::optional<ellipse::Target>& before,
                        const std::optional<ellipse::Target>& now,
                        const GstEllipseMeta* meta) {
  const bool is_same_target = before && now && before->id == now->id;
  if (before && !is_same_target) g_signal_emit_by_name(self, "target-lost");
  if (!now || is_same_target) return;
  GstStructure* details = gst_ellipse_meta_to_structure(meta);
  g_signal_emit_by_name(self, "target-acquired", details);
  gst_structure_free(details);
}

// @return The metadata of the target, owned by the buffer; nullptr if there is none.
static const GstEllipseMeta* publish(GstEllipseTrack* self,
                                     GstBuffer* buffer,
                                     const FrameTimes& times,
                                     const TrackProperties& properties,
                                     const std::optional<ellipse::Target>& target,
                                     GstClockTime processing_time) {
  Sighting& sighting = self->stream->sighting;
  if (target) sighting.add(*target, times.pts);
  const GstEllipseMeta* meta = attach_metas(buffer,
                                            target,
                                            self->stream->tracker,
                                            properties,
                                            GST_VIDEO_FILTER(self)->in_info,
                                            sighting,
                                            processing_time);
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target = target;
  const ellipse::TrackerState tracker_state = self->stream->tracker.state();

  GST_OBJECT_LOCK(self);
  self->shared->stats.add_analysed(target, processing_time);
  self->shared->tracker_state = tracker_state;
  self->shared->target.reset();
  if (meta != nullptr) self->shared->target = *meta;
  GST_OBJECT_UNLOCK(self);

  if (properties.messages == MESSAGES_EVERY_FRAME ||
      (properties.messages == MESSAGES_ON_CHANGE && has_changed(before, target))) {
    post_target_message(GST_ELEMENT(self), times, meta, nick_of(tracker_state));
  }
  emit_change(self, before, target, meta);
  return meta;
}

// Posts LATENCY if the reported latency is outdated, so that the application queries it again.
static void report_latency(GstEllipseTrack* self) {
  TrackShared& shared = *self->shared;
  const guint64 frame = self->stream->frame;
  if (frame % kLatencyInterval != 0 && !(frame < kLatencyInterval && std::has_single_bit(frame))) {
    return;
  }
  GST_OBJECT_LOCK(self);
  const TrackStats stats = shared.stats;
  const GstClockTime reported = shared.reported_latency;
  const bool is_live = shared.is_live;
  GST_OBJECT_UNLOCK(self);
  const GstClockTime latency = stats.latency();
  if (!is_live || (latency <= reported && 2 * latency >= reported)) return;
  GST_DEBUG_OBJECT(self, "latency is now %" GST_TIME_FORMAT, GST_TIME_ARGS(latency));
  gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

// Resets the tracker and reports a followed target as lost.
static void reset_target(GstEllipseTrack* self,
                         const TrackProperties& properties,
                         const FrameTimes& times) {
  self->stream->tracker.reset();
  self->stream->sighting = {};
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target.reset();
  const ellipse::TrackerState tracker_state = self->stream->tracker.state();
  GST_OBJECT_LOCK(self);
  self->shared->stats.reset_target();
  self->shared->tracker_state = tracker_state;
  self->shared->target.reset();
  GST_OBJECT_UNLOCK(self);
  if (!before) return;
  if (properties.messages != MESSAGES_NONE) {
    post_target_message(GST_ELEMENT(self), times, nullptr, nick_of(tracker_state));
  }
  emit_change(self, before, std::nullopt, nullptr);
}

// Takes the request of the action "reset". @return Whether there was one.
static bool take_reset(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  const bool is_due = std::exchange(self->shared->reset_is_due, false);
  GST_OBJECT_UNLOCK(self);
  return is_due;
}

static TrackProperties copy_of_properties(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  TrackProperties properties = self->shared->properties;
  GST_OBJECT_UNLOCK(self);
  return properties;
}

static bool skips_late(GstEllipseTrack* self, const FrameTimes& times) {
  if (!gst_base_transform_is_qos_enabled(GST_BASE_TRANSFORM(self))) return false;
  GST_OBJECT_LOCK(self);
  const bool is_late = self->shared->lateness.skips_next(times.running);
  GST_OBJECT_UNLOCK(self);
  return is_late;
}

static void watch_load(GstEllipseTrack* self,
                       const FrameTimes& times,
                       GstClockTime processing_time,
                       GstClockTime limit) {
  LoadWatch& load = self->stream->load;
  if (!load.add(processing_time, limit)) return;
  GST_DEBUG_OBJECT(
      self, "scale %d, %d frames skipped in a row", load.scale(), load.skipped_in_a_row());
  post_load_message(GST_ELEMENT(self), times, load, processing_time, limit);
}

// Counts the frame. @return Why it passes without analysis; nullopt if it is analysed.
static std::optional<Skip> count_frame(GstEllipseTrack* self,
                                       const FrameTimes& times,
                                       const TrackProperties& properties,
                                       const ellipse::Rect& bounds) {
  if (self->stream->frame++ % properties.interval != 0) return Skip::kInterval;
  if (bounds.empty()) return Skip::kRegion;
  if (skips_late(self, times)) return Skip::kLate;
  if (self->stream->load.skips_next()) return Skip::kLoad;
  return std::nullopt;
}

// Warns once until a frame has pixels to search. With roi-source=meta an empty region is normal.
static void warn_of_empty_region(GstEllipseTrack* self,
                                 const TrackProperties& properties,
                                 const ellipse::Rect& frame) {
  if (self->stream->is_region_empty || properties.roi_source != ROI_SOURCE_PROPERTY) return;
  self->stream->is_region_empty = true;
  const ellipse::Rect& roi = properties.roi;
  GST_ELEMENT_WARNING(self,
                      STREAM,
                      FAILED,
                      ("roi <%d,%d,%d,%d> has no pixel in the frame of %d x %d or in its crop.",
                       roi.x,
                       roi.y,
                       roi.width,
                       roi.height,
                       frame.width,
                       frame.height),
                      ("nothing is searched; the stream continues"));
}

static void skip(GstEllipseTrack* self, Skip reason) {
  GST_LOG_OBJECT(self, "passes without analysis: %s", nick_of(reason));
  GST_OBJECT_LOCK(self);
  self->shared->stats.add_skipped(reason);
  GST_OBJECT_UNLOCK(self);
}

static void draw(GstEllipseTrack* self,
                 GstVideoFrame& frame,
                 const GstEllipseMeta& meta,
                 OverlayStyle style) {
  style.has_casing = GST_VIDEO_FORMAT_INFO_IS_GRAY(frame.info.finfo);
  Overlay& overlay = self->stream->overlay;
  overlay.begin(GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame));
  overlay.draw(meta, style);
  blend(overlay.canvas(), frame);
}

static void log_verdict(GstEllipseTrack* self,
                        const GstEllipseMeta* meta,
                        GstClockTime processing_time) {
  if (meta == nullptr) {
    GST_LOG_OBJECT(self, "nothing found, %" G_GUINT64_FORMAT " ns", processing_time);
    return;
  }
  GST_LOG_OBJECT(self,
                 "%s %" G_GUINT64_FORMAT " at %.2f, %.2f, axes %.2f, %.2f, %" G_GUINT64_FORMAT
                 " ns",
                 gst_ellipse_meta_get_state_name(meta),
                 meta->id,
                 meta->cx,
                 meta->cy,
                 meta->semi_major,
                 meta->semi_minor,
                 processing_time);
}

static void analyse(GstEllipseTrack* self,
                    GstBuffer* buffer,
                    const FrameTimes& times,
                    const TrackProperties& properties,
                    const ellipse::Rect& bounds) {
  const bool draws = properties.overlay.parts != GST_ELLIPSE_OVERLAY_NONE;
  MappedFrame mapped(
      GST_VIDEO_FILTER(self)->in_info, buffer, draws ? GST_MAP_READWRITE : GST_MAP_READ);
  if (!mapped.is_mapped()) {
    GST_ELEMENT_WARNING(self, RESOURCE, READ, ("Cannot map a buffer."), ("it passes unchanged"));
    skip(self, Skip::kFailed);
    return;
  }
  const GstClockTime start = gst_util_get_timestamp();
  ellipse::Tracker& tracker = self->stream->tracker;
  tracker.configure(properties.tracker);
  const auto target = tracker.process(pixel_view_of(mapped.frame(), self->stream->is_mosaic),
                                      static_cast<gint64>(times.pts),
                                      {bounds, self->stream->load.scale()});
  const GstClockTime processing_time = gst_util_get_timestamp() - start;
  const GstEllipseMeta* meta = publish(self, buffer, times, properties, target, processing_time);
  log_verdict(self, meta, processing_time);
  watch_load(self, times, processing_time, properties.max_processing_time);
  if (!draws || meta == nullptr) return;
  succeeds(self, "Cannot draw on a frame", [&] {
    draw(self, mapped.frame(), *meta, properties.overlay);
  });
}

static void pass_on(GstEllipseTrack* self, GstBuffer* buffer) {
  auto* base = GST_BASE_TRANSFORM(self);
  const FrameTimes times = times_of(base, buffer);
  if (GST_CLOCK_TIME_IS_VALID(times.stream)) gst_object_sync_values(GST_OBJECT(self), times.stream);

  const TrackProperties properties = copy_of_properties(self);
  if (take_reset(self)) reset_target(self, properties, times);
  if (properties.max_processing_time == 0) watch_load(self, times, 0, 0);  // no limit, no overload
  const GstVideoInfo& info = GST_VIDEO_FILTER(base)->in_info;
  const ellipse::Rect bounds = search_bounds(buffer, info, properties);
  if (const auto reason = count_frame(self, times, properties, bounds)) {
    if (*reason == Skip::kRegion) {
      warn_of_empty_region(self, properties, frame_of(buffer, info));
      reset_target(self, properties, times);
    }
    skip(self, *reason);
  } else {
    self->stream->is_region_empty = false;
    analyse(self, buffer, times, properties, bounds);
  }
}

void track_frame(GstEllipseTrack* self, GstBuffer* buffer) {
  const auto body = [&] { pass_on(self, buffer); };
  if (!succeeds(self, "Cannot analyse a frame", body)) skip(self, Skip::kFailed);
  report_latency(self);
}

void reset_stream(GstEllipseTrack* self) {
  GST_DEBUG_OBJECT(self, "tracker reset");
  succeeds(self, "Cannot reset the tracker", [self] {
    GST_OBJECT_LOCK(self);
    self->shared->lateness = Lateness();
    GST_OBJECT_UNLOCK(self);
    reset_target(self, copy_of_properties(self), {});
  });
  watch_load(self, {}, 0, 0);
  self->stream->is_region_empty = false;
  self->stream->frame = 0;
}
