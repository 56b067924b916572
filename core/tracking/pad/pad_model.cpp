// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/camera/circle_pose.hpp"
#include "core/edges/noise.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kRadiusStep = 0.005;   // of the radial profile [radii]
constexpr int kAngles = 128;            // per radius
constexpr int kApart = 5;               // min distance between circles [steps]
constexpr double kDeformation = 0.012;  // distance of deformed edges from the model [radii]

double radius_at(int i) {
  return i * kRadiusStep;
}

int index_of(double radius) {
  return static_cast<int>(std::lround(radius / kRadiusStep));
}

// Median brightness along concentric circles.
class RadialProfile {
 public:
  // Both are borrowed.
  RadialProfile(const ImageView& luma, const PadView& view) : luma_(luma), view_(view) {
    const auto directions = circle_directions(kAngles);
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      rays_[k] = view.ideal_from_pad.leftCols<2>() * directions[k].cast<double>();
    }
    for (std::size_t i = 0; i < medians_.size(); ++i) medians_[i] = median(static_cast<int>(i));
  }

  // Magnitude of the step.
  [[nodiscard]] double strength(int i) const { return std::abs(step(i)); }
  // Median brightness outside minus inside; 0 if it is unknown.
  [[nodiscard]] double step(int i) const {
    double sum = 0.0;
    for (int j = 1; j <= kApart; ++j) {
      if (i - j < 0 || i + j >= std::ssize(medians_)) return 0.0;
      const double outside = *(medians_.begin() + i + j);
      const double inside = *(medians_.begin() + i - j);
      sum += outside - inside;
    }
    return std::isnan(sum) ? 0.0 : sum / kApart;
  }

  // Share of the visible angles with a step of the same sign and at least half the size.
  [[nodiscard]] double agreement(int i) const {
    const double whole = step(i);
    int visible = 0;
    int agreed = 0;
    for (const Eigen::Vector3d& ray : rays_) {
      const float outside = level(std::min(i + kApart, static_cast<int>(medians_.size()) - 1), ray);
      const float inside = level(std::max(i - kApart, 0), ray);
      const float rise = outside - inside;
      if (std::isnan(rise)) continue;
      ++visible;
      agreed += rise * whole > kMajority * whole * whole ? 1 : 0;
    }
    return visible > 0 ? static_cast<double>(agreed) / visible : 0.0;
  }

 private:
  // NaN outside the image.
  [[nodiscard]] float level(int i, const Eigen::Vector3d& ray) const {
    return view_.level_at(luma_, view_.ideal_from_pad.col(2) + radius_at(i) * ray);
  }

  // NaN if no angle is visible.
  [[nodiscard]] double median(int i) const {
    std::array<float, kAngles> levels;
    auto end = levels.begin();
    for (const Eigen::Vector3d& ray : rays_) {
      const float here = level(i, ray);
      if (!std::isnan(here)) *end++ = here;
    }
    if (end == levels.begin()) return std::numeric_limits<double>::quiet_NaN();
    return ellipse::median(std::span(levels.begin(), end));
  }

  const ImageView& luma_;
  const PadView& view_;
  std::array<Eigen::Vector3d, kAngles> rays_;  // unit vectors of the pad, projected
  std::array<double, 250> medians_;            // from radius 0
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
std::optional<int> outer_circle(const RadialProfile& profile, double noise) {
  const int one = index_of(1.0);
  const int reach = index_of(kSameTarget.relative);
  double strongest = 0.0;
  for (int i = one - reach; i <= one + reach; ++i) {
    strongest = std::max(strongest, profile.strength(i));
  }
  if (strongest < kUnlikelySigmas * noise) return std::nullopt;
  const auto is_outer = [&](int i) {
    return profile.strength(i) >= kMajority * strongest && is_peak(profile, i);
  };
  for (int off = 0; off <= reach; ++off) {
    if (is_outer(one + off)) return one + off;
    if (is_outer(one - off)) return one - off;
  }
  return std::nullopt;
}

}  // namespace

double match_tolerance_px(double radius_px) {
  return kUnlikelySigmas * kEdgeSigmaPx + kDeformation * radius_px;
}

std::optional<PadModel> learn_circles(const ImageView& luma,
                                      const PadView& view,
                                      double ring_ratio,
                                      double min_apart) {
  const RadialProfile profile(luma, view);
  const std::optional<int> found = outer_circle(profile, pixel_noise(luma));
  if (!found) return std::nullopt;
  const int outer = *found;
  if (profile.agreement(outer) < kMinCoverage) return std::nullopt;  // no single polarity
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
    const bool is_strong = profile.strength(i) >= kMajority * profile.strength(outer);
    if (!is_strong || !is_peak(profile, i) || profile.agreement(i) < kMinCoverage) continue;
    const PadCircle& previous = model.circles.back();
    const bool is_other_way = previous.is_bright_outside != (profile.step(i) > 0.0);
    const double apart = previous.radius - radius_at(i) / radius_at(outer);
    if (is_other_way || apart >= min_apart) add(i);
  }
  return model;
}

std::optional<LearnedPad> learn_pad(const Picture& picture,
                                    const Ellipse& outer_edge,
                                    const std::optional<Camera>& camera,
                                    double ring_ratio) {
  std::array<Eigen::Matrix3d, 3> views;
  std::size_t count = 0;
  views[count++] = image_from_pad(outer_edge);
  const auto poses = camera ? circle_poses(*camera, outer_edge) : std::nullopt;
  if (poses) {
    for (const CirclePose& pose : *poses) {
      const Eigen::Matrix3d view = image_from_pad(*camera, pose);
      views[count++] = view / view(2, 2);
    }
  }
  std::optional<LearnedPad> best;
  double max_contrast = 0.0;
  for (const Eigen::Matrix3d& frame_view : std::span(views.data(), count)) {
    const PadView view = PadView::in(picture, frame_view);
    const double min_apart = match_tolerance_px(view.radius_px()) / view.radius_px();
    auto model = learn_circles(picture.luma, view, ring_ratio, min_apart);
    if (!model) continue;
    double contrast = 0.0;
    for (const PadCircle& circle : model->circles) contrast += circle.contrast;
    if (contrast <= max_contrast) continue;
    max_contrast = contrast;
    best = {std::move(*model), frame_view};
  }
  return best;
}

PadLine* line_of(PadModel& model, int feature) {
  const int line = feature - static_cast<int>(model.circles.size());
  if (line < 0 || line >= static_cast<int>(model.lines.size())) return nullptr;
  return &model.lines[static_cast<std::size_t>(line)];
}

}  // namespace ellipse
