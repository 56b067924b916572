// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/properties.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "examples/live/json_writer.hpp"
#include "examples/live/pipeline/property_input.hpp"
#include "examples/live/pipeline/property_json.hpp"
#include "examples/live/ref.hpp"
#include "examples/live/request_json.hpp"

namespace live {
namespace {

constexpr char kCameraFile[] = "camera-file";

// RAII wrapper of a GValue.
class Value {
 public:
  explicit Value(const GParamSpec* spec) { g_value_init(&value_, G_PARAM_SPEC_VALUE_TYPE(spec)); }
  ~Value() { g_value_unset(&value_); }
  Value(const Value&) = delete;
  Value& operator=(const Value&) = delete;

  [[nodiscard]] GValue* get() { return &value_; }

 private:
  GValue value_ = G_VALUE_INIT;
};

std::string text_in(Value& value) {
  const gchar* text = g_value_get_string(value.get());
  return text != nullptr ? text : "";
}

struct Change {
  GParamSpec* spec;
  std::unique_ptr<Value> value;
};

// The element's own writable properties.
std::vector<GParamSpec*> tunable(GstElement* tracker) {
  guint count = 0;
  const Ref<gchar> list(reinterpret_cast<gchar*>(
      g_object_class_list_properties(G_OBJECT_GET_CLASS(tracker), &count)));
  auto** specs = reinterpret_cast<GParamSpec**>(list.get());
  std::vector<GParamSpec*> result;
  std::copy_if(specs, specs + count, std::back_inserter(result), [tracker](const GParamSpec* spec) {
    // With evidence-file, clients could make the program open any file.
    return spec->owner_type == G_OBJECT_TYPE(tracker) && (spec->flags & G_PARAM_WRITABLE) != 0 &&
           g_strcmp0(spec->name, "evidence-file") != 0;
  });
  return result;
}

// Restricts a client's camera-file to the calibration folder. The current value is always accepted.
void check_camera(GstElement* tracker, const CameraFolder& cameras, Change& change) {
  if (g_strcmp0(change.spec->name, kCameraFile) != 0) return;
  Value now(change.spec);
  g_object_get_property(G_OBJECT(tracker), kCameraFile, now.get());
  const std::string wanted = g_value_get_string(change.value->get());
  if (wanted.empty() || wanted == text_in(now)) return;
  g_value_set_string(change.value->get(), cameras.path_of(wanted).c_str());
}

std::vector<Change> parse_changes(GstElement* tracker,
                                  const CameraFolder& cameras,
                                  const std::string& json) {
  std::vector<Change> changes;
  if (json.empty()) return changes;
  const RequestJson object(json);
  const std::vector<GParamSpec*> known = tunable(tracker);
  JsonObjectIter iter;
  json_object_iter_init(&iter, object.object());
  const gchar* name = nullptr;
  JsonNode* node = nullptr;
  while (json_object_iter_next(&iter, &name, &node)) {
    const auto spec = std::find_if(known.begin(), known.end(), [name](const GParamSpec* each) {
      return g_strcmp0(each->name, name) == 0;
    });
    if (spec == known.end()) {
      throw std::invalid_argument(std::string(name) + ": no such writable property");
    }
    Change change{*spec, std::make_unique<Value>(*spec)};
    read_value(*spec, node, change.value->get());
    check_camera(tracker, cameras, change);
    changes.push_back(std::move(change));
  }
  return changes;
}

/* Conversion to TrackerSettings */

void apply(ellipse::TrackerSettings& settings, const char* name, const GValue* value) {
  const std::string property = name;
  if (property == "detector") {
    settings.detector = static_cast<ellipse::DetectorKind>(g_value_get_enum(value));
  } else if (property == "tracking") {
    settings.tracking = static_cast<ellipse::TrackingMode>(g_value_get_enum(value));
  } else if (property == "refine") {
    settings.refine = static_cast<ellipse::Refinement>(g_value_get_enum(value));
  }
  for (const ellipse::SettingInfo& info : ellipse::setting_infos()) {
    if (property != info.name) continue;
    info.set(settings, info.is_integer ? g_value_get_uint(value) : g_value_get_double(value));
  }
}

ellipse::TrackerSettings settings_of(GstElement* tracker) {
  ellipse::TrackerSettings settings;
  for (GParamSpec* spec : tunable(tracker)) {
    Value value(spec);
    g_object_get_property(G_OBJECT(tracker), spec->name, value.get());
    apply(settings, spec->name, value.get());
  }
  return settings;
}

ellipse::TrackerSettings settings_after(GstElement* tracker, const std::vector<Change>& changes) {
  ellipse::TrackerSettings settings = settings_of(tracker);
  for (const Change& change : changes) apply(settings, change.spec->name, change.value->get());
  settings.validate();
  return settings;
}

// A property's value after the changes.
Change value_after(GstElement* tracker, std::vector<Change>& changes, const char* name) {
  for (Change& change : changes) {
    if (g_str_equal(change.spec->name, name)) return std::move(change);
  }
  GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(tracker), name);
  Change now{spec, std::make_unique<Value>(spec)};
  g_object_get_property(G_OBJECT(tracker), name, now.value->get());
  return now;
}

// Whether a change widens a pair of minimum and maximum. Widening changes are set before narrowing
// ones, so that no minimum ever exceeds its maximum.
bool widens(const GParamSpec* spec, const GValue* from, const GValue* to) {
  const std::string name = spec->name;
  const bool is_upper = name.starts_with("max-") || name == "edge-high";
  const bool is_lower = name.starts_with("min-") || name == "edge-low";
  if (!G_IS_PARAM_SPEC_DOUBLE(spec) || (!is_upper && !is_lower)) return false;
  const double before = g_value_get_double(from);
  const double after = g_value_get_double(to);
  if (name == "edge-high" && (before == 0.0 || after == 0.0)) return after == 0.0;  // 0 = no limit
  return is_upper ? after > before : after < before;
}

// A region without a width, or a vector of length 0.
bool is_unset(const GParamSpec* spec, const GValue* value) {
  constexpr guint kWidth = 2;
  if (is_rect(spec)) {
    return gst_value_array_get_size(value) <= kWidth ||
           g_value_get_int(gst_value_array_get_value(value, kWidth)) == 0;
  }
  if (!is_vector(spec)) return false;
  for (guint i = 0; i < gst_value_array_get_size(value); ++i) {
    if (g_value_get_double(gst_value_array_get_value(value, i)) != 0.0) return false;
  }
  return true;
}

// Requires changes that are valid together.
void apply_changes(GstElement* tracker, std::vector<Change>& changes) {
  std::stable_partition(changes.begin(), changes.end(), [tracker](const Change& change) {
    Value now(change.spec);
    g_object_get_property(G_OBJECT(tracker), change.spec->name, now.get());
    return widens(change.spec, now.get(), change.value->get());
  });
  for (const Change& change : changes) {
    g_object_set_property(G_OBJECT(tracker), change.spec->name, change.value->get());
  }
}

}  // namespace

