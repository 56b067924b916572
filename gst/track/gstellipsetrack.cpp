/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipsetrack
 * @title: ellipsetrack
 *
 * Detects and tracks an elliptical target in video: a landing pad, any circle seen at an angle.
 * Each buffer in which the target is found gets a #GstEllipseMeta; the pixels stay unchanged unless
 * #GstEllipseTrack:overlay enables drawing.
 *
 * |[
 * gst-launch-1.0 ellipsetestsrc ! ellipsetrack overlay=ellipse+centre ! videoconvert !
 * autovideosink
 * ]|
 *
 * Since: 0.1
 */

#include "gst/track/gstellipsetrack.h"

#include <optional>
#include <string>
#include <string_view>

#include "gst/track/new_values.hpp"
#include "gst/track/target_meta.hpp"
#include "gst/track/track_frame.hpp"
#include "gst/track/video_view.hpp"

GST_DEBUG_CATEGORY(gst_ellipse_track_debug);

static void gst_ellipse_track_preset_init(gpointer iface, gpointer data);

G_DEFINE_TYPE_WITH_CODE(GstEllipseTrack,
                        gst_ellipse_track,
                        GST_TYPE_VIDEO_FILTER,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_PRESET, gst_ellipse_track_preset_init))

GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(
    ellipsetrack,
    "ellipsetrack",
    GST_RANK_NONE,
    GST_TYPE_ELLIPSE_TRACK,
    GST_DEBUG_CATEGORY_INIT(gst_ellipse_track_debug, "ellipsetrack", 0, "ellipse tracker"))

/* Properties */

static void gst_ellipse_track_set_property(GObject* object,
                                           guint /*id*/,
                                           const GValue* value,
                                           GParamSpec* pspec) {
  set_value(GST_ELLIPSE_TRACK(object), pspec, value);
}

static void gst_ellipse_track_get_property(GObject* object,
                                           guint /*id*/,
                                           GValue* value,
                                           GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TRACK(object);
  const std::string_view name = pspec->name;
  GST_OBJECT_LOCK(self);
  const std::optional<GstEllipseMeta> target = self->shared->target;
  const TrackStats stats = self->shared->stats;
  const ellipse::TrackerState tracker_state = self->shared->tracker_state;
  const TrackProperties properties = self->shared->properties;
  GST_OBJECT_UNLOCK(self);
  if (name == "target") {
    if (target) g_value_take_boxed(value, gst_ellipse_meta_to_structure(&*target));
  } else if (name == "stats") {
    GstStructure* structure = stats.to_structure();
    gst_structure_set(structure, "tracker", G_TYPE_STRING, nick_of(tracker_state), nullptr);
    g_value_take_boxed(value, structure);
  } else {
    properties.get(name, value);
  }
}

static gboolean (*load_one_by_one)(GstPreset* preset, const gchar* name);

static gboolean gst_ellipse_track_load_preset(GstPreset* preset, const gchar* name) {
  return load_together(GST_ELLIPSE_TRACK(preset), name, load_one_by_one);
}

static void gst_ellipse_track_preset_init(gpointer iface, gpointer /*data*/) {
  auto* preset = static_cast<GstPresetInterface*>(iface);
  load_one_by_one = preset->load_preset;
  preset->load_preset = gst_ellipse_track_load_preset;
}

/* Streaming */

static GstFlowReturn gst_ellipse_track_transform_ip(GstBaseTransform* base, GstBuffer* buffer) {
  track_frame(GST_ELLIPSE_TRACK(base), buffer);
  return GST_FLOW_OK;
}

// Late frames pass without analysis; the base class would drop them.
static gboolean gst_ellipse_track_src_event(GstBaseTransform* base, GstEvent* event) {
  auto* self = GST_ELLIPSE_TRACK(base);
  if (GST_EVENT_TYPE(event) != GST_EVENT_QOS) {
    return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->src_event(base, event);
  }
  GstClockTimeDiff jitter = 0;
  GstClockTime timestamp = GST_CLOCK_TIME_NONE;
  gst_event_parse_qos(event, nullptr, nullptr, &jitter, &timestamp);
  GST_OBJECT_LOCK(self);
  self->shared->lateness.observe(timestamp, jitter);
  GST_OBJECT_UNLOCK(self);
  return gst_pad_push_event(GST_BASE_TRANSFORM_SINK_PAD(base), event);
}

