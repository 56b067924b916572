// SPDX-License-Identifier: MIT
#include "gst/track/track_enums.hpp"

#include "core/tracking/settings.hpp"

GType gst_ellipse_detector_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::DetectorKind::kContours), "Contours: Keipour et al. 2021", "contours"},
      {int(ellipse::DetectorKind::kArcs), "Ellipses fitted to groups of edge arcs", "arcs"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseDetector", kValues);
  return kType;
}

GType gst_ellipse_tracking_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::TrackingMode::kNone), "Detection in each frame independently", "none"},
      {int(ellipse::TrackingMode::kRedetect),
       "Detection in a region around the last target: Keipour et al. 2021",
       "redetect"},
      {int(ellipse::TrackingMode::kEdges),
       "Learned edges of the target, matched from its predicted position",
       "edges"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseTracking", kValues);
  return kType;
}

GType gst_ellipse_refinement_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::Refinement::kNone), "The ellipse that edge tracking gives", "none"},
      {int(ellipse::Refinement::kEdges),
       "Fit to the gradient maxima along the outer edge",
       "edges"},
      {int(ellipse::Refinement::kPhotometric),
       "Fit to the brightness of all pixels along the outer edge",
       "photometric"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRefinement", kValues);
  return kType;
}

GType gst_ellipse_messages_get_type() {
  static const GEnumValue kValues[] = {
      {MESSAGES_NONE, "No messages", "none"},
      {MESSAGES_ON_CHANGE, "When the target appears, changes state or id, or is lost", "on-change"},
      {MESSAGES_EVERY_FRAME, "For every analysed frame", "every-frame"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseMessages", kValues);
  return kType;
}

GType gst_ellipse_roi_source_get_type() {
  static const GEnumValue kValues[] = {
      {ROI_SOURCE_NONE, "Whole frame", "none"},
      {ROI_SOURCE_PROPERTY, "Region in the property roi", "property"},
      {ROI_SOURCE_META,
       "Bounding box of the regions of interest and detected objects of each buffer",
       "meta"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRoiSource", kValues);
  return kType;
}
