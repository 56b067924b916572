#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/video/gstvideofilter.h>

G_BEGIN_DECLS

#define GST_TYPE_ELLIPSE_OVERLAY (gst_ellipse_overlay_get_type())
G_DECLARE_FINAL_TYPE(GstEllipseOverlay, gst_ellipse_overlay, GST, ELLIPSE_OVERLAY, GstVideoFilter)

GST_ELEMENT_REGISTER_DECLARE(ellipseoverlay)

G_END_DECLS
