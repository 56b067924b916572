// SPDX-License-Identifier: MIT
#include "gst/track/track_properties.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/camera/camera_file.hpp"
#include "core/detection/evidence.hpp"
#include "core/tracking/setting_effect.hpp"
#include "gst/track/analytics_meta.hpp"
#include "gst/track/track_enums.hpp"

namespace {

struct Purpose {
  std::string_view property;
  const char* purpose;
};

// In the order of "Properties by purpose" in docs/elements.md; the properties' ids follow it.
constexpr Purpose kPurposes[] = {
    {"detector", "detector"},
    {"min-probability", "detector"},
    {"evidence-file", "detector"},
    {"detect-contour-overlap", "detector"},
    {"detect-ellipse-overlap", "detector"},
    {"edge-low", "detector"},
    {"edge-high", "detector"},
    {"candidates", "detector"},
    {"tracking", "tracker"},
    {"refine", "tracker"},
    {"ring-ratio", "tracker"},
    {"track-contour-overlap", "tracker"},
    {"track-ellipse-overlap", "tracker"},
    {"roi-expansion", "tracker"},
    {"min-axis", "limits"},
    {"max-axis", "limits"},
    {"max-axis-ratio", "limits"},
    {"min-contour-size", "limits"},
    {"roi-source", "search region"},
    {"roi", "search region"},
    {"roi-type", "search region"},
    {"min-target-size", "scale"},
    {"max-target-size", "scale"},
    {"max-scale", "scale"},
    {"camera-file", "lens and pose"},
    {"hfov", "lens and pose"},
    {"fx", "lens and pose"},
    {"fy", "lens and pose"},
    {"cx", "lens and pose"},
    {"cy", "lens and pose"},
    {"target-diameter", "lens and pose"},
    {"gravity", "lens and pose"},
    {"messages", "output"},
    {"attach-roi-meta", "output"},
    {"attach-analytics", "output"},
    {"overlay", "output"},
    {"overlay-color", "output"},
    {"line-width", "output"},
    {"target", "output"},
    {"stats", "output"},
    {"interval", "performance"},
    {"max-processing-time", "performance"},
};

constexpr auto kPlaying = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING);
// GLib copies blurbs that are composed at run time.
constexpr auto kPlayingOwnBlurb = static_cast<GParamFlags>(kPlaying & ~G_PARAM_STATIC_BLURB);

GParamSpec* param_spec_of(const ellipse::SettingInfo& info) {
  const double initial = info.get(ellipse::TrackerSettings{});
  const auto flags = static_cast<GParamFlags>(kPlayingOwnBlurb |
                                              (info.is_controllable ? GST_PARAM_CONTROLLABLE : 0));
  const std::string blurb = ellipse::blurb_of(info.description, info.effect);
  if (info.is_integer) {
    return g_param_spec_uint(info.name,
                             info.name,
                             blurb.c_str(),
                             static_cast<guint>(info.range.min),
                             static_cast<guint>(info.range.max),
                             static_cast<guint>(initial),
                             flags);
  }
  return g_param_spec_double(
      info.name, info.name, blurb.c_str(), info.range.min, info.range.max, initial, flags);
}

// Reads a vector of doubles or ints. An empty array, GStreamer's default for every array, is a zero
// vector.
std::array<double, 3> vector_from(const GValue* value, const char* name) {
  std::array<double, 3> numbers{};
  if (gst_value_array_get_size(value) == 0) return numbers;
  if (gst_value_array_get_size(value) != numbers.size()) {
    throw std::invalid_argument(std::string(name) + " must have the form <x, y, z>");
  }
  for (guint i = 0; i < numbers.size(); ++i) {
    const GValue* number = gst_value_array_get_value(value, i);
    GValue real = G_VALUE_INIT;
    g_value_init(&real, G_TYPE_DOUBLE);
    const bool is_number = g_value_transform(number, &real) != FALSE;
    numbers[i] = g_value_get_double(&real);
    g_value_unset(&real);
    if (!is_number) throw std::invalid_argument(std::string(name) + " must contain numbers only");
  }
  return numbers;
}

