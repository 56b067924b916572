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
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay.hpp"
#include "gst/track_stats.hpp"
#include "gst/video_view.hpp"

GST_DEBUG_CATEGORY_STATIC(gst_ellipse_track_debug);
#define GST_CAT_DEFAULT gst_ellipse_track_debug

enum { MESSAGES_NONE, MESSAGES_ON_CHANGE, MESSAGES_EVERY_FRAME };

enum { SIGNAL_TARGET_ACQUIRED, SIGNAL_TARGET_LOST, SIGNAL_RESET, N_SIGNALS };

enum {
  PROP_0,
  PROP_DETECTOR,
  PROP_TRACKING,
  PROP_INTERVAL,
  PROP_MESSAGES,
  PROP_ATTACH_ROI_META,
  PROP_TARGET,
  PROP_STATS,
  PROP_OVERLAY,
  PROP_OVERLAY_COLOR,
  PROP_LINE_WIDTH,
  PROP_FIRST_SETTING,  // the numbers of setting_infos() from here on
};

static guint signals[N_SIGNALS];

namespace {

constexpr guint kDefaultInterval = 1;

// Skipping helps where the analysis is what is late. Where another element is, the target must not
// be out of sight for good: after so many late frames one is analysed all the same.
constexpr guint kMostLateFrames = 4;
constexpr gboolean kDefaultAttachRoiMeta = TRUE;

// All that properties set; the streaming thread takes one copy a frame.
struct Settings {
  ellipse::TrackerSettings tracker;
  OverlayStyle overlay;
  guint interval = kDefaultInterval;
  int messages = MESSAGES_ON_CHANGE;
  bool attach_roi_meta = kDefaultAttachRoiMeta;
};

// What the streaming thread keeps from frame to frame.
struct Stream {
  ellipse::Tracker tracker;
  guint64 frame = 0;
  guint late_frames = 0;  // in a row
  std::optional<ellipse::Target> last_target;
};

}  // namespace

struct _GstEllipseTrack {
  GstVideoFilter parent;

  // Under the object lock.
  Settings* settings;
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

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink",
                            GST_PAD_SINK,
                            GST_PAD_ALWAYS,
                            GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE(GST_ELLIPSE_VIDEO_FORMATS)));

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src",
                            GST_PAD_SRC,
                            GST_PAD_ALWAYS,
                            GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE(GST_ELLIPSE_VIDEO_FORMATS)));

static GType gst_ellipse_detector_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::DetectorKind::kContours), "Contours: Keipour et al. 2021", "contours"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseDetector", kValues);
  return kType;
}

static GType gst_ellipse_tracking_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::TrackingMode::kNone), "Each frame by itself", "none"},
      {int(ellipse::TrackingMode::kRedetect),
       "Detect again around the last place: Keipour et al. 2021",
       "redetect"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseTracking", kValues);
  return kType;
}

