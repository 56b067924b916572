// SPDX-License-Identifier: MIT
#include "core/edges/blurred_bar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/edges/gradient_map.hpp"
#include "core/edges/subpixel.hpp"

namespace ellipse {
namespace {

constexpr double kWidest = 6.0;  // width beyond which blur in focus does not move the maxima [px]

double lens_variance(double defocus) {
  return kLensVariance * std::pow(4.0, defocus);
}

// Standard deviation by lens and kernels [px].
double blur_px(double defocus) {
  return std::sqrt(kSharpVariance - kLensVariance + lens_variance(defocus));
}

double widest_at(double blur) {
  return kWidest * blur / blur_px(0.0);
}

struct Bar {
  double width_px;
  double lens_variance;

  // Brightness at a distance from its middle.
  [[nodiscard]] double at(double distance_px) const {
    const double scale = 1.0 / std::sqrt(2.0 * lens_variance);
    return 0.5 * (std::erf((0.5 * width_px + distance_px) * scale) +
                  std::erf((0.5 * width_px - distance_px) * scale));
  }
};

// Response of GradientMap's 5 x 5 kernels to the bar at pixel (x, 0), against its normal.
double slope_of(const Bar& bar, const Eigen::Vector2d& normal, double x) {
  double slope = 0.0;
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t i = 0; i < 5; ++i) {
      const Eigen::Vector2d pixel(x + static_cast<double>(i) - 2.0, static_cast<double>(j) - 2.0);
      const double along =
          normal.x() * kDifference[i] * kSmoothing[j] + normal.y() * kSmoothing[i] * kDifference[j];
      slope += along * bar.at(normal.dot(pixel));
    }
  }
  return -slope;
}

// Maxima of the parabola through the pixel with the largest gradient and its neighbours, averaged
// over positions within a pixel.
BarMaxima rendered_maxima(const Bar& bar, const Eigen::Vector2d& normal) {
  const int phases = 8;
  double position = 0.0;
  double sharpness = 0.0;
  for (int phase = 0; phase < phases; ++phase) {
    double x = (phase + 0.5) / phases;
    std::array<double, 3> slopes = {
        slope_of(bar, normal, x - 1.0), slope_of(bar, normal, x), slope_of(bar, normal, x + 1.0)};
    while (slopes[2] > slopes[1]) {
      x += 1.0;
      slopes = {slopes[1], slopes[2], slope_of(bar, normal, x + 1.0)};
    }
    position += x + parabola_vertex(slopes[0], slopes[1], slopes[2]);
    sharpness += 2.0 - (slopes[0] + slopes[2]) / slopes[1];
  }
  return {2.0 * normal.x() * position / phases, sharpness / (phases * normal.x() * normal.x())};
}

// Maxima in standard deviations of the blur, by defocus, direction and width: for normals at 0,
// 1/16 and 1/8 of a turn from an axis, since the kernels are symmetric, and for widths from 0 to
// the widest.
using Table = std::array<std::array<std::array<BarMaxima, 31>, 3>, 4>;

const Table& table() {
  static const auto kTable = [] {
    Table table{};
    for (std::size_t blur = 0; blur < table.size(); ++blur) {
      const auto defocus = static_cast<double>(blur);
      const double unit = blur_px(defocus);
      for (std::size_t i = 0; i < table[blur].size(); ++i) {
        auto& by_width = table[blur][i];
        for (std::size_t k = 0; k < by_width.size(); ++k) {
          const double steps = std::max(0.01, static_cast<double>(k));
          const double width = widest_at(unit) * steps / (by_width.size() - 1);
          const BarMaxima maxima =
              rendered_maxima({width, lens_variance(defocus)}, bar_normals()[i]);
          by_width[k] = {maxima.distance_px / unit, maxima.sharpness * unit * unit};
        }
      }
    }
    return table;
  }();
  return kTable;
}

BarMaxima between(const BarMaxima& a, const BarMaxima& b, double share) {
  return {a.distance_px + share * (b.distance_px - a.distance_px),
          a.sharpness + share * (b.sharpness - a.sharpness)};
}

}  // namespace

const std::array<Eigen::Vector2d, kBarDirections>& bar_normals() {
  static const auto kNormals = [] {
    std::array<Eigen::Vector2d, kBarDirections> normals;
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kBarDirections;
      normals[i] = {std::cos(angle), std::sin(angle)};
    }
    return normals;
  }();
  return kNormals;
}

BlurredBars::BlurredBars(double defocus)
    : blur_px_(blur_px(defocus)),
      widest_px_(widest_at(blur_px_)),
      sharper_(std::min(static_cast<std::size_t>(defocus), table().size() - 2)),
      share_(defocus - static_cast<double>(sharper_)) {}

double BlurredBars::max_defocus() {
  return static_cast<double>(table().size() - 1);
}

BarMaxima BlurredBars::maxima(double width_px, std::size_t direction) const {
  const std::size_t from_axis = std::min(direction % 4, 4 - direction % 4);
  const auto& sharper = table()[sharper_][from_axis];
  const auto& softer = table()[sharper_ + 1][from_axis];
  const double at = std::min(1.0, width_px / widest_px_) * (sharper.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), sharper.size() - 2);
  const double beyond = at - static_cast<double>(k);
  const BarMaxima maxima = between(between(sharper[k], sharper[k + 1], beyond),
                                   between(softer[k], softer[k + 1], beyond),
                                   share_);
  return {width_px > widest_px_ ? width_px : blur_px_ * maxima.distance_px,
          maxima.sharpness / (blur_px_ * blur_px_)};
}

}  // namespace ellipse
