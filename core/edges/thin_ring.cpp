// SPDX-License-Identifier: MIT
#include "core/edges/thin_ring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/edges/subpixel.hpp"

namespace ellipse {
namespace {

constexpr double kWidest = 6.0;         // largest corrected gap [px]
constexpr double kMinRingRatio = 0.25;  // a smaller disc inside is a pattern, not the inner edge
constexpr std::size_t kSteps = 8;       // of averages: over half a turn, and over a pixel

using PerWidth = std::array<double, 31>;  // for widths from 0 to kWidest

Eigen::Vector2d direction(std::size_t i) {
  const double angle = std::numbers::pi * static_cast<double>(i) / kSteps;
  return {std::cos(angle), std::sin(angle)};
}

// Brightness of a bar, blurred by the lens, at a distance from its middle.
double bar_at(double distance, double width) {
  const double scale = 1.0 / std::sqrt(2.0 * kLensVariance);
  return 0.5 *
         (std::erf((0.5 * width + distance) * scale) + std::erf((0.5 * width - distance) * scale));
}

// Response of GradientMap's 5 x 5 kernels to the bar at pixel (x, 0), against its normal.
double slope_of_bar(const Eigen::Vector2d& normal, double x, double width) {
  double slope = 0.0;
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t i = 0; i < 5; ++i) {
      const Eigen::Vector2d pixel(x + static_cast<double>(i) - 2.0, static_cast<double>(j) - 2.0);
      const double along =
          normal.x() * kDifference[i] * kSmoothing[j] + normal.y() * kSmoothing[i] * kDifference[j];
      slope += along * bar_at(normal.dot(pixel), width);
    }
  }
  return -slope;
}

// Distance of the gradient maximum from the bar's middle: vertex of a parabola through the pixel
// with the largest gradient and its neighbours, averaged over sub-pixel positions of the bar.
double maximum_of_bar(const Eigen::Vector2d& normal, double width) {
  double sum = 0.0;
  for (std::size_t phase = 0; phase < kSteps; ++phase) {
    double x = (static_cast<double>(phase) + 0.5) / kSteps;
    std::array<double, 3> slopes = {slope_of_bar(normal, x - 1.0, width),
                                    slope_of_bar(normal, x, width),
                                    slope_of_bar(normal, x + 1.0, width)};
    while (slopes[2] > slopes[1]) {
      x += 1.0;
      slopes = {slopes[1], slopes[2], slope_of_bar(normal, x + 1.0, width)};
    }
    sum += x + parabola_vertex(slopes[0], slopes[1], slopes[2]);
  }
  return normal.x() * sum / kSteps;
}

// Distance between a bar's gradient maxima by its width, for normals at 0, 1/16 and 1/8 of a turn
// from an axis. The kernels are symmetric, so that the other octants follow.
const std::array<PerWidth, 3>& maxima_distances() {
  static const auto kTable = [] {
    std::array<PerWidth, 3> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      for (std::size_t k = 0; k < table[i].size(); ++k) {
        const double steps = std::max(0.01, static_cast<double>(k));
        table[i][k] = 2.0 * maximum_of_bar(direction(i), kWidest * steps / (table[i].size() - 1));
      }
    }
    return table;
  }();
  return kTable;
}

double maxima_distance(double width, std::size_t direction) {
  const std::size_t from_axis = std::min(direction % 4, 4 - direction % 4);
  const PerWidth& table = maxima_distances()[from_axis];
  const double at = width / kWidest * (table.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  if (k + 1 >= table.size()) return width;
  return std::lerp(table[k], table[k + 1], at - static_cast<double>(k));
}

// Distance of an ellipse's tangent from its centre: |M normal|.
double tangent_distance(const Eigen::Matrix2d& stretch, std::size_t i) {
  return (stretch * direction(i)).norm();
}

Eigen::Matrix2d stretch_of(const Ellipse& e) {
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d across(-axis.y(), axis.x());
  return e.semi_major * axis * axis.transpose() + e.semi_minor * across * across.transpose();
}

}  // namespace

double min_maxima_distance() {
  return maxima_distances()[0][0];
}

bool is_thin(const RingEdges& maxima) {
  const Eigen::Matrix2d outer = stretch_of(maxima.outer);
  const Eigen::Matrix2d inner = stretch_of(maxima.inner);
  for (std::size_t i = 0; i < kSteps; ++i) {
    if (tangent_distance(outer, i) - tangent_distance(inner, i) > kWidest) return false;
  }
  return true;
}

RingEdges without_blur_bias(const RingEdges& maxima) {
  if (!is_thin(maxima)) return maxima;
  const Eigen::Matrix2d outer = stretch_of(maxima.outer);
  const Eigen::Matrix2d inner = stretch_of(maxima.inner);
  const Eigen::Matrix2d middle = 0.5 * (outer + inner);
  std::array<double, kSteps> radii;  // of the ring's middle line [px]
  double gaps = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    radii[i] = tangent_distance(middle, i);
    gaps += tangent_distance(outer, i) - tangent_distance(inner, i);
  }
  if (!(gaps > 0.0)) return maxima;

  // Bisects the ring's width over its middle radius, down to the precision of a float; the
  // predicted gaps grow with it.
  float low = 0.0F;
  float high = 2.0F;
  for (float share = 1.0F; low < share && share < high; share = 0.5F * (low + high)) {
    double predicted = 0.0;
    for (std::size_t i = 0; i < kSteps; ++i) {
      predicted += maxima_distance(share * radii[i], i);
    }
    (predicted < gaps ? low : high) = share;
  }
  const Eigen::Matrix2d shape = middle * middle;
  const auto at = [&](double factor, const Ellipse& maximum) {
    return from_shape(maximum.center(), factor * factor * shape).value_or(maximum);
  };
  return {at(1.0 + 0.5 * low, maxima.outer), at(1.0 - 0.5 * low, maxima.inner)};
}

bool are_partners(const Ellipse& a, const Ellipse& b) {
  const double larger = std::max(a.semi_major, b.semi_major);
  const double ratio = std::min(a.semi_major, b.semi_major) / larger;
  return ratio >= kMinRingRatio && ratio <= kMaxRingRatio && are_concentric(a, b);
}

}  // namespace ellipse