static GType gst_ellipse_messages_get_type(void) {
  static const GEnumValue kValues[] = {
      {MESSAGES_NONE, "No messages", "none"},
      {MESSAGES_ON_CHANGE, "When the state or the id of the target changes", "on-change"},
      {MESSAGES_EVERY_FRAME, "For every analysed frame", "every-frame"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseMessages", kValues);
  return kType;
}

static const gchar* state_nick(const std::optional<ellipse::Target>& target) {
  if (!target) return "lost";
  switch (target->state) {
    case ellipse::TargetState::kDetected:
      return "detected";
    case ellipse::TargetState::kTracked:
      return "tracked";
    case ellipse::TargetState::kPredicted:
      return "predicted";
  }
  return "lost";
}

/* Properties */

static double number_of(const GValue* value, bool is_integer) {
  return is_integer ? g_value_get_uint(value) : g_value_get_double(value);
}

static void change(ellipse::TrackerSettings& settings, guint id, const GValue* value) {
  if (id == PROP_DETECTOR) {
    settings.detector = static_cast<ellipse::DetectorKind>(g_value_get_enum(value));
  } else if (id == PROP_TRACKING) {
    settings.tracking = static_cast<ellipse::TrackingMode>(g_value_get_enum(value));
  } else {
    const ellipse::SettingInfo& info = ellipse::setting_infos()[id - PROP_FIRST_SETTING];
    info.set(settings, number_of(value, info.is_integer));
  }
}

// Refuses what does not fit together, names it, and keeps the old value.
static void set_tracker_property(GstEllipseTrack* self, guint id, const GValue* value) {
  std::string refusal;
  GST_OBJECT_LOCK(self);
  ellipse::TrackerSettings wanted = self->settings->tracker;
  try {
    change(wanted, id, value);
    wanted.validate();
    self->settings->tracker = wanted;
  } catch (const std::exception& error) {
    refusal = error.what();
  }
  GST_OBJECT_UNLOCK(self);
  if (refusal.empty()) return;
  g_warning("%s: setting refused, the old value stays: %s", GST_OBJECT_NAME(self), refusal.c_str());
  GST_ELEMENT_WARNING(
      self, LIBRARY, SETTINGS, ("Setting refused: %s", refusal.c_str()), ("the old value stays"));
}

static void gst_ellipse_track_set_property(GObject* object,
                                           guint id,
                                           const GValue* value,
                                           GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TRACK(object);
  const bool is_known = id < PROP_FIRST_SETTING + ellipse::setting_infos().size();
  if (id == PROP_DETECTOR || id == PROP_TRACKING || (id >= PROP_FIRST_SETTING && is_known)) {
    set_tracker_property(self, id, value);
    return;
  }
  GST_OBJECT_LOCK(self);
  switch (id) {
    case PROP_INTERVAL:
      self->settings->interval = g_value_get_uint(value);
      break;
    case PROP_MESSAGES:
      self->settings->messages = g_value_get_enum(value);
      break;
    case PROP_ATTACH_ROI_META:
      self->settings->attach_roi_meta = g_value_get_boolean(value) != FALSE;
      break;
    case PROP_OVERLAY:
    case PROP_OVERLAY_COLOR:
    case PROP_LINE_WIDTH:
      set_overlay_property(self->settings->overlay, id - PROP_OVERLAY, value);
      break;
    default:
      G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
  GST_OBJECT_UNLOCK(self);
}

static void get_setting(const ellipse::TrackerSettings& settings, guint index, GValue* value) {
  const ellipse::SettingInfo& info = ellipse::setting_infos()[index];
  if (info.is_integer) {
    g_value_set_uint(value, static_cast<guint>(info.get(settings)));
  } else {
    g_value_set_double(value, info.get(settings));
  }
}

static void gst_ellipse_track_get_property(GObject* object,
                                           guint id,
                                           GValue* value,
                                           GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TRACK(object);
  GST_OBJECT_LOCK(self);
  const Settings& settings = *self->settings;
  switch (id) {
    case PROP_DETECTOR:
      g_value_set_enum(value, static_cast<gint>(settings.tracker.detector));
      break;
    case PROP_TRACKING:
      g_value_set_enum(value, static_cast<gint>(settings.tracker.tracking));
      break;
    case PROP_INTERVAL:
      g_value_set_uint(value, settings.interval);
      break;
    case PROP_MESSAGES:
      g_value_set_enum(value, settings.messages);
      break;
    case PROP_ATTACH_ROI_META:
      g_value_set_boolean(value, settings.attach_roi_meta);
      break;
    case PROP_TARGET:
      g_value_set_boxed(value, self->target);
      break;
    case PROP_STATS:
      g_value_take_boxed(value, self->stats->to_structure());
      break;
    case PROP_OVERLAY:
    case PROP_OVERLAY_COLOR:
    case PROP_LINE_WIDTH:
      get_overlay_property(settings.overlay, id - PROP_OVERLAY, value);
      break;
    default:
      if (id - PROP_FIRST_SETTING < ellipse::setting_infos().size()) {
        get_setting(settings.tracker, id - PROP_FIRST_SETTING, value);
      } else {
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
      }
  }
  GST_OBJECT_UNLOCK(self);
}

/* What goes out with a frame */

static const GstEllipseMeta* attach_ellipse_meta(GstBuffer* buffer,
                                                 const ellipse::Target& target,
                                                 const GstVideoInfo& info,
                                                 GstClockTime processing_time) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->state = static_cast<GstEllipseState>(target.state);
  meta->id = target.id;
  meta->cx = target.ellipse.cx;
  meta->cy = target.ellipse.cy;
  meta->semi_major = target.ellipse.semi_major;
  meta->semi_minor = target.ellipse.semi_minor;
  meta->angle_rad = target.ellipse.angle_rad;
  meta->contour_overlap = target.contour_overlap;
  meta->ellipse_overlap = target.ellipse_overlap;
  meta->visible_fraction = target.visible_fraction;
  meta->scale = static_cast<guint>(target.scale);
  meta->roi_x = target.search_region.x;
  meta->roi_y = target.search_region.y;
  meta->roi_width = static_cast<guint>(target.search_region.width);
  meta->roi_height = static_cast<guint>(target.search_region.height);
  meta->frame_width = static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info));
  meta->frame_height = static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info));
  meta->pts = GST_BUFFER_PTS(buffer);
  meta->processing_time = processing_time;
  return meta;
}

