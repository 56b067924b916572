// SPDX-License-Identifier: MIT
#include "core/edges/outline_samples.hpp"

#include <algorithm>

namespace ellipse {
namespace {

constexpr std::array<std::size_t, 6> kCounts = {32, 48, 64, 96, 128, 256};

}  // namespace

std::span<const Eigen::Vector2f> circle_directions(std::size_t count) {
  using Circle = std::array<Eigen::Vector2f, OutlineSamples::kMaxSamples>;
  static const auto kCircles = [] {
    std::array<Circle, kCounts.size()> circles{};
    for (std::size_t c = 0; c < kCounts.size(); ++c) {
      for (std::size_t i = 0; i < kCounts[c]; ++i) {
        const double t = kTwoPi * static_cast<double>(i) / double(kCounts[c]);
        circles[c][i] = {static_cast<float>(std::cos(t)), static_cast<float>(std::sin(t))};
      }
    }
    return circles;
  }();
  const auto at = std::lower_bound(kCounts.begin(), kCounts.end() - 1, count);
  return {kCircles[static_cast<std::size_t>(at - kCounts.begin())].data(), count};
}

OutlineSamples::OutlineSamples(const Ellipse& e, std::size_t samples, const LensView& lens)
    : size_(std::min(samples, kMaxSamples)),
      around_(circle_directions(size_)),
      step_rad_(static_cast<float>(kTwoPi / static_cast<double>(size_))),
      axes_product_(static_cast<float>(e.semi_major * e.semi_minor)),
      origin_(static_cast<int>(std::lround(e.cx)), static_cast<int>(std::lround(e.cy))),
      is_distorted_(lens.is_distorted()) {
  const auto ux = static_cast<float>(std::cos(e.angle_rad));
  const auto uy = static_cast<float>(std::sin(e.angle_rad));
  const auto a = static_cast<float>(e.semi_major);
  const auto b = static_cast<float>(e.semi_minor);
  const auto cx = static_cast<float>(e.cx - origin_.x());
  const auto cy = static_cast<float>(e.cy - origin_.y());
  for (std::size_t k = 0; k < size_; ++k) {
    const float c = around_[k].x();
    const float s = around_[k].y();
    x_[k] = cx + a * c * ux - b * s * uy;
    y_[k] = cy + a * c * uy + b * s * ux;
    const float normal_x = b * c * ux - a * s * uy;
    const float normal_y = b * c * uy + a * s * ux;
    speed_[k] = std::sqrt(normal_x * normal_x + normal_y * normal_y);
    nx_[k] = normal_x / speed_[k];
    ny_[k] = normal_y / speed_[k];
  }
  if (is_distorted_) distort(lens);
}

void OutlineSamples::distort(const LensView& lens) {
  PerSample along;
  lens.distort(
      origin_.cast<double>(),
      {size_, x_.data(), y_.data(), nx_.data(), ny_.data(), px_per_ideal_.data(), along.data()});
  for (std::size_t k = 0; k < size_; ++k) {
    ideal_speed_[k] = speed_[k];
    speed_[k] *= along[k];
  }
}

}  // namespace ellipse
