/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipsetrack
 * @title: ellipsetrack
 *
 * Finds and follows an elliptical target in video: a landing pad, any circle seen at an angle. Each
 * buffer on which the target is found gets a #GstEllipseMeta; the pixels stay as they are unless
 * #GstEllipseTrack:overlay asks for drawing.
 *
 * |[
 * gst-launch-1.0 ellipsetestsrc ! ellipsetrack overlay=ellipse+centre ! videoconvert !
 * autovideosink
 * ]|
 */

#include "gst/gstellipsetrack.h"

#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "core/tracker.hpp"
#include "gst/blend.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay.hpp"
#include "gst/target_meta.hpp"
#include "gst/track_properties.hpp"
#include "gst/track_stats.hpp"
#include "gst/video_view.hpp"

GST_DEBUG_CATEGORY_STATIC(gst_ellipse_track_debug);
#define GST_CAT_DEFAULT gst_ellipse_track_debug

enum { SIGNAL_TARGET_ACQUIRED, SIGNAL_TARGET_LOST, SIGNAL_RESET, N_SIGNALS };

enum {
  PROP_0,
  PROP_TARGET,
  PROP_STATS,
  PROP_FIRST_SETTING,  // those of TrackProperties from here on
};

static guint signals[N_SIGNALS];

namespace {

// Skipping helps where the analysis is what is late. Where another element is, the target must not
// be out of sight for good: after so many late frames one is analysed all the same.
constexpr guint kMostLateFrames = 4;

// What the streaming thread keeps from frame to frame.
struct Stream {
  ellipse::Tracker tracker;
  Overlay overlay;
  guint64 frame = 0;
  guint late_frames = 0;  // in a row
  std::optional<ellipse::Target> last_target;
};

}  // namespace

struct _GstEllipseTrack {
  GstVideoFilter parent;

  // Under the object lock.
  TrackProperties* properties;
  TrackStats* stats;
  GstStructure* target;
  GstClockTime earliest_time;
  bool reset_is_due;

  Stream* stream;
};

G_DEFINE_TYPE_WITH_CODE(GstEllipseTrack,
                        gst_ellipse_track,
                        GST_TYPE_VIDEO_FILTER,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_PRESET, nullptr))

GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(
    ellipsetrack,
    "ellipsetrack",
    GST_RANK_NONE,
    GST_TYPE_ELLIPSE_TRACK,
    GST_DEBUG_CATEGORY_INIT(gst_ellipse_track_debug, "ellipsetrack", 0, "ellipse tracker"))

/* Properties */

// Refuses what does not fit together, names it, and keeps the old value.
static void gst_ellipse_track_set_property(GObject* object,
                                           guint id,
                                           const GValue* value,
                                           GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TRACK(object);
  if (id < PROP_FIRST_SETTING) {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    return;
  }
  std::string refusal;
  GST_OBJECT_LOCK(self);
  try {
    self->properties->set(id - PROP_FIRST_SETTING, value);
  } catch (const std::exception& error) {
    refusal = error.what();
  }
  GST_OBJECT_UNLOCK(self);
  if (refusal.empty()) return;
  g_warning("%s: setting refused, the old value stays: %s", GST_OBJECT_NAME(self), refusal.c_str());
  GST_ELEMENT_WARNING(
      self, LIBRARY, SETTINGS, ("Setting refused: %s", refusal.c_str()), ("the old value stays"));
}

static void gst_ellipse_track_get_property(GObject* object,
                                           guint id,
                                           GValue* value,
                                           GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TRACK(object);
  GST_OBJECT_LOCK(self);
  if (id == PROP_TARGET) {
    g_value_set_boxed(value, self->target);
  } else if (id == PROP_STATS) {
    g_value_take_boxed(value, self->stats->to_structure());
  } else if (id >= PROP_FIRST_SETTING) {
    self->properties->get(id - PROP_FIRST_SETTING, value);
  } else {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
  GST_OBJECT_UNLOCK(self);
}

static void install_properties(GObjectClass* object_class) {
  const auto readable = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  g_object_class_install_property(
      object_class,
      PROP_TARGET,
      g_param_spec_boxed("target",
                         "Target",
                         "The target in the last analysed frame, NULL where there was none",
                         GST_TYPE_STRUCTURE,
                         readable));
  g_object_class_install_property(object_class,
                                  PROP_STATS,
                                  g_param_spec_boxed("stats",
                                                     "Statistics",
                                                     "Counts of frames, and processing times in ns",
                                                     GST_TYPE_STRUCTURE,
                                                     readable));
  TrackProperties::install(object_class, PROP_FIRST_SETTING);
}

/* What goes out with a frame */

// NONE where the segment is not in time, as behind a filesrc of raw frames.
static GstClockTime stream_time_of(GstEllipseTrack* self, GstClockTime pts) {
  const GstSegment& segment = GST_BASE_TRANSFORM(self)->segment;
  if (segment.format != GST_FORMAT_TIME) return GST_CLOCK_TIME_NONE;
  return gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, pts);
}