static void add_latency(GstEllipseTrack* self, GstQuery* query) {
  gboolean is_live = FALSE;
  GstClockTime min = 0;
  GstClockTime max = GST_CLOCK_TIME_NONE;
  gst_query_parse_latency(query, &is_live, &min, &max);
  TrackShared& shared = *self->shared;
  GST_OBJECT_LOCK(self);
  shared.is_live = is_live != FALSE;
  shared.reported_latency = shared.stats.latency();
  const GstClockTime own = shared.reported_latency;
  GST_OBJECT_UNLOCK(self);
  if (is_live == FALSE) return;
  gst_query_set_latency(query, TRUE, min + own, GST_CLOCK_TIME_IS_VALID(max) ? max + own : max);
}

static gboolean gst_ellipse_track_query(GstBaseTransform* base,
                                        GstPadDirection direction,
                                        GstQuery* query) {
  const gboolean is_answered =
      GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->query(base, direction, query);
  if (is_answered && direction == GST_PAD_SRC && GST_QUERY_TYPE(query) == GST_QUERY_LATENCY) {
    add_latency(GST_ELLIPSE_TRACK(base), query);
  }
  return is_answered;
}

static gboolean gst_ellipse_track_sink_event(GstBaseTransform* base, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) reset_stream(GST_ELLIPSE_TRACK(base));
  return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->sink_event(base, event);
}

static gboolean gst_ellipse_track_start(GstBaseTransform* base) {
  auto* self = GST_ELLIPSE_TRACK(base);
  reset_stream(self);
  GST_OBJECT_LOCK(self);
  self->shared->stats = TrackStats();
  GST_OBJECT_UNLOCK(self);
  return TRUE;
}

static gboolean gst_ellipse_track_stop(GstBaseTransform* base) {
  reset_stream(GST_ELLIPSE_TRACK(base));
  return TRUE;
}

// A setting rejected before the start fails the start, because applications do not read the
// warnings of a pipeline that is not playing yet.
static GstStateChangeReturn gst_ellipse_track_change_state(GstElement* element,
                                                           GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) {
    const std::string error = start_error(GST_ELLIPSE_TRACK(element));
    if (!error.empty()) {
      GST_ELEMENT_ERROR(
          element, LIBRARY, SETTINGS, ("Setting rejected: %s", error.c_str()), (nullptr));
      return GST_STATE_CHANGE_FAILURE;
    }
  }
  return GST_ELEMENT_CLASS(gst_ellipse_track_parent_class)->change_state(element, transition);
}

static gboolean gst_ellipse_track_propose_allocation(GstBaseTransform* base,
                                                     GstQuery* decide_query,
                                                     GstQuery* query) {
  GstCaps* caps = nullptr;
  gst_query_parse_allocation(query, &caps, nullptr);
  if (caps != nullptr && is_mosaic(caps)) return TRUE;  // video metadata cannot describe one
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)
      ->propose_allocation(base, decide_query, query);
}

// Offers cropping by metadata upstream if downstream supports it.
static gboolean gst_ellipse_track_filter_meta(GstBaseTransform* /*base*/,
                                              GstQuery* /*query*/,
                                              GType api,
                                              const GstStructure* /*params*/) {
  return api == GST_VIDEO_CROP_META_API_TYPE;
}

// Warns about interlaced and mixed streams: the two fields of a frame differ in time, which gives
// moving edges a comb pattern.
static gboolean gst_ellipse_track_set_info(GstVideoFilter* filter,
                                           GstCaps* /*in_caps*/,
                                           GstVideoInfo* in_info,
                                           GstCaps* /*out_caps*/,
                                           GstVideoInfo* /*out_info*/) {
  GST_DEBUG_OBJECT(filter,
                   "%s %d x %d",
                   GST_VIDEO_INFO_NAME(in_info),
                   GST_VIDEO_INFO_WIDTH(in_info),
                   GST_VIDEO_INFO_HEIGHT(in_info));
  if (GST_VIDEO_INFO_IS_INTERLACED(in_info)) {
    GST_ELEMENT_WARNING(filter,
                        STREAM,
                        FORMAT,
                        ("Interlaced frames are analysed as if they were progressive."),
                        ("put deinterlace upstream"));
  }
  return TRUE;
}