// The standard metadata for a region of interest: the target's upright box inside the frame.
static void attach_roi_meta(GstBuffer* buffer, const GstEllipseMeta* meta) {
  const ellipse::Ellipse e{meta->cx, meta->cy, meta->semi_major, meta->semi_minor, meta->angle_rad};
  const Eigen::Vector2d half = ellipse::half_extent(e);
  const auto first = [](double at) { return static_cast<guint>(std::max(0.0, std::floor(at))); };
  const auto last = [](double at, guint size) {
    return static_cast<guint>(std::clamp(std::ceil(at) + 1.0, 0.0, static_cast<double>(size)));
  };
  const guint left = first(e.cx - half.x());
  const guint top = first(e.cy - half.y());
  const guint right = last(e.cx + half.x(), meta->frame_width);
  const guint bottom = last(e.cy + half.y(), meta->frame_height);
  if (left >= right || top >= bottom) return;
  GstVideoRegionOfInterestMeta* roi = gst_buffer_add_video_region_of_interest_meta(
      buffer, "ellipse", left, top, right - left, bottom - top);
  gst_video_region_of_interest_meta_add_param(roi, gst_ellipse_meta_to_structure(meta));
}

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
                                     const Settings& settings,
                                     const std::optional<ellipse::Target>& target,
                                     GstClockTime processing_time) {
  const GstEllipseMeta* meta = nullptr;
  GstStructure* details = nullptr;
  if (target) {
    meta = attach_ellipse_meta(buffer, *target, GST_VIDEO_FILTER(self)->in_info, processing_time);
    if (settings.attach_roi_meta) attach_roi_meta(buffer, meta);
    details = gst_ellipse_meta_to_structure(meta);
  }
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target = target;

  GST_OBJECT_LOCK(self);
  self->stats->add_analysed(target, processing_time);
  gst_clear_structure(&self->target);
  if (details != nullptr) self->target = gst_structure_copy(details);
  GST_OBJECT_UNLOCK(self);

  const bool has_changed = before.has_value() != target.has_value() ||
                           (target && (before->id != target->id || before->state != target->state));
  if (settings.messages == MESSAGES_EVERY_FRAME ||
      (settings.messages == MESSAGES_ON_CHANGE && has_changed)) {
    post_message(self, GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer), target, details);
  }
  emit_change(self, before, target, details);
  gst_clear_structure(&details);
  return meta;
}

/* Streaming */

// Starts over, and says so to those who still count on the target.
static void forget_target(GstEllipseTrack* self, const Settings& settings) {
  self->stream->tracker.reset();
  const std::optional<ellipse::Target> before = self->stream->last_target;
  self->stream->last_target.reset();
  GST_OBJECT_LOCK(self);
  self->stats->forget_target();
  gst_clear_structure(&self->target);
  GST_OBJECT_UNLOCK(self);
  if (!before) return;
  if (settings.messages != MESSAGES_NONE) {
    post_message(self, GST_CLOCK_TIME_NONE, GST_CLOCK_TIME_NONE, std::nullopt, nullptr);
  }
  emit_change(self, before, std::nullopt, nullptr);
}

