// SPDX-License-Identifier: MIT
#include "core/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace ellipse {

double contour_overlap(std::span<const cv::Point> contour, const Ellipse& e) {
  if (contour.empty()) return 0.0;
  // |r - 1| r / |(u/a, v/b)| <= t, the Sampson distance, with its divisions turned into products.
  const double c = std::cos(e.angle_rad);
  const double s = std::sin(e.angle_rad);
  const double inverse_a = 1.0 / e.semi_major;
  const double inverse_b = 1.0 / e.semi_minor;
  std::ptrdiff_t on_ellipse = 0;
  for (const cv::Point& pixel : contour) {
    const double dx = pixel.x - e.cx;
    const double dy = pixel.y - e.cy;
    const double u = (c * dx + s * dy) * inverse_a;
    const double v = (c * dy - s * dx) * inverse_b;
    const double r_sq = u * u + v * v;
    const double gradient_sq = u * u * inverse_a * inverse_a + v * v * inverse_b * inverse_b;
    const double off = std::sqrt(r_sq) - 1.0;
    on_ellipse +=
        off * off * r_sq <= kOverlapTolerancePx * kOverlapTolerancePx * gradient_sq ? 1 : 0;
  }
  return static_cast<double>(on_ellipse) / static_cast<double>(contour.size());
}

double ellipse_overlap(const Ellipse& e, const ImageView& thick_edges) {
  // Steps of at most a pixel along the perimeter, weighted by their length.
  const int steps =
      std::clamp(static_cast<int>(std::ceil(2.0 * std::numbers::pi * e.semi_major)), 16, 1 << 16);
  const double step_rad = 2.0 * std::numbers::pi / steps;
  const double turn_cos = std::cos(step_rad);
  const double turn_sin = std::sin(step_rad);
  const Eigen::Vector2d major =
      e.semi_major * Eigen::Vector2d(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d minor =
      e.semi_minor * Eigen::Vector2d(-std::sin(e.angle_rad), std::cos(e.angle_rad));

  double inside = 0.0;
  double on_edge = 0.0;
  double u = 1.0;
  double v = 0.0;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d p = e.center() + u * major + v * minor;
    const int x = static_cast<int>(std::lround(p.x()));
    const int y = static_cast<int>(std::lround(p.y()));
    if (thick_edges.bounds().contains(x, y)) {
      const double length = (v * major - u * minor).norm();
      inside += length;
      if (thick_edges.row(y)[x] != 0) on_edge += length;
    }
    const double next_u = turn_cos * u - turn_sin * v;
    v = turn_sin * u + turn_cos * v;
    u = next_u;
  }
  return inside > 0.0 ? on_edge / inside : 0.0;
}

}  // namespace ellipse
