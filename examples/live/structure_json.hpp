#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include "examples/live/json_writer.hpp"

namespace live {

/// Writes the fields of a structure as members; "-" in a name becomes "_". Unknown times become
/// null. Fields of other types than number, string and boolean are omitted.
void write_fields(JsonWriter& json, const GstStructure* structure);

}  // namespace live
