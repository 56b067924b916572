// SPDX-License-Identifier: MIT
#include "gst/overlay/overlay_style.hpp"

GType gst_ellipse_overlay_flags_get_type(void) {
  static const GFlagsValue kValues[] = {
      {GST_ELLIPSE_OVERLAY_NONE, "Nothing", "none"},
      {GST_ELLIPSE_OVERLAY_ELLIPSE, "Ellipse", "ellipse"},
      {GST_ELLIPSE_OVERLAY_AXES, "Axes", "axes"},
      {GST_ELLIPSE_OVERLAY_CENTRE, "Cross at the centre", "centre"},
      {GST_ELLIPSE_OVERLAY_ROI, "Search region", "roi"},
      {GST_ELLIPSE_OVERLAY_LABEL, "Id, state and full axes", "label"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_flags_register_static("GstEllipseOverlayFlags", kValues);
  return kType;
}

std::array<GParamSpec*, 3> overlay_param_specs(GstEllipseOverlayFlags default_parts) {
  const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                              GST_PARAM_MUTABLE_PLAYING);
  return {
      g_param_spec_flags("overlay",
                         "Overlay",
                         "What to draw",
                         GST_TYPE_ELLIPSE_OVERLAY_FLAGS,
                         default_parts,
                         flags),
      g_param_spec_uint("overlay-color",
                        "Overlay colour",
                        "Line colour, 0xAARRGGBB",
                        0,
                        G_MAXUINT32,
                        OverlayStyle{}.color_argb,
                        flags),
      g_param_spec_uint("line-width",
                        "Line width",
                        "Line width [px]",
                        1,
                        100,
                        OverlayStyle{}.line_width_px,
                        flags),
  };
}

void set_overlay_property(OverlayStyle& style, std::string_view name, const GValue* value) {
  if (name == "overlay") {
    style.parts = static_cast<GstEllipseOverlayFlags>(g_value_get_flags(value));
  }
  if (name == "overlay-color") style.color_argb = g_value_get_uint(value);
  if (name == "line-width") style.line_width_px = g_value_get_uint(value);
}

void get_overlay_property(const OverlayStyle& style, std::string_view name, GValue* value) {
  if (name == "overlay") g_value_set_flags(value, style.parts);
  if (name == "overlay-color") g_value_set_uint(value, style.color_argb);
  if (name == "line-width") g_value_set_uint(value, style.line_width_px);
}