static Settings take_settings(GstEllipseTrack* self) {
  GST_OBJECT_LOCK(self);
  const Settings settings = *self->settings;
  const bool reset_is_due = self->reset_is_due;
  self->reset_is_due = false;
  GST_OBJECT_UNLOCK(self);
  if (reset_is_due) forget_target(self, settings);
  return settings;
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

static void analyse(GstEllipseTrack* self, GstBuffer* buffer, const Settings& settings) {
  const bool draws = settings.overlay.parts != GST_ELLIPSE_OVERLAY_NONE;
  MappedFrame mapped(
      GST_VIDEO_FILTER(self)->in_info, buffer, draws ? GST_MAP_READWRITE : GST_MAP_READ);
  if (!mapped.is_mapped()) {
    GST_ELEMENT_WARNING(self, RESOURCE, READ, ("A buffer cannot be read."), ("it passes as it is"));
    skip(self);
    return;
  }
  const GstClockTime start = gst_util_get_timestamp();
  ellipse::Tracker& tracker = self->stream->tracker;
  tracker.configure(settings.tracker);
  const auto target =
      tracker.process(pixel_view_of(mapped.frame()), static_cast<gint64>(GST_BUFFER_PTS(buffer)));
  const GstEllipseMeta* meta =
      publish(self, buffer, settings, target, gst_util_get_timestamp() - start);
  if (draws && meta != nullptr) draw_overlay(mapped.frame(), *meta, settings.overlay);
}

static GstFlowReturn gst_ellipse_track_transform_ip(GstBaseTransform* base, GstBuffer* buffer) {
  auto* self = GST_ELLIPSE_TRACK(base);
  const GstClockTime stream_time = stream_time_of(self, GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(stream_time)) gst_object_sync_values(GST_OBJECT(self), stream_time);

  const Settings settings = take_settings(self);
  const bool is_turn = self->stream->frame++ % settings.interval == 0;
  if (!is_turn || must_hurry(self, buffer)) {
    skip(self);
    return GST_FLOW_OK;
  }
  try {
    analyse(self, buffer, settings);
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
  const Settings settings = *self->settings;
  self->earliest_time = GST_CLOCK_TIME_NONE;
  GST_OBJECT_UNLOCK(self);
  forget_target(self, settings);
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
  delete self->settings;
  G_OBJECT_CLASS(gst_ellipse_track_parent_class)->finalize(object);
}

static void gst_ellipse_track_init(GstEllipseTrack* self) {
  self->settings = new Settings();
  self->stats = new TrackStats();
  self->stream = new Stream();
  self->earliest_time = GST_CLOCK_TIME_NONE;
  gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
}

static GParamSpec* param_spec_of(const ellipse::SettingInfo& info) {
  const double initial = info.get(ellipse::TrackerSettings{});
  const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                              GST_PARAM_MUTABLE_PLAYING |
                                              (info.is_controllable ? GST_PARAM_CONTROLLABLE : 0));
  if (info.is_integer) {
    return g_param_spec_uint(info.name,
                             info.name,
                             info.description,
                             static_cast<guint>(info.range.min),
                             static_cast<guint>(info.range.max),
                             static_cast<guint>(initial),
                             flags);
  }
  return g_param_spec_double(
      info.name, info.name, info.description, info.range.min, info.range.max, initial, flags);
}

static void install_properties(GObjectClass* object_class) {
  const ellipse::TrackerSettings initial;
  const auto playing = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                GST_PARAM_MUTABLE_PLAYING);
  const auto readable = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  const auto install = [&](guint id, GParamSpec* spec) {
    g_object_class_install_property(object_class, id, spec);
  };
  install(PROP_DETECTOR,
          g_param_spec_enum("detector",
                            "Detector",
                            "How ellipses are found in a picture",
                            gst_ellipse_detector_get_type(),
                            static_cast<gint>(initial.detector),
                            playing));
  install(PROP_TRACKING,
          g_param_spec_enum("tracking",
                            "Tracking",
                            "How the target is followed from frame to frame",
                            gst_ellipse_tracking_get_type(),
                            static_cast<gint>(initial.tracking),
                            playing));
  install(PROP_INTERVAL,
          g_param_spec_uint("interval",
                            "Interval",
                            "Analyse every n-th frame; the others pass as they are",
                            1,
                            G_MAXUINT,
                            kDefaultInterval,
                            playing));
  install(PROP_MESSAGES,
          g_param_spec_enum("messages",
                            "Messages",
                            "When an element message \"ellipse\" is posted on the bus",
                            gst_ellipse_messages_get_type(),
                            MESSAGES_ON_CHANGE,
                            playing));
  install(PROP_ATTACH_ROI_META,
          g_param_spec_boolean("attach-roi-meta",
                               "Attach ROI meta",
                               "Also attach the target's box as GstVideoRegionOfInterestMeta",
                               kDefaultAttachRoiMeta,
                               playing));
  install(PROP_TARGET,
          g_param_spec_boxed("target",
                             "Target",
                             "The target in the last analysed frame, NULL where there was none",
                             GST_TYPE_STRUCTURE,
                             readable));
  install(PROP_STATS,
          g_param_spec_boxed("stats",
                             "Statistics",
                             "Counts of frames, and processing times in ns",
                             GST_TYPE_STRUCTURE,
                             readable));
  install_overlay_properties(object_class, PROP_OVERLAY, GST_ELLIPSE_OVERLAY_NONE);
  guint id = PROP_FIRST_SETTING;
  for (const ellipse::SettingInfo& info : ellipse::setting_infos()) {
    install(id++, param_spec_of(info));
  }
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
  gst_element_class_add_static_pad_template(element_class, &sink_template);
  gst_element_class_add_static_pad_template(element_class, &src_template);

  auto* base_class = GST_BASE_TRANSFORM_CLASS(klass);
  base_class->transform_ip = gst_ellipse_track_transform_ip;
  base_class->src_event = gst_ellipse_track_src_event;
  base_class->sink_event = gst_ellipse_track_sink_event;
  base_class->start = gst_ellipse_track_start;
  base_class->stop = gst_ellipse_track_stop;
  base_class->propose_allocation = gst_ellipse_track_propose_allocation;

  gst_type_mark_as_plugin_api(gst_ellipse_detector_get_type(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(gst_ellipse_tracking_get_type(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(gst_ellipse_messages_get_type(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(GST_TYPE_ELLIPSE_OVERLAY_FLAGS, static_cast<GstPluginAPIFlags>(0));
}
