#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

G_BEGIN_DECLS

/// What is drawn of an ellipse.
typedef enum {
  GST_ELLIPSE_OVERLAY_NONE = 0,
  GST_ELLIPSE_OVERLAY_ELLIPSE = 1 << 0,
  GST_ELLIPSE_OVERLAY_AXES = 1 << 1,
  GST_ELLIPSE_OVERLAY_CENTRE = 1 << 2,
  GST_ELLIPSE_OVERLAY_ROI = 1 << 3,
  GST_ELLIPSE_OVERLAY_LABEL = 1 << 4,
} GstEllipseOverlayFlags;

#define GST_TYPE_ELLIPSE_OVERLAY_FLAGS (gst_ellipse_overlay_flags_get_type())
GType gst_ellipse_overlay_flags_get_type(void);

G_END_DECLS

/// How it is drawn.
struct OverlayStyle {
  GstEllipseOverlayFlags parts = GST_ELLIPSE_OVERLAY_NONE;
  guint color_argb = 0xff00ff00;
  guint line_width_px = 2;
  /// Lines get an edge, black around bright and white around dark ones. For formats without colour,
  /// where a line may have the grey level of what lies behind it.
  bool has_casing = false;
};

/// The properties overlay, overlay-color and line-width, the same in every element that draws.
/// They take the ids first_id to first_id + 2.
void install_overlay_properties(GObjectClass* object_class,
                                guint first_id,
                                GstEllipseOverlayFlags default_parts);
/// @param which  The property's id minus first_id.
void set_overlay_property(OverlayStyle& style, guint which, const GValue* value);
void get_overlay_property(const OverlayStyle& style, guint which, GValue* value);
