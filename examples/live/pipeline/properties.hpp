#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <optional>
#include <string>
#include <utility>

#include "core/tracking/settings.hpp"
#include "examples/live/pipeline/camera_folder.hpp"

namespace live {

/// The tracker's properties as JSON. Main loop only.
class Properties {
 public:
  /// @param tracker  Borrowed; must outlive this object.
  /// @param cameras  The folder that a camera-file must be in.
  Properties(GstElement* tracker, CameraFolder cameras)
      : tracker_(tracker), cameras_(std::move(cameras)) {}

  /// An array with one object per property, derived from its GParamSpec: name, nick, blurb, type,
  /// range, default, value, unit, group, and whether clients can set it.
  [[nodiscard]] std::string to_json() const;

  /// Sets the properties in an object {"name": value, ...}, all of them or none. They apply from
  /// the next frame. @return Whether any value changed. Throws std::invalid_argument that names the
  /// property and its accepted values.
  bool set(const std::string& json);

  /// The current settings with the changes of an object as for set(). An empty text means no
  /// changes. Throws as set().
  [[nodiscard]] ellipse::TrackerSettings settings_with(const std::string& json) const;

  /// The search region with the same changes: `roi` if `roi-source` selects it; nullopt = the whole
  /// frame. Throws as set().
  [[nodiscard]] std::optional<ellipse::Rect> region_with(const std::string& json) const;

  /// Copies all settings to another tracker.
  void copy_to(GstElement* other) const;

  /// `name=value` for each property that differs from its default, in gst-launch-1.0 syntax.
  [[nodiscard]] std::string launch_settings() const;

 private:
  GstElement* tracker_;
  CameraFolder cameras_;
};

}  // namespace live
