// SPDX-License-Identifier: MIT
#include "core/geometry/ellipse.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

// Normalizes to (-pi/2, pi/2]: opposite directions denote the same axis.
double normalized_axis_angle(double angle_rad) {
  angle_rad = std::remainder(angle_rad, std::numbers::pi);
  return angle_rad <= -std::numbers::pi / 2 ? std::numbers::pi / 2 : angle_rad;
}

Interval clip(const Interval& a, double begin, double end) {
  return {std::max(a.begin, begin), std::min(a.end, end)};
}

// The parts of horizontal lines inside one ellipse.
class Chords {
 public:
  explicit Chords(const Ellipse& e) : center_(e.center()) {
    const Eigen::Matrix2d shape = shape_matrix(e);
    half_height_sq_ = shape(1, 1);
    slope_ = shape(0, 1) / shape(1, 1);
    half_width_sq_ = shape.determinant() / shape(1, 1);
  }

  [[nodiscard]] Interval at(double y) const {
    const double dy = y - center_.y();
    const double remaining = 1.0 - dy * dy / half_height_sq_;
    if (!(remaining > 0.0)) return {};
    const double middle = center_.x() + slope_ * dy;
    const double half = std::sqrt(half_width_sq_ * remaining);
    return {middle - half, middle + half};
  }

 private:
  Eigen::Vector2d center_;
  double half_height_sq_ = 0.0;
  double half_width_sq_ = 0.0;  // at the height of the centre
  double slope_ = 0.0;          // of the line through the chords' centres, dx / dy
};

}  // namespace

Eigen::Vector2d Ellipse::point_at(double t_rad) const {
  const double u = semi_major * std::cos(t_rad);
  const double v = semi_minor * std::sin(t_rad);
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {cx + c * u - s * v, cy + s * u + c * v};
}

Eigen::Vector2d half_extent(const Ellipse& e) {
  return shape_matrix(e).diagonal().cwiseSqrt();
}

double perimeter_px(const Ellipse& e) {
  const double sum = e.semi_major + e.semi_minor;
  const double h = std::pow((e.semi_major - e.semi_minor) / sum, 2);
  // [Ramanujan1914] second approximation.
  return std::numbers::pi * sum * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
}

