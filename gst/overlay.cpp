// SPDX-License-Identifier: MIT
#include "gst/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/ellipse.hpp"

using Eigen::Vector2d;
using ellipse::Ellipse;

GType gst_ellipse_overlay_flags_get_type(void) {
  static const GFlagsValue kValues[] = {
      {GST_ELLIPSE_OVERLAY_NONE, "Nothing", "none"},
      {GST_ELLIPSE_OVERLAY_ELLIPSE, "The ellipse", "ellipse"},
      {GST_ELLIPSE_OVERLAY_AXES, "Its axes", "axes"},
      {GST_ELLIPSE_OVERLAY_CENTRE, "A cross at its centre", "centre"},
      {GST_ELLIPSE_OVERLAY_ROI, "The region that was searched", "roi"},
      {GST_ELLIPSE_OVERLAY_LABEL, "Its id, state and full axes", "label"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_flags_register_static("GstEllipseOverlayFlags", kValues);
  return kType;
}

void install_overlay_properties(GObjectClass* object_class,
                                guint first_id,
                                GstEllipseOverlayFlags default_parts) {
  const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                              GST_PARAM_MUTABLE_PLAYING);
  g_object_class_install_property(object_class,
                                  first_id,
                                  g_param_spec_flags("overlay",
                                                     "Overlay",
                                                     "What is drawn into the picture",
                                                     GST_TYPE_ELLIPSE_OVERLAY_FLAGS,
                                                     default_parts,
                                                     flags));
  g_object_class_install_property(object_class,
                                  first_id + 1,
                                  g_param_spec_uint("overlay-color",
                                                    "Overlay colour",
                                                    "Colour of the lines as 0xAARRGGBB",
                                                    0,
                                                    G_MAXUINT32,
                                                    OverlayStyle{}.color_argb,
                                                    flags));
  g_object_class_install_property(object_class,
                                  first_id + 2,
                                  g_param_spec_uint("line-width",
                                                    "Line width",
                                                    "Width of the lines in px",
                                                    1,
                                                    100,
                                                    OverlayStyle{}.line_width_px,
                                                    flags));
}

void set_overlay_property(OverlayStyle& style, guint which, const GValue* value) {
  if (which == 0) style.parts = static_cast<GstEllipseOverlayFlags>(g_value_get_flags(value));
  if (which == 1) style.color_argb = g_value_get_uint(value);
  if (which == 2) style.line_width_px = g_value_get_uint(value);
}

void get_overlay_property(const OverlayStyle& style, guint which, GValue* value) {
  if (which == 0) g_value_set_flags(value, style.parts);
  if (which == 1) g_value_set_uint(value, style.color_argb);
  if (which == 2) g_value_set_uint(value, style.line_width_px);
}

namespace {

// Blends one colour into a frame of any 8-bit format.
class Painter {
 public:
  Painter(GstVideoFrame& frame, guint argb) : frame_(frame), opacity_((argb >> 24U) / 255.0) {
    const std::array rgb = {
        (argb >> 16U & 0xffU) / 255.0, (argb >> 8U & 0xffU) / 255.0, (argb & 0xffU) / 255.0};
    const GstVideoFormatInfo* format = frame.info.finfo;
    components_ = std::min(3U, GST_VIDEO_FORMAT_INFO_N_COMPONENTS(format));
    if (GST_VIDEO_FORMAT_INFO_IS_RGB(format)) {
      for (guint i = 0; i < 3; ++i) levels_[i] = static_cast<guint8>(std::lround(255.0 * rgb[i]));
    } else {
      set_yuv(rgb);
    }
  }

  [[nodiscard]] int width() const { return GST_VIDEO_FRAME_WIDTH(&frame_); }
  [[nodiscard]] int height() const { return GST_VIDEO_FRAME_HEIGHT(&frame_); }

  /// @param coverage  0 to 1. Outside the frame nothing happens.
  void blend(int x, int y, double coverage) {
    if (x < 0 || y < 0 || x >= width() || y >= height() || !(coverage > 0.0)) return;
    for (guint i = 0; i < components_; ++i) blend_component(i, x, y, coverage * opacity_);
  }

 private:
  void set_yuv(const std::array<double, 3>& rgb) {
    double kr = 0.299;  // [BT601]
    double kb = 0.114;
    gst_video_color_matrix_get_Kr_Kb(frame_.info.colorimetry.matrix, &kr, &kb);
    const double y = kr * rgb[0] + (1.0 - kr - kb) * rgb[1] + kb * rgb[2];
    const std::array yuv = {y, 0.5 * (rgb[2] - y) / (1.0 - kb), 0.5 * (rgb[0] - y) / (1.0 - kr)};
    gint offset[GST_VIDEO_MAX_COMPONENTS];
    gint scale[GST_VIDEO_MAX_COMPONENTS];
    gst_video_color_range_offsets(frame_.info.colorimetry.range, frame_.info.finfo, offset, scale);
    for (guint i = 0; i < components_; ++i) {
      levels_[i] =
          static_cast<guint8>(std::clamp(std::lround(offset[i] + scale[i] * yuv[i]), 0L, 255L));
    }
  }

  void blend_component(guint i, int x, int y, double alpha) {
    const GstVideoFormatInfo* format = frame_.info.finfo;
    const guint w_sub = GST_VIDEO_FORMAT_INFO_W_SUB(format, i);
    const guint h_sub = GST_VIDEO_FORMAT_INFO_H_SUB(format, i);
    // Several pixels share a chroma sample: each takes its part.
    if (w_sub + h_sub > 0) alpha *= 0.5;
    auto* row = static_cast<guint8*>(GST_VIDEO_FRAME_COMP_DATA(&frame_, i)) +
                std::ptrdiff_t{y >> h_sub} * GST_VIDEO_FRAME_COMP_STRIDE(&frame_, i);
    guint8& sample = row[std::ptrdiff_t{x >> w_sub} * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame_, i)];
    sample = static_cast<guint8>(std::lround(std::lerp(sample, levels_[i], alpha)));
  }

  GstVideoFrame& frame_;
  double opacity_;
  guint components_ = 0;
  std::array<guint8, 4> levels_{};
};

// How much of a pixel a line covers, whose middle passes at this distance.
double line_coverage(double distance_px, double half_width_px) {
  return std::clamp(half_width_px + 0.5 - std::abs(distance_px), 0.0, 1.0);
}

Ellipse grown(const Ellipse& e, double by_px) {
  return {e.cx, e.cy, e.semi_major + by_px, std::max(0.0, e.semi_minor + by_px), e.angle_rad};
}

void draw_ellipse(Painter& painter, const Ellipse& e, double width_px) {
  const double half_width = width_px / 2.0;
  const Ellipse outer = grown(e, half_width + 1.0);
  // A curve parallel to an ellipse inwards is thinner than an ellipse where it is most curved.
  const double inset = (half_width + 1.0) * e.aspect_ratio();
  const Ellipse inner = grown(e, -std::min(inset, e.semi_minor));
  const double half_height = ellipse::half_extent(outer).y();
  const int top = std::max(0, static_cast<int>(std::floor(e.cy - half_height)));
  const int bottom =
      std::min(painter.height() - 1, static_cast<int>(std::ceil(e.cy + half_height)));
  for (int y = top; y <= bottom; ++y) {
    const ellipse::Interval band = ellipse::chord(outer, y);
    const ellipse::Interval hole = ellipse::chord(inner, y);
    const int last = static_cast<int>(std::min(band.end, painter.width() - 1.0));
    for (int x = static_cast<int>(std::max(0.0, std::ceil(band.begin))); x <= last; ++x) {
      if (x >= hole.begin && x + 1 < hole.end) x = static_cast<int>(hole.end);
      painter.blend(x, y, line_coverage(ellipse::sampson_distance(e, Vector2d(x, y)), half_width));
    }
  }
}

void draw_line(Painter& painter, const Vector2d& from, const Vector2d& to, double width_px) {
  const double length = (to - from).norm();
  if (!(length > 0.0)) return;
  const Vector2d along = (to - from) / length;
  const Vector2d across(-along.y(), along.x());
  const double half_width = width_px / 2.0;
  const double reach = half_width + 1.0;
  const int top = std::max(0, static_cast<int>(std::floor(std::min(from.y(), to.y()) - reach)));
  const int bottom = std::min(painter.height() - 1,
                              static_cast<int>(std::ceil(std::max(from.y(), to.y()) + reach)));
  const double left_end = std::min(from.x(), to.x()) - reach;
  const double right_end = std::max(from.x(), to.x()) + reach;
  for (int y = top; y <= bottom; ++y) {
    double left = left_end;
    double right = right_end;
    if (std::abs(along.y()) > 1e-6) {
      const double middle = from.x() + (y - from.y()) * along.x() / along.y();
      left = std::max(left, middle - reach / std::abs(along.y()));
      right = std::min(right, middle + reach / std::abs(along.y()));
    }
    const int last = std::min(painter.width() - 1, static_cast<int>(std::ceil(right)));
    for (int x = std::max(0, static_cast<int>(std::floor(left))); x <= last; ++x) {
      const Vector2d d = Vector2d(x, y) - from;
      const double beyond = std::max(-along.dot(d), along.dot(d) - length);
      const double end = std::clamp(0.5 - beyond, 0.0, 1.0);
      painter.blend(x, y, end * line_coverage(across.dot(d), half_width));
    }
  }
}

void draw_axes(Painter& painter, const Ellipse& e, double width_px) {
  constexpr double kQuarter = 1.5707963267948966;
  for (const double t : {0.0, kQuarter}) {
    draw_line(painter, e.point_at(t), e.point_at(t + 2.0 * kQuarter), width_px);
  }
}

void draw_cross(Painter& painter, const Vector2d& centre, double width_px) {
  const double arm = 3.0 + 2.0 * width_px;
  draw_line(painter, centre - Vector2d(arm, 0.0), centre + Vector2d(arm, 0.0), width_px);
  draw_line(painter, centre - Vector2d(0.0, arm), centre + Vector2d(0.0, arm), width_px);
}

void draw_region(Painter& painter, const GstEllipseMeta& meta, double width_px) {
  const Vector2d first(meta.roi_x, meta.roi_y);
  const Vector2d last =
      first + Vector2d(double(meta.roi_width) - 1.0, double(meta.roi_height) - 1.0);
  const std::array corners = {
      first, Vector2d(last.x(), first.y()), last, Vector2d(first.x(), last.y())};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    draw_line(painter, corners[i], corners[(i + 1) % corners.size()], width_px);
  }
}

