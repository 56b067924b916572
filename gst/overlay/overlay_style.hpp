#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

G_BEGIN_DECLS

/// The drawn parts of an ellipse.
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

/// The style of the drawing.
struct OverlayStyle {
  GstEllipseOverlayFlags parts = GST_ELLIPSE_OVERLAY_NONE;
  guint color_argb = 0xff00ff00;
  guint line_width_px = 2;
  /// Bright lines get a black edge, dark lines a white one. For grey formats, in which a line may
  /// have the grey level of its background.
  bool has_casing = false;
};

/// Installs the properties overlay, overlay-color and line-width, which all drawing elements share,
/// with the ids first_id to first_id + 2.
void install_overlay_properties(GObjectClass* object_class,
                                guint first_id,
                                GstEllipseOverlayFlags default_parts);
/// @param which  The property's id minus first_id.
void set_overlay_property(OverlayStyle& style, guint which, const GValue* value);
void get_overlay_property(const OverlayStyle& style, guint which, GValue* value);
