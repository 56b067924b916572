// SPDX-License-Identifier: MIT
#include "examples/live/properties.hpp"

#include <json-glib/json-glib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "examples/live/json_writer.hpp"
#include "examples/live/property_groups.hpp"
#include "examples/live/ref.hpp"
#include "examples/live/request_json.hpp"

namespace live {
namespace {

// A GValue that clears itself.
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

struct Change {
  GParamSpec* spec;
  std::unique_ptr<Value> value;
};

[[noreturn]] void refuse(const GParamSpec* spec, const std::string& why) {
  throw std::invalid_argument(std::string(spec->name) + ": " + why);
}

// Those that a person tunes: writable at any time, and the element's own.
std::vector<GParamSpec*> tunable(GstElement* tracker) {
  guint count = 0;
  const Ref<gchar> list(reinterpret_cast<gchar*>(
      g_object_class_list_properties(G_OBJECT_GET_CLASS(tracker), &count)));
  auto** specs = reinterpret_cast<GParamSpec**>(list.get());
  std::vector<GParamSpec*> result;
  std::copy_if(specs, specs + count, std::back_inserter(result), [tracker](const GParamSpec* spec) {
    return spec->owner_type == G_OBJECT_TYPE(tracker) && (spec->flags & G_PARAM_WRITABLE) != 0;
  });
  return result;
}

/* To JSON */

bool is_rect(const GParamSpec* spec) {
  return G_PARAM_SPEC_VALUE_TYPE(spec) == GST_TYPE_ARRAY;
}

bool is_empty_rect(const GValue* value) {
  constexpr guint kWidth = 2;
  return gst_value_array_get_size(value) <= kWidth ||
         g_value_get_int(gst_value_array_get_value(value, kWidth)) == 0;
}

std::string type_of(const GParamSpec* spec) {
  if (is_rect(spec)) return "rect";
  if (G_IS_PARAM_SPEC_ENUM(spec)) return "enum";
  if (G_IS_PARAM_SPEC_FLAGS(spec)) return "flags";
  switch (G_PARAM_SPEC_VALUE_TYPE(spec)) {
    case G_TYPE_BOOLEAN:
      return "bool";
    case G_TYPE_INT:
      return "int";
    case G_TYPE_UINT:
      return "uint";
    case G_TYPE_UINT64:
      return "uint64";
    case G_TYPE_DOUBLE:
      return "double";
    case G_TYPE_STRING:
      return "string";
    default:
      return "other";
  }
}

std::string flag_nicks(const GValue* value) {
  const auto* type = static_cast<const GFlagsClass*>(g_type_class_peek(G_VALUE_TYPE(value)));
  const guint set = g_value_get_flags(value);
  std::string nicks;
  for (guint i = 0; i < type->n_values; ++i) {
    const GFlagsValue& flag = type->values[i];
    const bool is_set = flag.value == 0 ? set == 0 : (set & flag.value) == flag.value;
    if (is_set) nicks += (nicks.empty() ? "" : "+") + std::string(flag.value_nick);
  }
  return nicks;
}

std::string enum_nick(const GValue* value) {
  auto* type = static_cast<GEnumClass*>(g_type_class_peek(G_VALUE_TYPE(value)));
  const GEnumValue* found = g_enum_get_value(type, g_value_get_enum(value));
  return found != nullptr ? found->value_nick : "";
}

void write_value(JsonWriter& json, const GParamSpec* spec, const GValue* value) {
  if (is_rect(spec)) {
    json.begin_array();
    for (guint i = 0; i < gst_value_array_get_size(value); ++i) {
      json.value(g_value_get_int(gst_value_array_get_value(value, i)));
    }
    json.end_array();
  } else if (G_VALUE_HOLDS_BOOLEAN(value)) {
    json.value(g_value_get_boolean(value) != FALSE);
  } else if (G_VALUE_HOLDS_INT(value)) {
    json.value(g_value_get_int(value));
  } else if (G_VALUE_HOLDS_UINT(value)) {
    json.value(g_value_get_uint(value));
  } else if (G_VALUE_HOLDS_UINT64(value)) {
    json.value(g_value_get_uint64(value));
  } else if (G_VALUE_HOLDS_DOUBLE(value)) {
    json.value(g_value_get_double(value));
  } else if (G_VALUE_HOLDS_STRING(value)) {
    const gchar* text = g_value_get_string(value);
    json.value(text != nullptr ? text : "");
  } else if (G_VALUE_HOLDS_FLAGS(value)) {
    json.value(flag_nicks(value));
  } else if (G_VALUE_HOLDS_ENUM(value)) {
    json.value(enum_nick(value));
  } else {
    json.null();
  }
}

template <class Spec>
void write_range(JsonWriter& json, const Spec* spec) {
  json.member("min", spec->minimum).member("max", spec->maximum);
}

void write_limits(JsonWriter& json, GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_DOUBLE(spec)) write_range(json, G_PARAM_SPEC_DOUBLE(spec));
  if (G_IS_PARAM_SPEC_UINT(spec)) write_range(json, G_PARAM_SPEC_UINT(spec));
  if (G_IS_PARAM_SPEC_INT(spec)) write_range(json, G_PARAM_SPEC_INT(spec));
  if (G_IS_PARAM_SPEC_UINT64(spec)) write_range(json, G_PARAM_SPEC_UINT64(spec));
}

template <class Values>
void write_nicks(JsonWriter& json, const Values* values, guint count) {
  json.key("values").begin_array();
  for (guint i = 0; i < count; ++i) {
    json.begin_object()
        .member("nick", values[i].value_nick)
        .member("name", values[i].value_name)
        .end_object();
  }
  json.end_array();
}

void write_property(JsonWriter& json, GstElement* tracker, GParamSpec* spec) {
  const char* blurb = g_param_spec_get_blurb(spec);
  json.begin_object()
      .member("name", spec->name)
      .member("nick", g_param_spec_get_nick(spec))
      .member("blurb", blurb)
      .member("type", type_of(spec))
      .member("group", group_of(spec->name))
      .member("unit", unit_in(blurb))
      .member("writable", true)
      .member("mutable_playing", (spec->flags & GST_PARAM_MUTABLE_PLAYING) != 0);
  write_limits(json, spec);
  if (G_IS_PARAM_SPEC_ENUM(spec)) {
    const GEnumClass* type = G_PARAM_SPEC_ENUM(spec)->enum_class;
    write_nicks(json, type->values, type->n_values);
  }
  if (G_IS_PARAM_SPEC_FLAGS(spec)) {
    const GFlagsClass* type = G_PARAM_SPEC_FLAGS(spec)->flags_class;
    write_nicks(json, type->values, type->n_values);
  }
  json.key("default");
  write_value(json, spec, g_param_spec_get_default_value(spec));
  Value value(spec);
  g_object_get_property(G_OBJECT(tracker), spec->name, value.get());
  json.key("value");
  write_value(json, spec, value.get());
  json.end_object();
}

/* From JSON */

double number_of(const GParamSpec* spec, JsonNode* node) {
  const GType type = json_node_get_value_type(node);
  if (type != G_TYPE_INT64 && type != G_TYPE_DOUBLE) refuse(spec, "takes a number");
  return json_node_get_double(node);
}

double whole_number_of(const GParamSpec* spec, JsonNode* node) {
  const double number = number_of(spec, node);
  if (number != std::floor(number)) refuse(spec, "takes a whole number");
  return number;
}

template <class Spec>
double in_range(const GParamSpec* spec, const Spec* range, double number) {
  const auto min = static_cast<double>(range->minimum);
  const auto max = static_cast<double>(range->maximum);
  if (number >= min && number <= max) return number;
  JsonWriter text;
  text.begin_array().value(number).value(min).value(max);
  refuse(spec, text.text().substr(1) + ": the number is not between the two behind it");
}

std::string text_of(const GParamSpec* spec, JsonNode* node) {
  if (json_node_get_value_type(node) != G_TYPE_STRING) refuse(spec, "takes text");
  return json_node_get_string(node);
}

void read_rect(const GParamSpec* spec, JsonNode* node, GValue* value) {
  constexpr guint kNumbers = 4;
  JsonArray* array = JSON_NODE_HOLDS_ARRAY(node) ? json_node_get_array(node) : nullptr;
  if (array == nullptr || json_array_get_length(array) != kNumbers) {
    refuse(spec, "takes [x, y, width, height]");
  }
  for (guint i = 0; i < kNumbers; ++i) {
    JsonNode* element = json_array_get_element(array, i);
    if (!JSON_NODE_HOLDS_VALUE(element)) refuse(spec, "takes four whole numbers");
    const double number = whole_number_of(spec, element);
    if (std::abs(number) > 1e6) refuse(spec, "is far outside of any frame");
    GValue each = G_VALUE_INIT;
    g_value_init(&each, G_TYPE_INT);
    g_value_set_int(&each, static_cast<gint>(number));
    gst_value_array_append_and_take_value(value, &each);
  }
}

void read_enum(GParamSpec* spec, JsonNode* node, GValue* value) {
  GEnumClass* type = G_PARAM_SPEC_ENUM(spec)->enum_class;
  const std::string nick = text_of(spec, node);
  if (const GEnumValue* found = g_enum_get_value_by_nick(type, nick.c_str())) {
    g_value_set_enum(value, found->value);
    return;
  }
  std::string nicks;
  for (guint i = 0; i < type->n_values; ++i) {
    nicks += std::string(" ") + type->values[i].value_nick;
  }
  refuse(spec, "\"" + nick + "\" is none of:" + nicks);
}

void read_value(GParamSpec* spec, JsonNode* node, GValue* value) {
  if (is_rect(spec)) return read_rect(spec, node, value);
  if (!JSON_NODE_HOLDS_VALUE(node)) refuse(spec, "takes a single value");
  if (G_IS_PARAM_SPEC_ENUM(spec)) return read_enum(spec, node, value);
  if (G_IS_PARAM_SPEC_BOOLEAN(spec)) {
    if (json_node_get_value_type(node) != G_TYPE_BOOLEAN) refuse(spec, "takes true or false");
    g_value_set_boolean(value, json_node_get_boolean(node));
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    g_value_set_double(value, in_range(spec, G_PARAM_SPEC_DOUBLE(spec), number_of(spec, node)));
  } else if (G_IS_PARAM_SPEC_UINT(spec)) {
    const double number = in_range(spec, G_PARAM_SPEC_UINT(spec), whole_number_of(spec, node));
    g_value_set_uint(value, static_cast<guint>(number));
  } else if (G_IS_PARAM_SPEC_UINT64(spec)) {
    // 2^53: what lies beyond is no exact number in JSON.
    const double number = whole_number_of(spec, node);
    if (number < 0.0 || number > 9007199254740992.0) refuse(spec, "is out of range");
    g_value_set_uint64(value, static_cast<guint64>(number));
  } else if (G_IS_PARAM_SPEC_STRING(spec)) {
    g_value_set_string(value, text_of(spec, node).c_str());
  } else if (!gst_value_deserialize(value, text_of(spec, node).c_str())) {
    refuse(spec, "does not take this");
  }
}

std::vector<Change> parse_changes(GstElement* tracker, const std::string& json) {
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
      throw std::invalid_argument(std::string(name) + ": there is no such property to set");
    }
    Change change{*spec, std::make_unique<Value>(*spec)};
    read_value(*spec, node, change.value->get());
    changes.push_back(std::move(change));
  }
  return changes;
}