std::string label_of(const GstEllipseMeta& meta) {
  std::ostringstream label;
  if (meta.role == GST_ELLIPSE_ROLE_TRUTH) {
    label << "truth ";
  } else {
    label << '#' << meta.id << ' ' << gst_ellipse_meta_get_state_name(&meta) << ' ';
  }
  label << std::lround(2.0 * meta.semi_major) << " x " << std::lround(2.0 * meta.semi_minor)
        << " px";
  return label.str();
}

// Below the ellipse, or wherever in the frame there is room for it, on a dark rim.
void draw_label(GstVideoFrame& frame, const GstEllipseMeta& meta, const OverlayStyle& style) {
  const int height = GST_VIDEO_FRAME_HEIGHT(&frame);
  const double size = std::clamp(height / 650.0, 0.4, 3.0);
  const int thickness = std::max(1, static_cast<int>(std::lround(size * 1.6)));
  const std::string text = label_of(meta);
  int baseline = 0;
  const cv::Size extent =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, thickness, &baseline);
  const int rim = thickness + 1;
  cv::Mat mask = cv::Mat::zeros(extent.height + baseline + 2 * rim, extent.width + 2 * rim, CV_8U);
  cv::putText(mask,
              text,
              {rim, rim + extent.height},
              cv::FONT_HERSHEY_SIMPLEX,
              size,
              cv::Scalar(255),
              thickness,
              cv::LINE_AA);
  cv::Mat dark;
  cv::dilate(mask, dark, cv::Mat(), {-1, -1}, rim);

  const Ellipse e{meta.cx, meta.cy, meta.semi_major, meta.semi_minor, meta.angle_rad};
  const double below = meta.cy + ellipse::half_extent(e).y() + style.line_width_px + 2.0;
  const int room_x = std::max(0, GST_VIDEO_FRAME_WIDTH(&frame) - mask.cols);
  const int room_y = std::max(0, height - mask.rows);
  const int left = static_cast<int>(std::clamp(meta.cx - mask.cols / 2.0, 0.0, double(room_x)));
  const int top = static_cast<int>(std::clamp(below, 0.0, double(room_y)));
  Painter rim_painter(frame, 0xb0000000U);
  Painter text_painter(frame, style.color_argb);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      rim_painter.blend(left + x, top + y, dark.at<std::uint8_t>(y, x) / 255.0);
      text_painter.blend(left + x, top + y, mask.at<std::uint8_t>(y, x) / 255.0);
    }
  }
}

}  // namespace

