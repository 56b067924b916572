// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/property_input.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/live/json_writer.hpp"
#include "examples/live/pipeline/property_json.hpp"

namespace live {
namespace {

[[noreturn]] void refuse(const GParamSpec* spec, const std::string& why) {
  throw std::invalid_argument(std::string(spec->name) + ": " + why);
}

double number_of(const GParamSpec* spec, JsonNode* node) {
  const GType type = json_node_get_value_type(node);
  if (type != G_TYPE_INT64 && type != G_TYPE_DOUBLE) refuse(spec, "expected a number");
  const double number = json_node_get_double(node);
  if (!std::isfinite(number)) refuse(spec, "the number is too large");  // JSON allows 1e999
  return number;
}

double whole_number_of(const GParamSpec* spec, JsonNode* node) {
  const double number = number_of(spec, node);
  if (number != std::floor(number)) refuse(spec, "expected a whole number");
  return number;
}

template <class Spec>
double in_range(const GParamSpec* spec, const Spec* range, double number) {
  const auto min = static_cast<double>(range->minimum);
  const auto max = static_cast<double>(range->maximum);
  if (number >= min && number <= max) return number;
  const auto text = [](double each) { return JsonWriter().value(each).text(); };
  refuse(spec, text(number) + " is not in [" + text(min) + ", " + text(max) + "]");
}

std::string text_of(const GParamSpec* spec, JsonNode* node) {
  if (json_node_get_value_type(node) != G_TYPE_STRING) refuse(spec, "expected a string");
  return json_node_get_string(node);
}

// The numbers of an array. An empty array, which is the default value, gives zeros.
std::vector<double> numbers_of(const GParamSpec* spec,
                               JsonNode* node,
                               std::size_t count,
                               const char* form) {
  std::vector<double> numbers(count);
  JsonArray* array = JSON_NODE_HOLDS_ARRAY(node) ? json_node_get_array(node) : nullptr;
  if (array != nullptr && json_array_get_length(array) == 0) return numbers;
  if (array == nullptr || json_array_get_length(array) != count) {
    refuse(spec, std::string("expected ") + form);
  }
  for (guint i = 0; i < count; ++i) {
    JsonNode* element = json_array_get_element(array, i);
    if (!JSON_NODE_HOLDS_VALUE(element)) refuse(spec, std::string("expected ") + form);
    numbers[i] = number_of(spec, element);
  }
  return numbers;
}

void read_rect(const GParamSpec* spec, JsonNode* node, GValue* value) {
  for (const double number : numbers_of(spec, node, 4, "[x, y, width, height]")) {
    if (number != std::floor(number)) refuse(spec, "expected four whole numbers");
    if (std::abs(number) > 1e6) refuse(spec, "coordinates out of range");
    GValue each = G_VALUE_INIT;
    g_value_init(&each, G_TYPE_INT);
    g_value_set_int(&each, static_cast<gint>(number));
    gst_value_array_append_and_take_value(value, &each);
  }
}

void read_vector(const GParamSpec* spec, JsonNode* node, GValue* value) {
  for (const double number : numbers_of(spec, node, 3, "[x, y, z]")) {
    GValue each = G_VALUE_INIT;
    g_value_init(&each, G_TYPE_DOUBLE);
    g_value_set_double(&each, number);
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
  refuse(spec, "\"" + nick + "\" is not one of:" + nicks);
}

}  // namespace

void read_value(GParamSpec* spec, JsonNode* node, GValue* value) {
  if (is_rect(spec)) return read_rect(spec, node, value);
  if (is_vector(spec)) return read_vector(spec, node, value);
  if (!JSON_NODE_HOLDS_VALUE(node)) refuse(spec, "expected a single value");
  if (G_IS_PARAM_SPEC_ENUM(spec)) return read_enum(spec, node, value);
  if (G_IS_PARAM_SPEC_BOOLEAN(spec)) {
    if (json_node_get_value_type(node) != G_TYPE_BOOLEAN) refuse(spec, "expected true or false");
    g_value_set_boolean(value, json_node_get_boolean(node));
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    g_value_set_double(value, in_range(spec, G_PARAM_SPEC_DOUBLE(spec), number_of(spec, node)));
  } else if (G_IS_PARAM_SPEC_UINT(spec)) {
    const double number = in_range(spec, G_PARAM_SPEC_UINT(spec), whole_number_of(spec, node));
    g_value_set_uint(value, static_cast<guint>(number));
  } else if (G_IS_PARAM_SPEC_UINT64(spec)) {
    // Doubles represent integers exactly up to 2^53 only.
    const double number = whole_number_of(spec, node);
    if (number < 0.0 || number > 9007199254740992.0) refuse(spec, "out of range");
    g_value_set_uint64(value, static_cast<guint64>(number));
  } else if (G_IS_PARAM_SPEC_STRING(spec)) {
    g_value_set_string(value, text_of(spec, node).c_str());
  } else if (!gst_value_deserialize(value, text_of(spec, node).c_str())) {
    refuse(spec, "unsupported type");
  }
}

}  // namespace live