static GstClockTime running_time_of(GstEllipseTrack* self, GstClockTime pts) {
  const GstSegment& segment = GST_BASE_TRANSFORM(self)->segment;
  if (segment.format != GST_FORMAT_TIME) return GST_CLOCK_TIME_NONE;
  return gst_segment_to_running_time(&segment, GST_FORMAT_TIME, pts);
}

// @param details  The target's structure; NULL where there is none.
static void post_message(GstEllipseTrack* self,
                         GstClockTime pts,
                         GstClockTime duration,
                         const std::optional<ellipse::Target>& target,
                         const GstStructure* details) {
  GstStructure* structure =
      details != nullptr ? gst_structure_copy(details) : gst_structure_new_empty("ellipse");
  // clang-format off
  gst_structure_set(
      structure,
      "state", G_TYPE_STRING, state_nick(target),
      "timestamp", G_TYPE_UINT64, pts,
      "stream-time", G_TYPE_UINT64, stream_time_of(self, pts),
      "running-time", G_TYPE_UINT64, running_time_of(self, pts),
      "duration", G_TYPE_UINT64, duration,
      nullptr);
  // clang-format on
  gst_element_post_message(GST_ELEMENT(self), gst_message_new_element(GST_OBJECT(self), structure));
}

static void emit_change(GstEllipseTrack* self,
                        const std::optional<ellipse::Target>& before,
                        const std::optional<ellipse::Target>& now,
                        GstStructure* details) {
  const bool is_same_target = before && now && before->id == now->id;
  if (before && !is_same_target) g_signal_emit(self, signals[SIGNAL_TARGET_LOST], 0);
  if (now && !is_same_target) g_signal_emit(self, signals[SIGNAL_TARGET_ACQUIRED], 0, details);
}

// @return The metadata of the target, owned by the buffer; nullptr where there is none.
static const GstEllipseMeta* publish(GstEllipseTrack* self,
                                     GstBuffer* buffer,
                                     const TrackProperties& properties,
                                     const std::optional<ellipse::Target>& target,
                                     GstClockTime processing_time) {
  const GstEllipseMeta* meta = attach_metas(buffer,
                                            target,
                                            self->stream->tracker.candidates(),
                                            properties,
                                            GST_VIDEO_FILTER(self)->in_info,
                                            processing_time);
  GstStructure* details = meta != nullptr ? gst_ellipse_meta_to_structure(meta) : nullptr;
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target = target;

  GST_OBJECT_LOCK(self);
  self->stats->add_analysed(target, processing_time);
  gst_clear_structure(&self->target);
  if (details != nullptr) self->target = gst_structure_copy(details);
  GST_OBJECT_UNLOCK(self);

  const bool has_changed = before.has_value() != target.has_value() ||
                           (target && (before->id != target->id || before->state != target->state));
  if (properties.messages == MESSAGES_EVERY_FRAME ||
      (properties.messages == MESSAGES_ON_CHANGE && has_changed)) {
    post_message(self, GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer), target, details);
  }
  emit_change(self, before, target, details);
  gst_clear_structure(&details);
  return meta;
}

/* Streaming */

// Starts over, and says so to those who still count on the target.
static void forget_target(GstEllipseTrack* self, const TrackProperties& properties) {
  self->stream->tracker.reset();
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target.reset();
  GST_OBJECT_LOCK(self);
  self->stats->forget_target();
  gst_clear_structure(&self->target);
  GST_OBJECT_UNLOCK(self);
  if (!before) return;
  if (properties.messages != MESSAGES_NONE) {
    post_message(self, GST_CLOCK_TIME_NONE, GST_CLOCK_TIME_NONE, std::nullopt, nullptr);
  }
  emit_change(self, before, std::nullopt, nullptr);
}

