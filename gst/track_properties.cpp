// SPDX-License-Identifier: MIT
#include "gst/track_properties.hpp"

namespace {

// In the order of their ids.
enum {
  PROP_DETECTOR,
  PROP_TRACKING,
  PROP_REFINE,
  PROP_INTERVAL,
  PROP_MESSAGES,
  PROP_ATTACH_ROI_META,
  PROP_CANDIDATES,
  PROP_OVERLAY,
  PROP_OVERLAY_COLOR,
  PROP_LINE_WIDTH,
  PROP_FIRST_NUMBER,
};

GType gst_ellipse_detector_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::DetectorKind::kContours), "Contours: Keipour et al. 2021", "contours"},
      {int(ellipse::DetectorKind::kArcs), "Arcs of edges, fitted together", "arcs"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseDetector", kValues);
  return kType;
}

GType gst_ellipse_tracking_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::TrackingMode::kNone), "Each frame by itself", "none"},
      {int(ellipse::TrackingMode::kRedetect),
       "Detect again around the last place: Keipour et al. 2021",
       "redetect"},
      {int(ellipse::TrackingMode::kEdges),
       "Follow the learned edges of the pad from its predicted place",
       "edges"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseTracking", kValues);
  return kType;
}

GType gst_ellipse_refinement_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::Refinement::kNone), "Where the edges that it is followed by put it", "none"},
      {int(ellipse::Refinement::kEdges), "By the crests along its outer edge", "edges"},
      {int(ellipse::Refinement::kPhotometric),
       "By the brightness of all pixels along its outer edge",
       "photometric"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRefinement", kValues);
  return kType;
}