// The base class knows raw video only.
static gboolean gst_ellipse_track_set_caps(GstBaseTransform* base, GstCaps* in, GstCaps* out) {
  auto* filter = GST_VIDEO_FILTER(base);
  auto* self = GST_ELLIPSE_TRACK(base);
  self->stream->is_mosaic = is_mosaic(in);
  if (!self->stream->is_mosaic) {
    return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->set_caps(base, in, out);
  }
  filter->negotiated = set_mosaic_info(&filter->in_info, in);
  filter->out_info = filter->in_info;
  return filter->negotiated;
}

static gboolean gst_ellipse_track_get_unit_size(GstBaseTransform* base,
                                                GstCaps* caps,
                                                gsize* size) {
  if (!is_mosaic(caps)) {
    return GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)
        ->get_unit_size(base, caps, size);
  }
  GstVideoInfo info;
  if (!set_mosaic_info(&info, caps)) return FALSE;
  *size = GST_VIDEO_INFO_SIZE(&info);
  return TRUE;
}

static gboolean gst_ellipse_track_accept_caps(GstBaseTransform* base,
                                              GstPadDirection direction,
                                              GstCaps* caps) {
  const gboolean is_accepted =
      GST_BASE_TRANSFORM_CLASS(gst_ellipse_track_parent_class)->accept_caps(base, direction, caps);
  if (!is_accepted && direction == GST_PAD_SINK) report_unsupported_caps(base, caps);
  return is_accepted;
}

static void gst_ellipse_track_reset(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  self->shared->reset_is_due = true;
  GST_OBJECT_UNLOCK(self);
}

/* Class */

static void gst_ellipse_track_finalize(GObject* object) {
  auto* self = GST_ELLIPSE_TRACK(object);
  delete self->stream;
  delete self->shared;
  G_OBJECT_CLASS(gst_ellipse_track_parent_class)->finalize(object);
}

static void gst_ellipse_track_init(GstEllipseTrack* self) {
  self->shared = new TrackShared();
  self->stream = new TrackStream();
  gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
}

static void install_signals(GstEllipseTrackClass* klass) {
  const GType type = G_TYPE_FROM_CLASS(klass);
  g_signal_new("target-acquired",
               type,
               G_SIGNAL_RUN_LAST,
               0,
               nullptr,
               nullptr,
               nullptr,
               G_TYPE_NONE,
               1,
               GST_TYPE_STRUCTURE);
  g_signal_new(
      "target-lost", type, G_SIGNAL_RUN_LAST, 0, nullptr, nullptr, nullptr, G_TYPE_NONE, 0);

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
  TrackProperties::install(object_class);
  install_signals(klass);

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipse tracker",
                                        "Filter/Analyzer/Video",
                                        "Detects and tracks an elliptical target on every buffer",
                                        "The gst-ellipse authors");
  add_video_pad_templates(element_class);
  element_class->change_state = gst_ellipse_track_change_state;

  auto* base_class = GST_BASE_TRANSFORM_CLASS(klass);
  base_class->transform_ip = gst_ellipse_track_transform_ip;
  base_class->src_event = gst_ellipse_track_src_event;
  base_class->sink_event = gst_ellipse_track_sink_event;
  base_class->start = gst_ellipse_track_start;
  base_class->stop = gst_ellipse_track_stop;
  base_class->query = gst_ellipse_track_query;
  base_class->set_caps = gst_ellipse_track_set_caps;
  base_class->get_unit_size = gst_ellipse_track_get_unit_size;
  base_class->accept_caps = gst_ellipse_track_accept_caps;
  base_class->propose_allocation = gst_ellipse_track_propose_allocation;
  base_class->filter_meta = gst_ellipse_track_filter_meta;
  GST_VIDEO_FILTER_CLASS(klass)->set_info = gst_ellipse_track_set_info;
}