std::string Properties::to_json() const {
  JsonWriter json;
  json.begin_array();
  const ellipse::TrackerSettings settings = settings_of(tracker_);
  for (GParamSpec* spec : tunable(tracker_)) {
    const bool is_camera = g_strcmp0(spec->name, kCameraFile) == 0;
    write_property(json, tracker_, spec, !is_camera || cameras_.is_open(), settings);
  }
  return json.end_array().text() + "\n";
}

bool Properties::set(const std::string& json) {
  if (json.empty()) throw std::invalid_argument("expected an object {\"name\": value, ...}");
  std::vector<Change> changes = parse_changes(tracker_, cameras_, json);
  (void)settings_after(tracker_, changes);
  std::erase_if(changes, [this](const Change& change) {
    Value now(change.spec);
    g_object_get_property(G_OBJECT(tracker_), change.spec->name, now.get());
    return gst_value_compare(now.get(), change.value->get()) == GST_VALUE_EQUAL;
  });
  apply_changes(tracker_, changes);
  return !changes.empty();
}

ellipse::TrackerSettings Properties::settings_with(const std::string& json) const {
  return settings_after(tracker_, parse_changes(tracker_, cameras_, json));
}

std::optional<ellipse::Rect> Properties::region_with(const std::string& json) const {
  std::vector<Change> changes = parse_changes(tracker_, cameras_, json);
  const Change source = value_after(tracker_, changes, "roi-source");
  const Change roi = value_after(tracker_, changes, "roi");
  if (word_of(source.spec, source.value->get()) != "property") return std::nullopt;
  if (is_unset(roi.spec, roi.value->get())) return std::nullopt;
  const auto part = [&](guint i) {
    return g_value_get_int(gst_value_array_get_value(roi.value->get(), i));
  };
  return ellipse::Rect{part(0), part(1), part(2), part(3)};
}

void Properties::copy_to(GstElement* other) const {
  std::vector<Change> changes;
  for (GParamSpec* spec : tunable(tracker_)) {
    Change change{spec, std::make_unique<Value>(spec)};
    g_object_get_property(G_OBJECT(tracker_), spec->name, change.value->get());
    if (!is_unset(spec, change.value->get())) changes.push_back(std::move(change));
  }
  apply_changes(other, changes);
}

std::string Properties::launch_settings() const {
  // gst-launch-1.0 sets the properties in order, starting from the defaults.
  std::string widening;
  std::string others;
  for (GParamSpec* spec : tunable(tracker_)) {
    Value value(spec);
    g_object_get_property(G_OBJECT(tracker_), spec->name, value.get());
    if (g_param_value_defaults(spec, value.get())) continue;
    if (is_unset(spec, value.get())) continue;
    const std::string text = word_of(spec, value.get());
    if (text.empty()) continue;
    std::string setting = " ";
    setting.append(spec->name).append("=").append(text);
    const GValue* usual = g_param_spec_get_default_value(spec);
    (widens(spec, usual, value.get()) ? widening : others) += setting;
  }
  return widening + others;
}

}  // namespace live
