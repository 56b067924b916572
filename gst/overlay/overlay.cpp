// SPDX-License-Identifier: MIT
#include "gst/overlay/overlay.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "core/geometry/ellipse.hpp"
#include "gst/meta_ellipse.hpp"
#include "gst/overlay/label.hpp"

using Eigen::Vector2d;
using ellipse::Ellipse;

namespace {

constexpr double kCasingPx = 1.0;  // on each side of a line

bool is_plausible_px(double value) {
  constexpr double kFarthestPx = 1e5;
  return std::abs(value) <= kFarthestPx;  // NaN is not
}

// Plausible values. Metadata may come from any element; a line of 1e300 px would never finish.
bool is_drawable(const GstEllipseMeta& meta) {
  return is_plausible_px(meta.cx) && is_plausible_px(meta.cy) && is_plausible_px(meta.semi_major) &&
         is_plausible_px(meta.semi_minor) && meta.semi_minor >= 0.1 &&
         meta.semi_major >= meta.semi_minor && std::isfinite(meta.angle_rad) &&
         is_plausible_px(meta.roi_x) && is_plausible_px(meta.roi_y) &&
         is_plausible_px(meta.roi_width) && is_plausible_px(meta.roi_height);
}

void cover_ellipse(Canvas& canvas, const Ellipse& e, double width_px) {
  // A chord over the angle t deviates from the curve by at most a t^2 / 8.
  constexpr double kDeviationPx = 0.03;
  const double angle = std::min(0.4, std::sqrt(8.0 * kDeviationPx / e.semi_major));
  const int chords = static_cast<int>(std::ceil(2.0 * std::numbers::pi / angle));
  Vector2d from = e.point_at(0.0);
  for (int i = 1; i <= chords; ++i) {
    const Vector2d to = e.point_at(2.0 * std::numbers::pi * i / chords);
    canvas.cover_line(from, to, width_px);
    from = to;
  }
}

// The outline of a target in distorted image coordinates.
class Outline {
 public:
  explicit Outline(const GstEllipseMeta& meta)
      : meta_(meta), size_(std::min(meta.n_outline, kMaxPoints)) {}

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] guint size() const { return size_; }
  [[nodiscard]] Vector2d at(guint i) const {
    const gsize k = i % size_;
    return {meta_.outline[2 * k], meta_.outline[2 * k + 1]};
  }
  [[nodiscard]] bool has(guint i) const {
    return is_plausible_px(at(i).x()) && is_plausible_px(at(i).y());
  }

  // The axis-aligned ellipse of the same extent.
  [[nodiscard]] Ellipse extent() const {
    Eigen::AlignedBox2d box;
    for (guint i = 0; i < size_; ++i) {
      if (has(i)) box.extend(at(i));
    }
    if (box.isEmpty()) return {};
    const Vector2d half = 0.5 * box.sizes();
    return {box.center().x(), box.center().y(), half.x(), half.y(), 0.0};
  }

 private:
  static constexpr guint kMaxPoints = G_N_ELEMENTS(GstEllipseMeta::outline) / 2;
  const GstEllipseMeta& meta_;
  guint size_;
};

// A smooth curve through all points [CatmullRom1974]; points outside the view leave a gap.
void cover_outline(Canvas& canvas, const Outline& outline, double width_px) {
  constexpr int kChords = 8;
  const guint n = outline.size();
  for (guint i = 0; i < n; ++i) {
    const bool is_visible =
        outline.has(i + n - 1) && outline.has(i) && outline.has(i + 1) && outline.has(i + 2);
    if (!is_visible) continue;
    const Vector2d p0 = outline.at(i + n - 1);
    const Vector2d p1 = outline.at(i);
    const Vector2d p2 = outline.at(i + 1);
    const Vector2d p3 = outline.at(i + 2);
    Vector2d from = p1;
    for (int k = 1; k <= kChords; ++k) {
      const double t = static_cast<double>(k) / kChords;
      const Vector2d to =
          p1 + 0.5 * t *
                   (p2 - p0 +
                    t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + t * (3.0 * (p1 - p2) + p3 - p0)));
      canvas.cover_line(from, to, width_px);
      from = to;
    }
  }
}

void cover_axes(Canvas& canvas, const Ellipse& e, double width_px) {
  for (const double t : {0.0, 0.5 * std::numbers::pi}) {
    canvas.cover_line(e.point_at(t), e.point_at(t + std::numbers::pi), width_px);
  }
}

// Draws straight lines between opposite points; ignores the slight distortion of the axes.
void cover_axes(Canvas& canvas, const Outline& outline, double width_px) {
  const guint half = outline.size() / 2;
  for (const guint i : {0U, half / 2}) {
    if (!outline.has(i) || !outline.has(i + half)) continue;
    canvas.cover_line(outline.at(i), outline.at(i + half), width_px);
  }
}