GType gst_ellipse_messages_get_type(void) {
  static const GEnumValue kValues[] = {
      {MESSAGES_NONE, "No messages", "none"},
      {MESSAGES_ON_CHANGE, "When the state or the id of the target changes", "on-change"},
      {MESSAGES_EVERY_FRAME, "For every analysed frame", "every-frame"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseMessages", kValues);
  return kType;
}

GParamSpec* param_spec_of(const ellipse::SettingInfo& info) {
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

// nullptr where the property is none of the tracker's numbers.
const ellipse::SettingInfo* number_info(guint which) {
  const auto infos = ellipse::setting_infos();
  const bool is_number = which >= PROP_FIRST_NUMBER && which - PROP_FIRST_NUMBER < infos.size();
  return is_number ? &infos[which - PROP_FIRST_NUMBER] : nullptr;
}

}  // namespace

void TrackProperties::install(GObjectClass* object_class, guint first_id) {
  const TrackProperties initial;
  const auto playing = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                GST_PARAM_MUTABLE_PLAYING);
  const auto install = [object_class](guint id, GParamSpec* spec) {
    g_object_class_install_property(object_class, id, spec);
  };
  install(first_id + PROP_DETECTOR,
          g_param_spec_enum("detector",
                            "Detector",
                            "How ellipses are found in a picture",
                            gst_ellipse_detector_get_type(),
                            static_cast<gint>(initial.tracker.detector),
                            playing));
  install(first_id + PROP_TRACKING,
          g_param_spec_enum("tracking",
                            "Tracking",
                            "How the target is followed from frame to frame",
                            gst_ellipse_tracking_get_type(),
                            static_cast<gint>(initial.tracker.tracking),
                            playing));
  install(first_id + PROP_REFINE,
          g_param_spec_enum("refine",
                            "Refine",
                            "What makes an ellipse exact that is followed by its edges",
                            gst_ellipse_refinement_get_type(),
                            static_cast<gint>(initial.tracker.refine),
                            playing));
  install(first_id + PROP_INTERVAL,
          g_param_spec_uint("interval",
                            "Interval",
                            "Analyse every n-th frame; the others pass as they are",
                            1,
                            G_MAXUINT,
                            initial.interval,
                            playing));
  install(first_id + PROP_MESSAGES,
          g_param_spec_enum("messages",
                            "Messages",
                            "When an element message \"ellipse\" is posted on the bus",
                            gst_ellipse_messages_get_type(),
                            initial.messages,
                            playing));
  install(first_id + PROP_ATTACH_ROI_META,
          g_param_spec_boolean("attach-roi-meta",
                               "Attach ROI meta",
                               "Also attach the target's box as GstVideoRegionOfInterestMeta",
                               initial.attach_roi_meta ? TRUE : FALSE,
                               playing));
  install(first_id + PROP_CANDIDATES,
          g_param_spec_boolean("candidates",
                               "Candidates",
                               "Also attach all other ellipses of the frame, as \"candidate\"",
                               initial.tracker.wants_candidates ? TRUE : FALSE,
                               playing));
  install_overlay_properties(object_class, first_id + PROP_OVERLAY, GST_ELLIPSE_OVERLAY_NONE);
  guint id = first_id + PROP_FIRST_NUMBER;
  for (const ellipse::SettingInfo& info : ellipse::setting_infos()) {
    install(id++, param_spec_of(info));
  }

  const auto mark = [](GType type) {
    gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  };
  mark(gst_ellipse_detector_get_type());
  mark(gst_ellipse_tracking_get_type());
  mark(gst_ellipse_refinement_get_type());
  mark(gst_ellipse_messages_get_type());
  mark(GST_TYPE_ELLIPSE_OVERLAY_FLAGS);
}

void TrackProperties::set(guint which, const GValue* value) {
  TrackProperties wanted = *this;
  if (const ellipse::SettingInfo* info = number_info(which)) {
    info->set(wanted.tracker,
              info->is_integer ? g_value_get_uint(value) : g_value_get_double(value));
  }
  if (which == PROP_DETECTOR) {
    wanted.tracker.detector = static_cast<ellipse::DetectorKind>(g_value_get_enum(value));
  }
  if (which == PROP_TRACKING) {
    wanted.tracker.tracking = static_cast<ellipse::TrackingMode>(g_value_get_enum(value));
  }
  if (which == PROP_REFINE) {
    wanted.tracker.refine = static_cast<ellipse::Refinement>(g_value_get_enum(value));
  }
  if (which == PROP_INTERVAL) wanted.interval = g_value_get_uint(value);
  if (which == PROP_MESSAGES) wanted.messages = g_value_get_enum(value);
  if (which == PROP_ATTACH_ROI_META) wanted.attach_roi_meta = g_value_get_boolean(value) != FALSE;
  if (which == PROP_CANDIDATES)
    wanted.tracker.wants_candidates = g_value_get_boolean(value) != FALSE;
  if (which >= PROP_OVERLAY && which <= PROP_LINE_WIDTH) {
    set_overlay_property(wanted.overlay, which - PROP_OVERLAY, value);
  }
  wanted.tracker.validate();
  *this = wanted;
}

void TrackProperties::get(guint which, GValue* value) const {
  if (const ellipse::SettingInfo* info = number_info(which)) {
    const double number = info->get(tracker);
    if (info->is_integer) {
      g_value_set_uint(value, static_cast<guint>(number));
    } else {
      g_value_set_double(value, number);
    }
  }
  if (which == PROP_DETECTOR) g_value_set_enum(value, static_cast<gint>(tracker.detector));
  if (which == PROP_TRACKING) g_value_set_enum(value, static_cast<gint>(tracker.tracking));
  if (which == PROP_REFINE) g_value_set_enum(value, static_cast<gint>(tracker.refine));
  if (which == PROP_INTERVAL) g_value_set_uint(value, interval);
  if (which == PROP_MESSAGES) g_value_set_enum(value, messages);
  if (which == PROP_ATTACH_ROI_META) g_value_set_boolean(value, attach_roi_meta ? TRUE : FALSE);
  if (which == PROP_CANDIDATES) g_value_set_boolean(value, tracker.wants_candidates ? TRUE : FALSE);
  if (which >= PROP_OVERLAY && which <= PROP_LINE_WIDTH) {
    get_overlay_property(overlay, which - PROP_OVERLAY, value);
  }
}
