#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/base/gstbasetransform.h>

G_BEGIN_DECLS

#define GST_TYPE_ELLIPSE_JSON (gst_ellipse_json_get_type())
G_DECLARE_FINAL_TYPE(GstEllipseJson, gst_ellipse_json, GST, ELLIPSE_JSON, GstBaseTransform)

GST_ELEMENT_REGISTER_DECLARE(ellipsejson)

G_END_DECLS