static TrackProperties take_properties(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  const TrackProperties properties = *self->properties;
  const bool reset_is_due = self->reset_is_due;
  self->reset_is_due = false;
  GST_OBJECT_UNLOCK(self);
  if (reset_is_due) forget_target(self, properties);
  return properties;
}

static bool is_too_late(GstEllipseTrack* self, GstBuffer* buffer) {
  auto* base = GST_BASE_TRANSFORM(self);
  if (!gst_base_transform_is_qos_enabled(base)) return false;
  const GstClockTime running_time = running_time_of(self, GST_BUFFER_PTS(buffer));
  GST_OBJECT_LOCK(self);
  const GstClockTime earliest_time = self->earliest_time;
  GST_OBJECT_UNLOCK(self);
  return GST_CLOCK_TIME_IS_VALID(running_time) && GST_CLOCK_TIME_IS_VALID(earliest_time) &&
         running_time <= earliest_time;
}

static bool must_hurry(GstEllipseTrack* self, GstBuffer* buffer) {
  guint& late_frames = self->stream->late_frames;
  if (is_too_late(self, buffer) && late_frames < kMostLateFrames) {
    ++late_frames;
    return true;
  }
  late_frames = 0;
  return false;
}

static void skip(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  self->stats->add_skipped();
  GST_OBJECT_UNLOCK(self);
}

static void draw(GstEllipseTrack* self,
                 GstVideoFrame& frame,
                 const GstEllipseMeta& meta,
                 const OverlayStyle& style) {
  Overlay& overlay = self->stream->overlay;
  overlay.begin(GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame));
  overlay.draw(meta, style);
  blend(overlay.canvas(), frame);
}

static void analyse(GstEllipseTrack* self, GstBuffer* buffer, const TrackProperties& properties) {
  const bool draws = properties.overlay.parts != GST_ELLIPSE_OVERLAY_NONE;
  MappedFrame mapped(
      GST_VIDEO_FILTER(self)->in_info, buffer, draws ? GST_MAP_READWRITE : GST_MAP_READ);
  if (!mapped.is_mapped()) {
    GST_ELEMENT_WARNING(self, RESOURCE, READ, ("A buffer cannot be read."), ("it passes as it is"));
    skip(self);
    return;
  }
  const GstClockTime start = gst_util_get_timestamp();
  ellipse::Tracker& tracker = self->stream->tracker;
  tracker.configure(properties.tracker);
  const auto target =
      tracker.process(pixel_view_of(mapped.frame()), static_cast<gint64>(GST_BUFFER_PTS(buffer)));
  const GstEllipseMeta* meta =
      publish(self, buffer, properties, target, gst_util_get_timestamp() - start);
  if (draws && meta != nullptr) draw(self, mapped.frame(), *meta, properties.overlay);
}

static GstFlowReturn gst_ellipse_track_transform_ip(GstBaseTransform* base, GstBuffer* buffer) {
  auto* self = GST_ELLIPSE_TRACK(base);
  const GstClockTime stream_time = stream_time_of(self, GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(stream_time)) gst_object_sync_values(GST_OBJECT(self), stream_time);

  const TrackProperties properties = take_properties(self);
  const bool is_turn = self->stream->frame++ % properties.interval == 0;
  if (!is_turn || must_hurry(self, buffer)) {
    skip(self);
    return GST_FLOW_OK;
  }
  try {
    analyse(self, buffer, properties);
  } catch (const std::exception& error) {
    GST_ELEMENT_WARNING(
        self, STREAM, FAILED, ("A frame could not be analysed: %s", error.what()), ("it passes"));
    skip(self);
  }
  return GST_FLOW_OK;
}

// Lateness makes the analysis skip frames; the base class would drop them.
static gboolean gst_ellipse_track_src_event(GstBaseTransform* base, GstEvent* event) {
  auto* self = GST_ELLIPSE_TRACK(base);
  if (GST_EVENT_TYPE(event) != GST_EVENT_QOS) {
    return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->src_event(base, event);
  }
  GstClockTimeDiff lateness = 0;
  GstClockTime timestamp = GST_CLOCK_TIME_NONE;
  gst_event_parse_qos(event, nullptr, nullptr, &lateness, &timestamp);
  GST_OBJECT_LOCK(self);
  self->earliest_time = GST_CLOCK_TIME_IS_VALID(timestamp) && lateness > 0
                            ? timestamp + 2 * static_cast<GstClockTime>(lateness)
                            : GST_CLOCK_TIME_NONE;
  GST_OBJECT_UNLOCK(self);
  return gst_pad_push_event(GST_BASE_TRANSFORM_SINK_PAD(base), event);
}