Eigen::Matrix2d shape_matrix(const Ellipse& e) {
  const Eigen::Vector2d major =
      e.semi_major * Eigen::Vector2d(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d minor =
      e.semi_minor * Eigen::Vector2d(-std::sin(e.angle_rad), std::cos(e.angle_rad));
  return major * major.transpose() + minor * minor.transpose();
}

std::optional<Ellipse> from_shape(const Eigen::Vector2d& center, const Eigen::Matrix2d& shape) {
  const double mean = 0.5 * (shape(0, 0) + shape(1, 1));
  const double diff = 0.5 * (shape(0, 0) - shape(1, 1));
  const double off = 0.5 * (shape(0, 1) + shape(1, 0));
  const double radius = std::hypot(diff, off);
  const double major_sq = mean + radius;
  // Small eigenvalue from the determinant: mean - radius suffers cancellation on flat ellipses.
  const double minor_sq = (shape(0, 0) * shape(1, 1) - off * off) / major_sq;
  if (!(minor_sq > 0.0) || !std::isfinite(major_sq) || !center.allFinite()) return std::nullopt;
  return Ellipse{center.x(),
                 center.y(),
                 std::sqrt(major_sq),
                 std::min(std::sqrt(minor_sq), std::sqrt(major_sq)),
                 normalized_axis_angle(0.5 * std::atan2(off, diff))};
}

Eigen::Matrix3d conic_matrix(const Ellipse& e) {
  const Eigen::Matrix2d inverse_shape = shape_matrix(e).inverse();
  const Eigen::Vector2d linear = -inverse_shape * e.center();
  Eigen::Matrix3d conic;
  conic << inverse_shape, linear, linear.transpose(), -linear.dot(e.center()) - 1.0;
  return conic;
}

std::optional<Ellipse> from_conic(const Eigen::Matrix3d& conic) {
  const Eigen::Matrix2d quadratic = conic.topLeftCorner<2, 2>();
  if (!(quadratic.determinant() > 0.0)) return std::nullopt;  // hyperbola, parabola, NaN
  const Eigen::Vector2d center = -quadratic.inverse() * conic.topRightCorner<2, 1>();
  const double level = -(conic(2, 2) + conic.topRightCorner<2, 1>().dot(center));
  return from_shape(center, quadratic.inverse() * level);
}

std::optional<Ellipse> transformed(const Ellipse& e,
                                   const Eigen::Matrix2d& linear,
                                   const Eigen::Vector2d& translation_px) {
  return from_shape(linear * e.center() + translation_px,
                    linear * shape_matrix(e) * linear.transpose());
}

Ellipse scaled(const Ellipse& e, double factor) {
  return {(e.cx + 0.5) * factor - 0.5,
          (e.cy + 0.5) * factor - 0.5,
          e.semi_major * factor,
          e.semi_minor * factor,
          e.angle_rad};
}

Ellipse translated(const Ellipse& e, double dx_px, double dy_px) {
  return {e.cx + dx_px, e.cy + dy_px, e.semi_major, e.semi_minor, e.angle_rad};
}

double sampson_distance(const Ellipse& e, const Eigen::Vector2d& point_px) {
  const double c = std::cos(e.angle_rad);
  const double s = std::sin(e.angle_rad);
  const Eigen::Vector2d d = point_px - e.center();
  const double u = (c * d.x() + s * d.y()) / e.semi_major;
  const double v = (c * d.y() - s * d.x()) / e.semi_minor;
  const double r = std::hypot(u, v);
  const double gradient = std::hypot(u / e.semi_major, v / e.semi_minor);
  if (gradient == 0.0) return -e.semi_minor;
  // [Sampson1982] f / |grad f| with f = r - 1, whose gradient is (u/a, v/b) / r.
  return (r - 1.0) * r / gradient;
}

double max_difference_px(const Ellipse& a, const Ellipse& b) {
  return std::max({std::abs(a.cx - b.cx),
                   std::abs(a.cy - b.cy),
                   std::abs(a.semi_major - b.semi_major),
                   std::abs(a.semi_minor - b.semi_minor)});
}

bool is_same(const Ellipse& e, const Ellipse& reference, const Tolerance& tolerance) {
  return max_difference_px(e, reference) <= tolerance.of(reference);
}

bool are_concentric(const Ellipse& a, const Ellipse& b) {
  const Ellipse& larger = a.semi_major > b.semi_major ? a : b;
  return (a.center() - b.center()).norm() <= kSameTarget.of(larger);
}

double iou_inside(const Ellipse& a, const Ellipse& b, int width, int height) {
  const double half_a = half_extent(a).y();
  const double half_b = half_extent(b).y();
  const double top = std::max(-0.5, std::min(a.cy - half_a, b.cy - half_b));
  const double bottom = std::min(height - 0.5, std::max(a.cy + half_a, b.cy + half_b));
  if (!(bottom > top)) return 0.0;

  const int lines = std::clamp(static_cast<int>(std::ceil(2.0 * (bottom - top))), 512, 16384);
  const Chords chords_a(a);
  const Chords chords_b(b);
  double common = 0.0;
  double either = 0.0;
  for (int i = 0; i < lines; ++i) {
    const double y = top + (i + 0.5) * (bottom - top) / lines;
    const Interval in_a = clip(chords_a.at(y), -0.5, width - 0.5);
    const Interval in_b = clip(chords_b.at(y), -0.5, width - 0.5);
    const double both = clip(in_a, in_b.begin, in_b.end).length();
    common += both;
    either += in_a.length() + in_b.length() - both;
  }
  return either > 0.0 ? common / either : 0.0;
}

double visible_fraction(const Ellipse& e, int width, int height) {
  const Eigen::Vector2d half = half_extent(e);
  if (e.cx - half.x() >= -0.5 && e.cx + half.x() < width - 0.5 &&  //
      e.cy - half.y() >= -0.5 && e.cy + half.y() < height - 0.5) {
    return 1.0;
  }
  double inside = 0.0;
  double total = 0.0;
  walk_perimeter(e, [&](const PerimeterStep& step) {
    total += step.length_px;
    if (is_in_picture(step.point, width, height)) inside += step.length_px;
  });
  return total > 0.0 ? inside / total : 0.0;
}

}  // namespace ellipse
