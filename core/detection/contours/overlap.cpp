// SPDX-License-Identifier: MIT
#include "core/detection/contours/overlap.hpp"

#include <cmath>
#include <cstddef>

namespace ellipse {

double contour_overlap(std::span<const cv::Point> contour, const Ellipse& e) {
  if (contour.empty()) return 0.0;
  // The Sampson distance |r - 1| r / |(u/a, v/b)| < t, squared and without divisions.
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
        off * off * r_sq < kOverlapTolerancePx * kOverlapTolerancePx * gradient_sq ? 1 : 0;
  }
  return static_cast<double>(on_ellipse) / static_cast<double>(contour.size());
}

PerimeterSupport perimeter_support(const Ellipse& e, const ImageView& thick_edges) {
  PerimeterSupport support;
  walk_perimeter(e, [&](const PerimeterStep& step) {
    const int x = cvRound(step.point.x());
    const int y = cvRound(step.point.y());
    if (!thick_edges.bounds().contains(x, y)) return;
    support.inside_px += step.length_px;
    if (thick_edges.row(y)[x] != 0) support.on_edge_px += step.length_px;
  });
  return support;
}

}  // namespace ellipse
