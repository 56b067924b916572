#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>

namespace live {

/// Presets of the tracker, GStreamer's own: what is saved here is there in gst-launch-1.0, too
/// (`ellipsetrack @preset=NAME`). All functions throw std::invalid_argument that says what is wrong
/// with a name.

/// An array of {"name", "comment", "is_own"}: one's own can be deleted.
[[nodiscard]] std::string presets_json(GstElement* tracker);

void save_preset(GstElement* tracker, const std::string& name);
void load_preset(GstElement* tracker, const std::string& name);
void delete_preset(GstElement* tracker, const std::string& name);

}  // namespace live