/* What the tracker makes of them */

void take_in(ellipse::TrackerSettings& settings, const char* name, const GValue* value) {
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

ellipse::TrackerSettings settings_after(GstElement* tracker, const std::vector<Change>& changes) {
  ellipse::TrackerSettings settings;
  for (GParamSpec* spec : tunable(tracker)) {
    Value value(spec);
    g_object_get_property(G_OBJECT(tracker), spec->name, value.get());
    take_in(settings, spec->name, value.get());
  }
  for (const Change& change : changes) take_in(settings, change.spec->name, change.value->get());
  settings.validate();
  return settings;
}

// The order in which two settings that fit come from one to the other without a pair that is turned
// around in between: first what widens a pair, then what narrows it.
bool widens(GstElement* tracker, const Change& change) {
  const std::string name = change.spec->name;
  const bool is_upper = name.starts_with("max-") || name == "edge-high";
  const bool is_lower = name.starts_with("min-") || name == "edge-low";
  if (!G_IS_PARAM_SPEC_DOUBLE(change.spec) || (!is_upper && !is_lower)) return false;
  Value now(change.spec);
  g_object_get_property(G_OBJECT(tracker), change.spec->name, now.get());
  const double before = g_value_get_double(now.get());
  const double after = g_value_get_double(change.value->get());
  if (name == "edge-high" && (before == 0.0 || after == 0.0)) return after == 0.0;  // 0: no limit
  return is_upper ? after > before : after < before;
}

// As one word.
std::string launch_text(const GParamSpec* spec, const GValue* value) {
  if (is_rect(spec)) {
    JsonWriter numbers;
    write_value(numbers, spec, value);
    return "<" + numbers.text().substr(1, numbers.text().size() - 2) + ">";
  }
  if (G_VALUE_HOLDS_FLAGS(value)) return flag_nicks(value);
  if (G_VALUE_HOLDS_ENUM(value)) return enum_nick(value);
  const Ref<gchar> text(gst_value_serialize(value));
  return text ? text.get() : "";
}

}  // namespace

