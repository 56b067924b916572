#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <optional>
#include <string>
#include <string_view>

#include "core/tracking/settings.hpp"
#include "gst/overlay/overlay_style.hpp"
#include "gst/track/track_enums.hpp"

/// Key of a property's purpose in its parameter specification.
[[nodiscard]] inline GQuark purpose_quark() {
  return g_quark_from_static_string("ellipse-purpose");
}

/// The purpose of a property of ellipsetrack, such as "detector", by which user interfaces group
/// them; "other" for a property of another class.
[[nodiscard]] inline const char* purpose_of(GParamSpec* spec) {
  const auto* purpose = static_cast<const char*>(g_param_spec_get_qdata(spec, purpose_quark()));
  return purpose != nullptr ? purpose : "other";
}

/// The values of ellipsetrack's properties. A value type: the streaming thread copies it once per
/// frame.
struct TrackProperties {
  ellipse::TrackerSettings tracker;
  OverlayStyle overlay;
  guint interval = 1;
  int messages = MESSAGES_ON_CHANGE;
  bool attach_roi_meta = true;
  bool attach_analytics = false;  ///< Only if has_analytics().
  int roi_source = ROI_SOURCE_NONE;
  ellipse::Rect roi;                     ///< [px] of the frame; clipped to it when used.
  std::string roi_type;                  ///< Type of the regions to search; empty = any.
  std::string camera_file;               ///< File of tracker.camera.
  std::string evidence_file;             ///< File of tracker.evidence.
  GstClockTime max_processing_time = 0;  ///< Per frame [ns]; 0 = no limit.

  /// Installs all properties of ellipsetrack, including "target" and "stats", which get() does not
  /// read. g_object_class_list_properties() returns them by purpose, as in docs/elements.md.
  static void install(GObjectClass* object_class);

  /// @param name  Of the property.
  void get(std::string_view name, GValue* value) const;
};

/// A new value of one property, read but not yet applied.
class PropertyChange {
 public:
  /// @param name   Of the property. Both are borrowed and must outlive this object.
  /// Reads the file of `camera-file` or `evidence-file`: do not construct it under a lock. Throws
  /// std::invalid_argument if the file cannot be read.
  PropertyChange(std::string_view name, const GValue* value);

  /// Does not check the value against the others; tracker.validate() does. If the value is invalid
  /// by itself, throws std::invalid_argument and changes nothing.
  void apply_to(TrackProperties& properties) const;

 private:
  std::string_view name_;
  const GValue* value_;
  std::string file_;
  std::optional<ellipse::Camera> camera_;
  ellipse::EvidenceTable evidence_ = ellipse::built_in_evidence();
};
