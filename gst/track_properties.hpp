#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include "core/tracker_settings.hpp"
#include "gst/overlay_style.hpp"

/// When an element message is posted.
enum { MESSAGES_NONE, MESSAGES_ON_CHANGE, MESSAGES_EVERY_FRAME };

/// All that the properties of ellipsetrack set. A value: the streaming thread takes one copy a
/// frame.
struct TrackProperties {
  ellipse::TrackerSettings tracker;
  OverlayStyle overlay;
  guint interval = 1;
  int messages = MESSAGES_ON_CHANGE;
  bool attach_roi_meta = true;

  /// Installs them all, with ids from first_id on; the last ones are those of setting_infos().
  static void install(GObjectClass* object_class, guint first_id);

  /// @param which  The property's id minus first_id.
  /// Throws std::invalid_argument and changes nothing, where the value does not fit the others.
  void set(guint which, const GValue* value);
  void get(guint which, GValue* value) const;
};
