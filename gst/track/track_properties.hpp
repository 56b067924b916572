#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <optional>
#include <string>

#include "core/tracking/settings.hpp"
#include "gst/overlay/overlay_style.hpp"
#include "gst/track/track_enums.hpp"

/// All that the properties of ellipsetrack set. A value: the streaming thread takes one copy a
/// frame.
struct TrackProperties {
  ellipse::TrackerSettings tracker;
  OverlayStyle overlay;
  guint interval = 1;
  int messages = MESSAGES_ON_CHANGE;
  bool attach_roi_meta = true;
  int roi_source = ROI_SOURCE_NONE;
  ellipse::Rect roi;                     ///< [px] of the frame; clipped to it where it is used.
  std::string roi_type;                  ///< Of the regions that count; empty = all.
  std::string camera_file;               ///< That tracker.camera was read from.
  std::string evidence_file;             ///< That tracker.evidence was read from.
  GstClockTime max_processing_time = 0;  ///< [ns] a frame; 0 = any.

  /// Installs them all, with ids from first_id on; the last ones are those of setting_infos().
  static void install(GObjectClass* object_class, guint first_id);

  /// @param which  The property's id minus first_id.
  void get(guint which, GValue* value) const;
};

/// A new value of one property, read and yet to be set.
class PropertyChange {
 public:
  /// @param which  The property's id minus that of the first.
  /// @param value  Borrowed as long as this lives.
  /// Reads the file that `camera-file` or `evidence-file` names: not to be made under a lock.
  /// Throws std::invalid_argument where it cannot be read.
  PropertyChange(guint which, const GValue* value);

  /// Does not check how the value fits the others: that is tracker.validate(). Throws
  /// std::invalid_argument and changes nothing, where the value has no meaning.
  void apply_to(TrackProperties& properties) const;

 private:
  guint which_;
  const GValue* value_;
  std::string file_;
  std::optional<ellipse::Camera> camera_;
  ellipse::EvidenceTable evidence_ = ellipse::built_in_evidence();
};