double cross_arm_px(double width_px) {
  return 3.0 + 2.0 * width_px;
}

void cover_cross(Canvas& canvas, const Vector2d& centre, double arm, double width_px) {
  canvas.cover_line(centre - Vector2d(arm, 0.0), centre + Vector2d(arm, 0.0), width_px);
  canvas.cover_line(centre - Vector2d(0.0, arm), centre + Vector2d(0.0, arm), width_px);
}

ellipse::Rect square_around(const Vector2d& centre, double half_side_px) {
  const int side = 2 * static_cast<int>(std::ceil(half_side_px)) + 1;
  return {static_cast<int>(std::floor(centre.x())) - side / 2,
          static_cast<int>(std::floor(centre.y())) - side / 2,
          side,
          side};
}

void cover_region(Canvas& canvas, const GstEllipseMeta& meta, double width_px) {
  if (meta.roi_width == 0 || meta.roi_height == 0) return;
  const Vector2d first(meta.roi_x, meta.roi_y);
  const Vector2d last =
      first + Vector2d(double(meta.roi_width) - 1.0, double(meta.roi_height) - 1.0);
  const std::array corners = {
      first, Vector2d(last.x(), first.y()), last, Vector2d(first.x(), last.y())};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    canvas.cover_line(corners[i], corners[(i + 1) % corners.size()], width_px);
  }
}

// The projected centre of the circle if the camera is known; otherwise the centre of the distorted
// outline, if there is one, or of the ellipse.
Vector2d centre_of(const GstEllipseMeta& meta) {
  const bool is_known =
      meta.has_pose && is_plausible_px(meta.centre_x) && is_plausible_px(meta.centre_y);
  if (is_known) return {meta.centre_x, meta.centre_y};
  const Outline outline(meta);
  return outline.empty() ? Vector2d(meta.cx, meta.cy) : outline.extent().center();
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

}  // namespace

void Overlay::begin(int width, int height) {
  canvas_.clear(width, height);
  taken_.clear();
}

void Overlay::cover_parts(const GstEllipseMeta& meta, const OverlayStyle& style, double wider_px) {
  const Ellipse e = ellipse_of(meta);
  const double width = style.line_width_px;
  const double axes_width = 0.5 * width + wider_px;
  const auto has = [&](GstEllipseOverlayFlags part) { return (style.parts & part) != 0; };
  if (has(GST_ELLIPSE_OVERLAY_ROI)) cover_region(canvas_, meta, 1.0 + wider_px);
  const Outline outline(meta);
  if (outline.empty()) {
    if (has(GST_ELLIPSE_OVERLAY_AXES)) cover_axes(canvas_, e, axes_width);
    if (has(GST_ELLIPSE_OVERLAY_ELLIPSE)) cover_ellipse(canvas_, e, width + wider_px);
  } else {
    if (has(GST_ELLIPSE_OVERLAY_AXES)) cover_axes(canvas_, outline, axes_width);
    if (has(GST_ELLIPSE_OVERLAY_ELLIPSE)) cover_outline(canvas_, outline, width + wider_px);
  }
  if (has(GST_ELLIPSE_OVERLAY_CENTRE)) {
    cover_cross(canvas_, centre_of(meta), cross_arm_px(width), width + wider_px);
  }
}

void Overlay::draw(const GstEllipseMeta& meta, const OverlayStyle& style) {
  const guint opacity = style.color_argb >> 24U;
  if (!is_drawable(meta) || opacity == 0) return;
  if (style.has_casing) {
    cover_parts(meta, style, 2.0 * kCasingPx);
    canvas_.paint(opacity << 24U | contrast_to(style.color_argb));
  }
  cover_parts(meta, style, 0.0);
  canvas_.paint(style.color_argb);
  if ((style.parts & GST_ELLIPSE_OVERLAY_LABEL) != 0) draw_label(meta, style);
}

void Overlay::draw_label(const GstEllipseMeta& meta, const OverlayStyle& style) {
  const Outline outline(meta);
  const Ellipse e = outline.empty() ? ellipse_of(meta) : outline.extent();
  const ellipse::Rect frame{0, 0, canvas_.width(), canvas_.height()};
  std::optional<Label> label = make_label(label_of(meta), frame.width, frame.height);
  if (!label) return;
  const double width = style.line_width_px;
  taken_.push_back(square_around(centre_of(meta), cross_arm_px(width) + 0.5 * width));
  const auto box = place_label(*label, e, 0.5 * width + 4.0, frame, taken_);
  if (!box) return;
  label->box = *box;
  ::draw_label(canvas_, *label, style.color_argb);
  taken_.push_back(*box);
}
