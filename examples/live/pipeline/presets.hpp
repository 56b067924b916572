#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>

namespace live {

/// Presets of the tracker, stored by GStreamer: gst-launch-1.0 can load them with `ellipsetrack
/// @preset=NAME`. All functions throw std::invalid_argument for a name that is invalid, unknown or
/// not the program's own, and std::runtime_error if the file cannot be written. Main loop only.

/// An array of {"name", "comment", "is_own"}. Only presets with is_own can be deleted.
[[nodiscard]] std::string presets_json(GstElement* tracker);

void save_preset(GstElement* tracker, const std::string& name);
void load_preset(GstElement* tracker, const std::string& name);
void delete_preset(GstElement* tracker, const std::string& name);

}  // namespace live
