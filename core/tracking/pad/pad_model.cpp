// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/ellipse.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kRadii = 240;             // of the radial profile,
constexpr double kFirstRadius = 0.1;    // from here [radii]
constexpr double kRadiusStep = 0.005;   // in steps of this [radii]
constexpr int kAngles = 128;            // per radius
constexpr int kMinVisible = 12;         // of these
constexpr int kOuterSlack = 14;         // search range to each side of radius 1 [steps]
constexpr double kOuterContrast = 0.6;  // min share of the strongest step near radius 1
constexpr double kInnerContrast = 0.5;  // min share of the outer circle's contrast
constexpr int kApart = 5;               // min distance between circles [steps]
constexpr double kMinAgreement = 0.7;   // min share of angles that show a circle's step
constexpr double kUnknown = -1.0;       // level outside the image

double radius_at(int i) {
  return kFirstRadius + i * kRadiusStep;
}

int index_of(double radius) {
  return static_cast<int>(std::lround((radius - kFirstRadius) / kRadiusStep));
}

// Median brightness along concentric circles.
class RadialProfile {
 public:
  // Both are borrowed.
  RadialProfile(const ImageView& luma, const PadView& view) : luma_(luma), view_(view) {
    const double size_px =
        std::max(1.0, std::floor(view.ideal_from_pad.topLeftCorner<2, 2>().norm()));
    half_width_ = static_cast<int>(std::clamp(2.5 / (kRadiusStep * size_px), 2.0, 8.0));
    for (std::size_t k = 0; k < kAngles; ++k) {
      const double angle = kTwoPi * static_cast<double>(k) / kAngles;
      directions_[k] = {std::cos(angle), std::sin(angle)};
    }
    for (int i = 0; i < kRadii; ++i) medians_[static_cast<std::size_t>(i)] = median(i);
  }

  // Median brightness outside minus inside; 0 if too few angles are visible.
  [[nodiscard]] double strength(int i) const { return std::abs(step(i)); }
  [[nodiscard]] double step(int i) const {
    double sum = 0.0;
    for (int j = 1; j <= half_width_; ++j) {
      if (i - j < 0 || i + j >= kRadii) return 0.0;
      const double outside = *(medians_.begin() + i + j);
      const double inside = *(medians_.begin() + i - j);
      if (outside == kUnknown || inside == kUnknown) return 0.0;
      sum += outside - inside;
    }
    return sum / half_width_;
  }

  // Share of the visible angles with a step of the same sign and at least half the size.
  [[nodiscard]] double agreement(int i) const {
    const double whole = step(i);
    int visible = 0;
    int agreed = 0;
    for (int k = 0; k < kAngles; ++k) {
      const float outside = level(std::min(i + half_width_, kRadii - 1), k);
      const float inside = level(std::max(i - half_width_, 0), k);
      if (outside < 0.0F || inside < 0.0F) continue;
      ++visible;
      agreed += (outside - inside) * whole > 0.5 * whole * whole ? 1 : 0;
    }
    return visible > 0 ? static_cast<double>(agreed) / visible : 0.0;
  }

 private:
  [[nodiscard]] float level(int i, int k) const {
    const double radius = radius_at(i);
    const auto projected = view_.at(radius * *(directions_.begin() + k));
    if (!projected) return static_cast<float>(kUnknown);
    const double x = projected->point.x();
    const double y = projected->point.y();
    if (!(x >= 0.0 && y >= 0.0 && x < luma_.width - 1 && y < luma_.height - 1)) {
      return static_cast<float>(kUnknown);
    }
    return luma_.at(static_cast<float>(x), static_cast<float>(y));
  }

  [[nodiscard]] double median(int i) const {
    std::array<float, kAngles> levels;
    auto end = levels.begin();
    for (int k = 0; k < kAngles; ++k) {
      const float here = level(i, k);
      if (here >= 0.0F) *end++ = here;
    }
    const auto count = end - levels.begin();
    if (count < kMinVisible) return kUnknown;
    std::nth_element(levels.begin(), levels.begin() + count / 2, end);
    return levels[static_cast<std::size_t>(count / 2)];
  }

  const ImageView& luma_;
  const PadView& view_;
  int half_width_ = 2;
  std::array<Eigen::Vector2d, kAngles> directions_;
  std::array<double, kRadii> medians_;
};

bool is_peak(const RadialProfile& profile, int i) {
  bool is_highest = true;
  for (int j = 1; j <= kApart && is_highest; ++j) {
    is_highest = profile.strength(i) > profile.strength(i - j) &&
                 profile.strength(i) >= profile.strength(i + j);
  }
  return is_highest;
}

// The step nearest to the detected edge: the other edge of a thin ring may be as strong.
std::optional<int> outer_circle(const RadialProfile& profile) {
  const int one = index_of(1.0);
  double strongest = 0.0;
  for (int i = one - kOuterSlack; i <= one + kOuterSlack; ++i) {
    strongest = std::max(strongest, profile.strength(i));
  }
  if (strongest < kMinContrast) return std::nullopt;
  const auto is_outer = [&](int i) {
    return profile.strength(i) >= kOuterContrast * strongest && is_peak(profile, i);
  };
  for (int off = 0; off <= kOuterSlack; ++off) {
    if (is_outer(one + off)) return one + off;
    if (is_outer(one - off)) return one - off;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PadModel> learn_circles(const ImageView& luma,
                                      const PadView& view,
                                      double ring_ratio) {
  const RadialProfile profile(luma, view);
  const std::optional<int> found = outer_circle(profile);
  if (!found) return std::nullopt;
  const int outer = *found;
  PadModel model;
  const auto add = [&](int i) {
    model.circles.push_back(
        {radius_at(i) / radius_at(outer), profile.step(i) > 0.0, profile.strength(i)});
  };
  add(outer);
  if (ring_ratio > 0.0) {
    const PadCircle& edge = model.circles.front();
    model.circles.push_back({ring_ratio, !edge.is_bright_outside, edge.contrast, true});
  }
  const int last = index_of(model.circles.back().radius * radius_at(outer));
  for (int i = last - kApart; i >= kApart && model.circles.size() < kMaxCircles; --i) {
    const bool is_strong = profile.strength(i) >= kInnerContrast * profile.strength(outer);
    if (is_strong && is_peak(profile, i) && profile.agreement(i) >= kMinAgreement) add(i);
  }
  return model;
}

}  // namespace ellipse