// Numbers of a picture. Metadata may come from anybody, and lines of 1e300 px are never done.
static bool is_drawable(const GstEllipseMeta& meta) {
  constexpr double kFarthestPx = 1e5;
  const auto is_near = [](double value) { return std::abs(value) <= kFarthestPx; };  // NaN is not
  return is_near(meta.cx) && is_near(meta.cy) && is_near(meta.semi_major) &&
         is_near(meta.semi_minor) && meta.semi_minor >= 0.1 && meta.semi_major >= meta.semi_minor &&
         std::isfinite(meta.angle_rad) && is_near(meta.roi_x) && is_near(meta.roi_y) &&
         is_near(meta.roi_width) && is_near(meta.roi_height);
}

void draw_overlay(GstVideoFrame& frame, const GstEllipseMeta& meta, const OverlayStyle& style) {
  if (!is_drawable(meta)) return;
  const Ellipse e{meta.cx, meta.cy, meta.semi_major, meta.semi_minor, meta.angle_rad};
  Painter painter(frame, style.color_argb);
  const double width = style.line_width_px;
  if ((style.parts & GST_ELLIPSE_OVERLAY_ROI) != 0) draw_region(painter, meta, 1.0);
  if ((style.parts & GST_ELLIPSE_OVERLAY_AXES) != 0) draw_axes(painter, e, 0.5 * width);
  if ((style.parts & GST_ELLIPSE_OVERLAY_ELLIPSE) != 0) draw_ellipse(painter, e, width);
  if ((style.parts & GST_ELLIPSE_OVERLAY_CENTRE) != 0) draw_cross(painter, e.center(), width);
  if ((style.parts & GST_ELLIPSE_OVERLAY_LABEL) != 0) draw_label(frame, meta, style);
}
