#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>

#include "gst/track/track_frame.hpp"

// Which new values of properties take effect. Each function takes the object lock.

/// Applies a value, or rejects it with a warning that names it and keeps the old one. In the state
/// NULL the two values of a pair may be set in any order. A rejected value that a controller sets
/// at every frame is reported once, until a value is accepted again.
void set_value(GstEllipseTrack* self, const GParamSpec* pspec, const GValue* value);

using PresetLoader = gboolean (*)(GstPreset* preset, const gchar* name);

/// Loads a preset, whose values take effect together: they are valid together, but not with the
/// values that they replace one by one.
/// @param load_one_by_one  Sets the values as properties.
/// @return FALSE if the preset is unknown or invalid; no value is changed then.
gboolean load_together(GstEllipseTrack* self, const gchar* name, PresetLoader load_one_by_one);

/// @return Why the settings do not allow a start; empty if they do.
[[nodiscard]] std::string start_error(GstEllipseTrack* self);
