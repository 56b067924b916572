// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/property_json.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

#include "core/tracking/setting_effect.hpp"
#include "examples/live/ref.hpp"
#include "gst/track/track_properties.hpp"

namespace live {
namespace {

std::string type_of(const GParamSpec* spec) {
  if (is_rect(spec)) return "rect";
  if (is_vector(spec)) return "vector";
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
    if (!is_set) continue;
    if (!nicks.empty()) nicks += '+';
    nicks += flag.value_nick;
  }
  return nicks;
}

std::string enum_nick(const GValue* value) {
  auto* type = static_cast<GEnumClass*>(g_type_class_peek(G_VALUE_TYPE(value)));
  const GEnumValue* found = g_enum_get_value(type, g_value_get_enum(value));
  return found != nullptr ? found->value_nick : "";
}

void write_array(JsonWriter& json, const GValue* value) {
  json.begin_array();
  for (guint i = 0; i < gst_value_array_get_size(value); ++i) {
    const GValue* number = gst_value_array_get_value(value, i);
    G_VALUE_HOLDS_INT(number) ? json.value(g_value_get_int(number))
                              : json.value(g_value_get_double(number));
  }
  json.end_array();
}

void write_value(JsonWriter& json, const GValue* value) {
  if (GST_VALUE_HOLDS_ARRAY(value)) {
    write_array(json, value);
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

template <class Enum>
void write_nick(JsonWriter& json,
                const char* name,
                const std::optional<Enum>& value,
                std::span<const char* const> nicks) {
  json.key(name);
  value ? json.value(nicks[static_cast<std::size_t>(*value)]) : json.null();
}

// The unit in square brackets in a property's description; empty if it has none.
std::string_view unit_in(std::string_view blurb) {
  for (const std::string_view unit : {"[grey levels per px]", "[px]", "[ns]"}) {
    if (blurb.find(unit) != std::string_view::npos) return unit.substr(1, unit.size() - 2);
  }
  return "";
}

// Writes when a tracker setting has an effect, and the value in force where 0 selects another
// value. Writes nothing for other properties.
void write_effect(JsonWriter& json, const char* name, const ellipse::TrackerSettings& settings) {
  const auto infos = ellipse::setting_infos();
  const auto info = std::find_if(
      infos.begin(), infos.end(), [&](const auto& each) { return g_str_equal(name, each.name); });
  const bool is_number = info != infos.end();
  if (!is_number && !g_str_equal(name, "refine")) return;
  const ellipse::SettingEffect effect = ellipse::effect_of(name);
  json.key("effect").begin_object();
  write_nick(json, "detector", effect.detector, ellipse::detector_nicks());
  write_nick(json, "tracking", effect.tracking, ellipse::tracking_nicks());
  json.member("otherwise", effect.otherwise)
      .member("elsewhere_above", effect.elsewhere_above)
      .end_object();
  if (!is_number || info->get(settings) != 0.0) return;
  const double in_force = info->get(ellipse::in_force(settings));
  if (in_force != 0.0) json.member("in_force", in_force);
}

}  // namespace

bool is_rect(const GParamSpec* spec) {
  return GST_IS_PARAM_SPEC_ARRAY_LIST(spec) &&
         G_IS_PARAM_SPEC_INT(GST_PARAM_SPEC_ARRAY_LIST(spec)->element_spec);
}

bool is_vector(const GParamSpec* spec) {
  return GST_IS_PARAM_SPEC_ARRAY_LIST(spec) &&
         G_IS_PARAM_SPEC_DOUBLE(GST_PARAM_SPEC_ARRAY_LIST(spec)->element_spec);
}

void write_property(JsonWriter& json,
                    GstElement* object,
                    GParamSpec* spec,
                    bool is_writable,
                    const ellipse::TrackerSettings& settings) {
  const char* blurb = g_param_spec_get_blurb(spec);
  json.begin_object()
      .member("name", spec->name)
      .member("nick", g_param_spec_get_nick(spec))
      .member("blurb", blurb)
      .member("type", type_of(spec))
      .member("group", purpose_of(spec))
      .member("unit", unit_in(blurb))
      .member("writable", is_writable)
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
  write_value(json, g_param_spec_get_default_value(spec));
  GValue value = G_VALUE_INIT;
  g_value_init(&value, G_PARAM_SPEC_VALUE_TYPE(spec));
  g_object_get_property(G_OBJECT(object), spec->name, &value);
  json.key("value");
  write_value(json, &value);
  g_value_unset(&value);
  write_effect(json, spec->name, settings);
  json.end_object();
}

std::string word_of(const GParamSpec* spec, const GValue* value) {
  if (is_rect(spec) || is_vector(spec)) {
    JsonWriter numbers;
    write_array(numbers, value);
    std::string word = numbers.text();  // from [x,y,width,height] or [x,y,z]
    word.front() = '<';
    word.back() = '>';
    return word;
  }
  // The shortest representation that round-trips; GStreamer would write 0.2 as 0.20000000000000001.
  if (G_VALUE_HOLDS_DOUBLE(value)) return JsonWriter().value(g_value_get_double(value)).text();
  if (G_VALUE_HOLDS_FLAGS(value)) return flag_nicks(value);
  if (G_VALUE_HOLDS_ENUM(value)) return enum_nick(value);
  const Ref<gchar> text(gst_value_serialize(value));
  return text ? text.get() : "";
}

}  // namespace live
