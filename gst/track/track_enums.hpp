#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

/// When to post an element message "ellipse".
enum { MESSAGES_NONE, MESSAGES_ON_CHANGE, MESSAGES_EVERY_FRAME };

/// Source of the search region.
enum { ROI_SOURCE_NONE, ROI_SOURCE_PROPERTY, ROI_SOURCE_META };

/// The types of ellipsetrack's enum properties, registered at the first call. Thread-safe.
GType gst_ellipse_detector_get_type();
GType gst_ellipse_tracking_get_type();
GType gst_ellipse_refinement_get_type();
GType gst_ellipse_messages_get_type();
GType gst_ellipse_roi_source_get_type();
