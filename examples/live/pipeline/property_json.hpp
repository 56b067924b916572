#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>

#include "core/tracking/settings.hpp"
#include "examples/live/json_writer.hpp"

namespace live {

/// Whether a property is a region: an array of four integers.
[[nodiscard]] bool is_rect(const GParamSpec* spec);

/// Whether a property is a vector: an array of three numbers.
[[nodiscard]] bool is_vector(const GParamSpec* spec);

/// Writes everything that a control needs: name, nick, blurb, type, range, default, value, unit,
/// group, whether clients can set it. Tracker settings also have the conditions of their effect,
/// and the value in force where 0 selects another value.
/// @param settings  The tracker's current settings.
void write_property(JsonWriter& json,
                    GstElement* object,
                    GParamSpec* spec,
                    bool is_writable,
                    const ellipse::TrackerSettings& settings);

/// A property's value as one unquoted word of a gst-launch line.
[[nodiscard]] std::string word_of(const GParamSpec* spec, const GValue* value);

}  // namespace live
