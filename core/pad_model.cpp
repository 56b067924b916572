// SPDX-License-Identifier: MIT
#include "core/pad_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kRadii = 240;
constexpr double kFirstRadius = 0.1;
constexpr double kRadiusStep = 0.005;
constexpr int kAngles = 128;
constexpr std::size_t kLeastSeen = 12;   // of the angles
constexpr double kStepPx = 2.5;          // of the averages on both sides of a step
constexpr int kOuterSlack = 14;          // steps to both sides of radius 1
constexpr double kLeastContrast = 6.0;   // of the outer circle [grey levels]
constexpr double kInnerContrast = 0.5;   // of the outer circle's
constexpr int kApart = 5;                // steps between circles
constexpr double kLeastAgreement = 0.7;  // of the angles with a circle's own step
constexpr double kUnknown = -1.0;

double radius_at(int i) {
  return kFirstRadius + i * kRadiusStep;
}

std::size_t index(int radius, int angle) {
  return static_cast<std::size_t>(radius * kAngles + angle);
}

float level_at(const ImageView& luma, const Eigen::Matrix3d& view, double radius, int k) {
  const double angle = 2.0 * std::numbers::pi * k / kAngles;
  const Eigen::Vector3d seen =
      view * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 1.0);
  const double x = seen.x() / seen.z();
  const double y = seen.y() / seen.z();
  if (!(seen.z() > 0.0) || !(x >= 0.0 && y >= 0.0 && x < luma.width - 1 && y < luma.height - 1)) {
    return static_cast<float>(kUnknown);
  }
  return luma.at(static_cast<float>(x), static_cast<float>(y));
}

}  // namespace

double CircleLearner::median(int radius) {
  seen_.clear();
  for (int k = 0; k < kAngles; ++k) {
    if (levels_[index(radius, k)] >= 0.0F) seen_.push_back(levels_[index(radius, k)]);
  }
  if (seen_.size() < kLeastSeen) return kUnknown;
  const auto middle = seen_.begin() + std::ptrdiff_t(seen_.size() / 2);
  std::nth_element(seen_.begin(), middle, seen_.end());
  return *middle;
}

// Outside less inside, in the median over the angles; 0 where too little is seen.
double CircleLearner::step(int radius) const {
  double sum = 0.0;
  for (int j = 1; j <= half_width_; ++j) {
    if (radius - j < 0 || radius + j >= kRadii) return 0.0;
    const double outside = medians_[static_cast<std::size_t>(radius + j)];
    const double inside = medians_[static_cast<std::size_t>(radius - j)];
    if (outside == kUnknown || inside == kUnknown) return 0.0;
    sum += outside - inside;
  }
  return sum / half_width_;
}

// Share of the angles with a step of the same sign and half the size.
double CircleLearner::agreement(int radius) const {
  const double whole = step(radius);
  int seen = 0;
  int agreed = 0;
  for (int k = 0; k < kAngles; ++k) {
    const float outside = levels_[index(std::min(radius + half_width_, kRadii - 1), k)];
    const float inside = levels_[index(std::max(radius - half_width_, 0), k)];
    if (outside < 0.0F || inside < 0.0F) continue;
    ++seen;
    agreed += (outside - inside) * whole > 0.5 * whole * whole ? 1 : 0;
  }
  return seen > 0 ? static_cast<double>(agreed) / seen : 0.0;
}

bool CircleLearner::learn(const ImageView& luma,
                          const Eigen::Matrix3d& image_from_pad,
                          PadModel& model) {
  levels_.resize(std::size_t(kRadii) * kAngles);
  medians_.resize(kRadii);
  seen_.reserve(kAngles);
  const double px_per_radius = image_from_pad.topLeftCorner<2, 2>().norm();
  half_width_ = static_cast<int>(
      std::clamp(kStepPx / (kRadiusStep * std::max(1.0, px_per_radius)), 2.0, 8.0));
  for (int i = 0; i < kRadii; ++i) {
    for (int k = 0; k < kAngles; ++k) {
      levels_[index(i, k)] = level_at(luma, image_from_pad, radius_at(i), k);
    }
    medians_[static_cast<std::size_t>(i)] = median(i);
  }
  const auto strength = [&](int i) { return std::abs(step(i)); };
  const int one = static_cast<int>(std::lround((1.0 - kFirstRadius) / kRadiusStep));
  int outer = one;
  for (int i = one - kOuterSlack; i <= one + kOuterSlack; ++i) {
    if (strength(i) > strength(outer)) outer = i;
  }
  if (strength(outer) < kLeastContrast) return false;

  model.circles.clear();
  model.circles.reserve(kMostCircles);
  model.lines.clear();
  const auto add = [&](int i) {
    model.circles.push_back({radius_at(i) / radius_at(outer), step(i) > 0.0, strength(i)});
  };
  add(outer);
  for (int i = outer - kApart; i >= kApart && model.circles.size() < kMostCircles; --i) {
    bool is_peak = strength(i) >= kInnerContrast * strength(outer);
    for (int j = 1; j <= kApart && is_peak; ++j) {
      is_peak = strength(i) > strength(i - j) && strength(i) >= strength(i + j);
    }
    if (is_peak && agreement(i) >= kLeastAgreement) add(i);
  }
  return true;
}

}  // namespace ellipse
