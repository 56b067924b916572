// SPDX-License-Identifier: MIT
#include "gst/track/track_enums.hpp"

#include "core/tracking/settings.hpp"

GType gst_ellipse_detector_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::DetectorKind::kContours), "Contours: Keipour et al. 2021", "contours"},
      {int(ellipse::DetectorKind::kArcs), "Arcs of edges, fitted together", "arcs"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseDetector", kValues);
  return kType;
}

GType gst_ellipse_tracking_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::TrackingMode::kNone), "Each frame by itself", "none"},
      {int(ellipse::TrackingMode::kRedetect),
       "Detect again around the last place: Keipour et al. 2021",
       "redetect"},
      {int(ellipse::TrackingMode::kEdges),
       "Follow the learned edges of the pad from its predicted place",
       "edges"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseTracking", kValues);
  return kType;
}

GType gst_ellipse_refinement_get_type() {
  static const GEnumValue kValues[] = {
      {int(ellipse::Refinement::kNone), "Where the edges that it is followed by put it", "none"},
      {int(ellipse::Refinement::kEdges), "By the maxima along its outer edge", "edges"},
      {int(ellipse::Refinement::kPhotometric),
       "By the brightness of all pixels along its outer edge",
       "photometric"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRefinement", kValues);
  return kType;
}

GType gst_ellipse_messages_get_type() {
  static const GEnumValue kValues[] = {
      {MESSAGES_NONE, "No messages", "none"},
      {MESSAGES_ON_CHANGE, "When the state or the id of the target changes", "on-change"},
      {MESSAGES_EVERY_FRAME, "For every analysed frame", "every-frame"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseMessages", kValues);
  return kType;
}

GType gst_ellipse_roi_source_get_type() {
  static const GEnumValue kValues[] = {
      {ROI_SOURCE_NONE, "The whole frame is searched", "none"},
      {ROI_SOURCE_PROPERTY, "The region that the property roi gives", "property"},
      {ROI_SOURCE_META, "The box around the GstVideoRegionOfInterestMeta of each buffer", "meta"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRoiSource", kValues);
  return kType;
}
