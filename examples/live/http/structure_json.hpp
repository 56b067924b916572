#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include "examples/live/http/json_writer.hpp"

namespace live {

/// Writes the fields of a structure as members; "-" in a name becomes "_". Times that are not known
/// are null. Fields that are no number, text or boolean are left out.
void write_fields(JsonWriter& json, const GstStructure* structure);

}  // namespace live
