#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/video/gstvideofilter.h>

G_BEGIN_DECLS

#define GST_TYPE_ELLIPSE_TRACK (gst_ellipse_track_get_type())
G_DECLARE_FINAL_TYPE(GstEllipseTrack, gst_ellipse_track, GST, ELLIPSE_TRACK, GstVideoFilter)

GST_ELEMENT_REGISTER_DECLARE(ellipsetrack)

G_END_DECLS
