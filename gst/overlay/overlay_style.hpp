#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <string_view>

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

/// The properties overlay, overlay-color and line-width, which all drawing elements share. The
/// specifications are floating.
[[nodiscard]] std::array<GParamSpec*, 3> overlay_param_specs(GstEllipseOverlayFlags default_parts);
/// Does nothing if the property is none of these.
void set_overlay_property(OverlayStyle& style, std::string_view name, const GValue* value);
void get_overlay_property(const OverlayStyle& style, std::string_view name, GValue* value);