std::string Properties::to_json() const {
  JsonWriter json;
  json.begin_array();
  for (GParamSpec* spec : tunable(tracker_)) write_property(json, tracker_, spec);
  return json.end_array().text() + "\n";
}

void Properties::set(const std::string& json) {
  if (json.empty()) throw std::invalid_argument("an object {\"name\": value, ...} is wanted");
  std::vector<Change> changes = parse_changes(tracker_, json);
  (void)settings_after(tracker_, changes);
  std::stable_partition(changes.begin(), changes.end(), [this](const Change& change) {
    return widens(tracker_, change);
  });
  for (const Change& change : changes) {
    g_object_set_property(G_OBJECT(tracker_), change.spec->name, change.value->get());
  }
}

ellipse::TrackerSettings Properties::settings_with(const std::string& json) const {
  return settings_after(tracker_, parse_changes(tracker_, json));
}

std::string Properties::launch_settings() const {
  // Largest first: gst-launch-1.0 sets one after the other.
  std::string uppers;
  std::string others;
  for (GParamSpec* spec : tunable(tracker_)) {
    Value value(spec);
    g_object_get_property(G_OBJECT(tracker_), spec->name, value.get());
    if (g_param_value_defaults(spec, value.get())) continue;
    if (is_rect(spec) && is_empty_rect(value.get())) continue;
    const std::string text = launch_text(spec, value.get());
    if (text.empty()) continue;
    const std::string setting = std::string(" ") + spec->name + "=" + text;
    (std::string_view(spec->name).starts_with("max-") ? uppers : others) += setting;
  }
  return uppers + others;
}

}  // namespace live
