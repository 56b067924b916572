#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>
#include <json-glib/json-glib.h>

namespace live {

/// Reads a property's value from JSON: a number, text, true or false, the nick of an enum, the
/// nicks of flags as "ellipse+axes", a region as [x, y, width, height].
/// @param value  Of the property's type.
/// Throws std::invalid_argument that names the property and what it takes.
void read_value(GParamSpec* spec, JsonNode* node, GValue* value);

}  // namespace live
