// SPDX-License-Identifier: MIT
#include "examples/live/structure_json.hpp"

#include <algorithm>
#include <string>

namespace live {
namespace {

gboolean write_field(GQuark field, const GValue* value, gpointer data) {
  auto& json = *static_cast<JsonWriter*>(data);
  std::string name = g_quark_to_string(field);
  std::replace(name.begin(), name.end(), '-', '_');
  if (G_VALUE_HOLDS_UINT64(value)) {
    const guint64 number = g_value_get_uint64(value);
    json.key(name);
    GST_CLOCK_TIME_IS_VALID(number) ? json.value(number) : json.null();
  } else if (G_VALUE_HOLDS_UINT(value)) {
    json.member(name, g_value_get_uint(value));
  } else if (G_VALUE_HOLDS_INT(value)) {
    json.member(name, g_value_get_int(value));
  } else if (G_VALUE_HOLDS_DOUBLE(value)) {
    json.member(name, g_value_get_double(value));
  } else if (G_VALUE_HOLDS_BOOLEAN(value)) {
    json.member(name, g_value_get_boolean(value) != FALSE);
  } else if (G_VALUE_HOLDS_STRING(value)) {
    json.member(name, g_value_get_string(value));
  }
  return TRUE;
}

}  // namespace

void write_fields(JsonWriter& json, const GstStructure* structure) {
  if (structure != nullptr) gst_structure_foreach(structure, write_field, &json);
}

}  // namespace live