void write_vector(const std::array<double, 3>& numbers, GValue* value) {
  for (const double number : numbers) {
    GValue element = G_VALUE_INIT;
    g_value_init(&element, G_TYPE_DOUBLE);
    g_value_set_double(&element, number);
    gst_value_array_append_and_take_value(value, &element);
  }
}

// Reads a region; an empty array is an empty region.
ellipse::Rect rect_from(const GValue* value) {
  std::array<int, 4> numbers{};
  if (gst_value_array_get_size(value) == 0) return {};
  if (gst_value_array_get_size(value) != numbers.size()) {
    throw std::invalid_argument("roi must have the form <x, y, width, height>");
  }
  for (guint i = 0; i < numbers.size(); ++i) {
    const GValue* number = gst_value_array_get_value(value, i);
    if (!G_VALUE_HOLDS_INT(number)) throw std::invalid_argument("roi must contain ints only");
    numbers[i] = g_value_get_int(number);
  }
  if (numbers[2] < 0 || numbers[3] < 0) {
    throw std::invalid_argument("roi must not have a negative width or height");
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void write_rect(const ellipse::Rect& rect, GValue* value) {
  for (const int number : {rect.x, rect.y, rect.width, rect.height}) {
    GValue element = G_VALUE_INIT;
    g_value_init(&element, G_TYPE_INT);
    g_value_set_int(&element, number);
    gst_value_array_append_and_take_value(value, &element);
  }
}

bool analytics_from(const GValue* value) {
  const bool is_enabled = g_value_get_boolean(value) != FALSE;
  if (is_enabled && !has_analytics()) {
    throw std::invalid_argument(
        "attach-analytics needs a build with GStreamer 1.24 or later and gstreamer-analytics-1.0");
  }
  return is_enabled;
}

// nullptr if the property is not one of the tracker's numbers.
const ellipse::SettingInfo* number_info(std::string_view name) {
  const auto infos = ellipse::setting_infos();
  const auto found =
      std::find_if(infos.begin(), infos.end(), [&](const ellipse::SettingInfo& info) {
        return name == info.name;
      });
  return found != infos.end() ? &*found : nullptr;
}

class Installer {
 public:
  explicit Installer(GObjectClass* object_class) : object_class_(object_class) {}

  void operator()(GParamSpec* spec) const {
    const auto found = std::find_if(std::begin(kPurposes),
                                    std::end(kPurposes),
                                    [&](const Purpose& p) { return p.property == spec->name; });
    g_assert(found != std::end(kPurposes));
    g_param_spec_set_qdata(spec, purpose_quark(), const_cast<char*>(found->purpose));
    g_object_class_install_property(
        object_class_, static_cast<guint>(found - std::begin(kPurposes)) + 1, spec);
  }

 private:
  GObjectClass* object_class_;
};

void install_methods(const Installer& install, const TrackProperties& initial) {
  install(g_param_spec_enum("detector",
                            "Detector",
                            "Ellipse detection method",
                            gst_ellipse_detector_get_type(),
                            static_cast<gint>(initial.tracker.detector),
                            kPlaying));
  install(g_param_spec_enum("tracking",
                            "Tracking",
                            "Tracking method",
                            gst_ellipse_tracking_get_type(),
                            static_cast<gint>(initial.tracker.tracking),
                            kPlaying));
  const std::string blurb = ellipse::blurb_of("Refinement of the ellipse of a followed target",
                                              ellipse::effect_of("refine"));
  install(g_param_spec_enum("refine",
                            "Refine",
                            blurb.c_str(),
                            gst_ellipse_refinement_get_type(),
                            static_cast<gint>(initial.tracker.refine),
                            kPlayingOwnBlurb));
}

void install_load(const Installer& install, const TrackProperties& initial) {
  install(g_param_spec_uint("interval",
                            "Interval",
                            "Analyse every n-th frame; the others pass unchanged",
                            1,
                            G_MAXUINT,
                            initial.interval,
                            kPlaying));
  install(g_param_spec_uint64("max-processing-time",
                              "Maximum processing time",
                              "Maximum time per frame [ns]; above it the search gets coarser, then "
                              "frames pass without analysis; 0 = no limit",
                              0,
                              G_MAXUINT64,
                              initial.max_processing_time,
                              kPlaying));
}

void install_reports(const Installer& install, const TrackProperties& initial) {
  install(g_param_spec_enum("messages",
                            "Messages",
                            "When to post an element message \"ellipse\" on the bus",
                            gst_ellipse_messages_get_type(),
                            initial.messages,
                            kPlaying));
  install(
      g_param_spec_boolean("attach-roi-meta",
                           "Attach ROI meta",
                           "Also attach the target's bounding box as GstVideoRegionOfInterestMeta",
                           initial.attach_roi_meta ? TRUE : FALSE,
                           kPlaying));
  install(g_param_spec_boolean("attach-analytics",
                               "Attach analytics",
                               "Also attach each ellipse as a detected object in "
                               "GstAnalyticsRelationMeta; needs GStreamer 1.24",
                               initial.attach_analytics ? TRUE : FALSE,
                               kPlaying));
  install(g_param_spec_boolean("candidates",
                               "Candidates",
                               "Also attach all other ellipses of the frame as \"candidate\"; the "
                               "detector then runs on every frame",
                               initial.tracker.wants_candidates ? TRUE : FALSE,
                               kPlaying));
}

void install_region(const Installer& install, const TrackProperties& initial) {
  install(g_param_spec_enum("roi-source",
                            "ROI source",
                            "Source of the search region",
                            gst_ellipse_roi_source_get_type(),
                            initial.roi_source,
                            kPlaying));
  install(gst_param_spec_array(
      "roi",
      "ROI",
      "Search region of roi-source=property, as <x, y, width, height> in the frame [px]",
      g_param_spec_int(
          "number", "Number", "x, y, width or height [px]", G_MININT, G_MAXINT, 0, kPlaying),
      kPlaying));
  install(g_param_spec_string("roi-type",
                              "ROI type",
                              "Type of the regions that roi-source=meta searches; empty = any",
                              "",
                              kPlaying));
}

void install_results(const Installer& install) {
  const auto readable = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  install(g_param_spec_boxed("target",
                             "Target",
                             "Target in the last analysed frame; NULL = none",
                             GST_TYPE_STRUCTURE,
                             readable));
  install(g_param_spec_boxed("stats",
                             "Statistics",
                             "Frame counts and processing times [ns]",
                             GST_TYPE_STRUCTURE,
                             readable));
}

void install_files(const Installer& install) {
  install(g_param_spec_string("evidence-file",
                              "Evidence file",
                              "Evidence table of detector=arcs, from ellipse-evaluate "
                              "--fit-evidence; empty = built-in",
                              "",
                              kPlaying));
  install(
      g_param_spec_string("camera-file",
                          "Camera file",
                          "Camera calibration file, OpenCV or ROS format; overrides fx and hfov; "
                          "empty = none",
                          "",
                          kPlaying));
  install(gst_param_spec_array(
      "gravity",
      "Gravity",
      "Downward direction in the camera's frame, as <x, y, z>; selects "
      "between the two possible tilts of a level target; "
      "<0, 0, 0> = unknown",
      g_param_spec_double(
          "number", "Number", "x, y or z, in any unit", -G_MAXDOUBLE, G_MAXDOUBLE, 0.0, kPlaying),
      kPlaying));
}

}  // namespace

void TrackProperties::install(GObjectClass* object_class) {
  const TrackProperties initial;
  const Installer install(object_class);
  install_methods(install, initial);
  install_load(install, initial);
  install_reports(install, initial);
  install_region(install, initial);
  install_files(install);
  install_results(install);
  for (GParamSpec* spec : overlay_param_specs(GST_ELLIPSE_OVERLAY_NONE)) install(spec);
  for (const ellipse::SettingInfo& info : ellipse::setting_infos()) install(param_spec_of(info));

  const auto mark = [](GType type) {
    gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  };
  mark(gst_ellipse_detector_get_type());
  mark(gst_ellipse_tracking_get_type());
  mark(gst_ellipse_refinement_get_type());
  mark(gst_ellipse_messages_get_type());
  mark(gst_ellipse_roi_source_get_type());
  mark(GST_TYPE_ELLIPSE_OVERLAY_FLAGS);
}

PropertyChange::PropertyChange(std::string_view name, const GValue* value)
    : name_(name), value_(value) {
  if (name != "camera-file" && name != "evidence-file") return;
  if (g_value_get_string(value) != nullptr) file_ = g_value_get_string(value);
  if (file_.empty()) return;
  if (name == "camera-file") camera_ = ellipse::read_camera(file_);
  if (name == "evidence-file") evidence_ = ellipse::read_evidence(file_);
}

void PropertyChange::apply_to(TrackProperties& properties) const {
  ellipse::TrackerSettings& tracker = properties.tracker;
  const GValue* value = value_;
  if (const ellipse::SettingInfo* info = number_info(name_)) {
    info->set(tracker, info->is_integer ? g_value_get_uint(value) : g_value_get_double(value));
  }
  if (name_ == "detector") {
    tracker.detector = static_cast<ellipse::DetectorKind>(g_value_get_enum(value));
  }
  if (name_ == "tracking") {
    tracker.tracking = static_cast<ellipse::TrackingMode>(g_value_get_enum(value));
  }
  if (name_ == "refine") {
    tracker.refine = static_cast<ellipse::Refinement>(g_value_get_enum(value));
  }
  if (name_ == "interval") properties.interval = g_value_get_uint(value);
  if (name_ == "messages") properties.messages = g_value_get_enum(value);
  if (name_ == "attach-roi-meta") {
    properties.attach_roi_meta = g_value_get_boolean(value) != FALSE;
  }
  if (name_ == "attach-analytics") properties.attach_analytics = analytics_from(value);
  if (name_ == "candidates") tracker.wants_candidates = g_value_get_boolean(value) != FALSE;
  if (name_ == "roi-source") properties.roi_source = g_value_get_enum(value);
  if (name_ == "roi") properties.roi = rect_from(value);
  if (name_ == "roi-type") {
    const gchar* type = g_value_get_string(value);
    properties.roi_type = type != nullptr ? type : "";
  }
  if (name_ == "max-processing-time") {
    properties.max_processing_time = g_value_get_uint64(value);
  }
  if (name_ == "camera-file") {
    tracker.camera = camera_;
    properties.camera_file = file_;
  }
  if (name_ == "evidence-file") {
    tracker.evidence = evidence_;
    properties.evidence_file = file_;
  }
  if (name_ == "gravity") tracker.gravity = vector_from(value, "gravity");
  set_overlay_property(properties.overlay, name_, value);
}

void TrackProperties::get(std::string_view name, GValue* value) const {
  if (const ellipse::SettingInfo* info = number_info(name)) {
    const double number = info->get(tracker);
    if (info->is_integer) {
      g_value_set_uint(value, static_cast<guint>(number));
    } else {
      g_value_set_double(value, number);
    }
  }
  if (name == "detector") g_value_set_enum(value, static_cast<gint>(tracker.detector));
  if (name == "tracking") g_value_set_enum(value, static_cast<gint>(tracker.tracking));
  if (name == "refine") g_value_set_enum(value, static_cast<gint>(tracker.refine));
  if (name == "interval") g_value_set_uint(value, interval);
  if (name == "messages") g_value_set_enum(value, messages);
  if (name == "attach-roi-meta") g_value_set_boolean(value, attach_roi_meta ? TRUE : FALSE);
  if (name == "attach-analytics") g_value_set_boolean(value, attach_analytics ? TRUE : FALSE);
  if (name == "candidates") g_value_set_boolean(value, tracker.wants_candidates ? TRUE : FALSE);
  if (name == "roi-source") g_value_set_enum(value, roi_source);
  if (name == "roi") write_rect(roi, value);
  if (name == "roi-type") g_value_set_string(value, roi_type.c_str());
  if (name == "max-processing-time") g_value_set_uint64(value, max_processing_time);
  if (name == "camera-file") g_value_set_string(value, camera_file.c_str());
  if (name == "evidence-file") g_value_set_string(value, evidence_file.c_str());
  if (name == "gravity") write_vector(tracker.gravity, value);
  get_overlay_property(overlay, name, value);
}
