#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <string>
#include <utility>

#include "core/tracking/settings.hpp"
#include "examples/live/pipeline/camera_folder.hpp"

namespace live {

/// The properties of the tracker, as JSON for those who tune it. For the main loop's thread.
class Properties {
 public:
  /// @param tracker  Borrowed for as long as this lives.
  /// @param cameras  Where a camera-file may be.
  Properties(GstElement* tracker, CameraFolder cameras)
      : tracker_(tracker), cameras_(std::move(cameras)) {}

  /// An array with one object a property, made from its GParamSpec: name, nick, blurb, type, range,
  /// default, value, unit, group, and whether it can be set.
  [[nodiscard]] std::string to_json() const;

  /// Sets those that an object {"name": value, ...} names: all of them, or none. They act from the
  /// next frame on. @return Whether one has another value now. Throws std::invalid_argument that
  /// names the property and what it takes.
  bool set(const std::string& json);

  /// What the tracker works by now, with the changes of such an object, which may be empty text.
  /// Throws as set().
  [[nodiscard]] ellipse::TrackerSettings settings_with(const std::string& json) const;

  /// Sets another tracker to what this one is set to.
  void copy_to(GstElement* other) const;

  /// `name=value` of each that is not at its default, as gst-launch-1.0 takes them.
  [[nodiscard]] std::string launch_settings() const;

 private:
  GstElement* tracker_;
  CameraFolder cameras_;
};

}  // namespace live
