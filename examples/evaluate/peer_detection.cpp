// SPDX-License-Identifier: MIT
#include "examples/evaluate/peer_detection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evaluate {

std::optional<ellipse::Ellipse> ellipse_of_axes(
    double cx, double cy, double a, double b, double angle_rad) {
  constexpr double kPi = std::numbers::pi;
  if (!std::isfinite(cx + cy + a + b + angle_rad) || a <= 0.0 || b <= 0.0) return std::nullopt;
  const double major_rad = a >= b ? angle_rad : angle_rad + kPi / 2.0;
  double angle = std::remainder(major_rad, kPi);
  if (angle <= -kPi / 2.0) angle += kPi;
  return ellipse::Ellipse{cx, cy, std::max(a, b), std::min(a, b), angle};
}

ellipse::Detection scored_by_perimeter(const ellipse::Ellipse& e) {
  return {e, 0.0, 0.0, ellipse::perimeter_px(e)};
}

}  // namespace evaluate