static void forget_stream(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  const TrackProperties properties = *self->properties;
  self->earliest_time = GST_CLOCK_TIME_NONE;
  GST_OBJECT_UNLOCK(self);
  forget_target(self, properties);
  self->stream->frame = 0;
  self->stream->late_frames = 0;
}

static gboolean gst_ellipse_track_sink_event(GstBaseTransform* base, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) forget_stream(GST_ELLIPSE_TRACK(base));
  return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->sink_event(base, event);
}

static gboolean gst_ellipse_track_start(GstBaseTransform* base) {
  auto* self = GST_ELLIPSE_TRACK(base);
  forget_stream(self);
  GST_OBJECT_LOCK(self);
  *self->stats = TrackStats();
  GST_OBJECT_UNLOCK(self);
  return TRUE;
}

static gboolean gst_ellipse_track_stop(GstBaseTransform* base) {
  forget_stream(GST_ELLIPSE_TRACK(base));
  return TRUE;
}

static gboolean gst_ellipse_track_propose_allocation(GstBaseTransform* base,
                                                     GstQuery* decide_query,
                                                     GstQuery* query) {
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)
      ->propose_allocation(base, decide_query, query);
}

static void gst_ellipse_track_reset(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  self->reset_is_due = true;
  GST_OBJECT_UNLOCK(self);
}

/* Class */

static void gst_ellipse_track_finalize(GObject* object) {
  auto* self = GST_ELLIPSE_TRACK(object);
  gst_clear_structure(&self->target);
  delete self->stream;
  delete self->stats;
  delete self->properties;
  G_OBJECT_CLASS(gst_ellipse_track_parent_class)->finalize(object);
}

static void gst_ellipse_track_init(GstEllipseTrack* self) {
  self->properties = new TrackProperties();
  self->stats = new TrackStats();
  self->stream = new Stream();
  self->earliest_time = GST_CLOCK_TIME_NONE;
  gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
}

static void install_signals(GstEllipseTrackClass* klass) {
  const GType type = G_TYPE_FROM_CLASS(klass);
  signals[SIGNAL_TARGET_ACQUIRED] = g_signal_new("target-acquired",
                                                 type,
                                                 G_SIGNAL_RUN_LAST,
                                                 0,
                                                 nullptr,
                                                 nullptr,
                                                 nullptr,
                                                 G_TYPE_NONE,
                                                 1,
                                                 GST_TYPE_STRUCTURE);
  signals[SIGNAL_TARGET_LOST] = g_signal_new(
      "target-lost", type, G_SIGNAL_RUN_LAST, 0, nullptr, nullptr, nullptr, G_TYPE_NONE, 0);
  signals[SIGNAL_RESET] =
      g_signal_new_class_handler("reset",
                                 type,
                                 static_cast<GSignalFlags>(G_SIGNAL_RUN_LAST | G_SIGNAL_ACTION),
                                 G_CALLBACK(gst_ellipse_track_reset),
                                 nullptr,
                                 nullptr,
                                 nullptr,
                                 G_TYPE_NONE,
                                 0);
}

static void gst_ellipse_track_class_init(GstEllipseTrackClass* klass) {
  auto* object_class = G_OBJECT_CLASS(klass);
  object_class->set_property = gst_ellipse_track_set_property;
  object_class->get_property = gst_ellipse_track_get_property;
  object_class->finalize = gst_ellipse_track_finalize;
  install_properties(object_class);
  install_signals(klass);

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipse tracker",
                                        "Filter/Analyzer/Video",
                                        "Detects and tracks an elliptical target on every buffer",
                                        "The gst-ellipse authors");
  add_video_pad_templates(element_class);

  auto* base_class = GST_BASE_TRANSFORM_CLASS(klass);
  base_class->transform_ip = gst_ellipse_track_transform_ip;
  base_class->src_event = gst_ellipse_track_src_event;
  base_class->sink_event = gst_ellipse_track_sink_event;
  base_class->start = gst_ellipse_track_start;
  base_class->stop = gst_ellipse_track_stop;
  base_class->propose_allocation = gst_ellipse_track_propose_allocation;
}
