#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>
#include <json-glib/json-glib.h>

namespace live {

/// Reads a property's value from JSON: a number, a string, true or false, the nick of an enum
/// value, flags as "ellipse+axes", a region as [x, y, width, height], a vector as [x, y, z].
/// @param value  Initialized with the property's type.
///
/// Throws std::invalid_argument that names the property and its accepted values.
void read_value(GParamSpec* spec, JsonNode* node, GValue* value);

}  // namespace live
