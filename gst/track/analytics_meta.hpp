#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <optional>

#include "core/image/image_view.hpp"
#include "core/tracking/target.hpp"
#include "gst/ellipse/gstellipsemeta.h"

/// Whether this build has GStreamer's analytics metadata, which came with GStreamer 1.24. Without
/// it nothing is attached and no object is found.
[[nodiscard]] bool has_analytics();

/// When a target was visible [PTS]; GST_CLOCK_TIME_NONE if unknown.
struct Sighting {
  guint64 id = 0;
  GstClockTime first = GST_CLOCK_TIME_NONE;
  GstClockTime last = GST_CLOCK_TIME_NONE;

  /// Call it for each frame with a target. A new id resets the times; a predicted target is not
  /// visible.
  void add(const ellipse::Target& target, GstClockTime pts);
};

/// Attaches an ellipse to the GstAnalyticsRelationMeta of its buffer, as a detected object of the
/// class "ellipse" whose confidence is the ellipse's probability. A target, which has an id, also
/// gets tracking metadata; both are related to each other.
/// @param box       The upright bounding box inside the frame [px]. Nothing is attached if it is
///                  empty. From GStreamer 1.26 on the object has the ellipse's oriented box
///                  instead, which may reach beyond the frame, unless a lens distorts the outline.
/// @param sighting  Of the target.
void attach_object(GstBuffer* buffer,
                   const GstEllipseMeta& meta,
                   const ellipse::Rect& box,
                   const Sighting& sighting);

/// Iterates over the objects that elements upstream have detected. Allocates nothing.
/// @param state   nullptr before the first call.
/// @param object_class  The class of the objects; 0 = any.
/// @return The upright bounding box [px], which may reach beyond the frame; nullopt after the last.
[[nodiscard]] std::optional<ellipse::Rect> next_object(GstBuffer* buffer,
                                                       gpointer* state,
                                                       GQuark object_class);
