#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>

#include "core/tracking/settings.hpp"
#include "examples/live/http/json_writer.hpp"

namespace live {

/// Whether a property is a region: an array of four whole numbers.
[[nodiscard]] bool is_rect(const GParamSpec* spec);

/// Whether a property is a direction: an array of three numbers.
[[nodiscard]] bool is_vector(const GParamSpec* spec);

/// Writes an object that tells all that a control needs: name, nick, blurb, type, range, default,
/// value, unit, group, whether clients can set it; of the tracker's settings also with what they
/// act, and the value in force where a 0 stands for it.
/// @param settings  The tracker's, all of them.
void write_property(JsonWriter& json,
                    GstElement* object,
                    GParamSpec* spec,
                    bool is_writable,
                    const ellipse::TrackerSettings& settings);

/// A property's value as one word of a gst-launch line, unquoted.
[[nodiscard]] std::string word_of(const GParamSpec* spec, const GValue* value);

}  // namespace live
