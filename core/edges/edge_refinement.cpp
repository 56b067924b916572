// SPDX-License-Identifier: MIT
#include "core/edges/edge_refinement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

constexpr int kReach = 2;   // pixels to both sides
constexpr int kBorder = 3;  // of the 5 x 5 kernels and the parabola
constexpr double kMinCosine = 0.87;
constexpr std::size_t kMinPoints = 12;
constexpr double kMinVariance = 1e-4;                      // of a maximum's position [px^2]
constexpr std::array<double, 2> kTukeyReach = {2.0, 1.0};  // [px]

bool is_inside(const ImageView& luma, const Eigen::Vector2d& place) {
  const double margin = kReach + 1 + kBorder;
  return place.x() >= margin && place.y() >= margin && place.x() <= luma.width - 1 - margin &&
         place.y() <= luma.height - 1 - margin;
}

struct Maximum {
  Eigen::Vector2d point;
  double height;  // of the gradient, along the normal
};

// The gradient maximum across an ellipse's perimeter; nullopt where there is none.
std::optional<Maximum> maximum_across(const ImageView& luma,
                                      const Eigen::Vector2d& foot,
                                      const Eigen::Vector2d& to_bright,
                                      double min_gradient) {
  const bool is_flat = std::abs(to_bright.x()) > std::abs(to_bright.y());
  const int x = static_cast<int>(std::floor(foot.x() + 0.5));
  const int y = static_cast<int>(std::floor(foot.y() + 0.5));
  const int first = -kReach - 1;
  std::array<Gradient, 2 * kReach + 3> gradients;
  gradients_along(luma, x + (is_flat ? first : 0), y + (is_flat ? 0 : first), is_flat, gradients);
  std::array<double, 2 * kReach + 3> heights{};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = gradients[i].x * to_bright.x() + gradients[i].y * to_bright.y();
  }
  const auto top = std::max_element(heights.begin() + 1, heights.end() - 1);
  const auto i = static_cast<std::size_t>(top - heights.begin());
  const double strength = Eigen::Vector2d(gradients[i].x, gradients[i].y).norm();
  if (*top < min_gradient || *top < kMinCosine * strength) return std::nullopt;
  const double curvature = heights[i - 1] - 2.0 * heights[i] + heights[i + 1];
  if (!(curvature < 0.0)) return std::nullopt;
  const double offset = std::clamp(0.5 * (heights[i - 1] - heights[i + 1]) / curvature, -0.7, 0.7);
  const double along = static_cast<double>(i) + first + offset;
  return Maximum{{x + (is_flat ? along : 0.0), y + (is_flat ? 0.0 : along)}, *top};
}

// Samples around an ellipse of the ideal plane, in the picture. Coordinates are relative to the
// ellipse's centre, so that single precision suffices.
class SamplesAround {
 public:
  SamplesAround(const Ellipse& e, int count, const LensView& lens)
      : center_(e.center()),
        axes_product_(e.semi_major * e.semi_minor),
        step_(2.0 * std::numbers::pi / count),
        size_(static_cast<std::size_t>(count)) {
    const Eigen::Matrix2d axes = Eigen::Rotation2Dd(e.angle_rad).toRotationMatrix();
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(step_).toRotationMatrix();
    Eigen::Vector2d anomaly(1.0, 0.0);
    for (std::size_t k = 0; k < size_; ++k, anomaly = turn * anomaly) {
      const Eigen::Vector2d foot =
          axes * anomaly.cwiseProduct(Eigen::Vector2d(e.semi_major, e.semi_minor));
      const Eigen::Vector2d slope =
          axes * anomaly.cwiseProduct(Eigen::Vector2d(e.semi_minor, e.semi_major));
      const double speed = slope.norm();
      x_[k] = static_cast<float>(foot.x());
      y_[k] = static_cast<float>(foot.y());
      nx_[k] = static_cast<float>(slope.x() / speed);
      ny_[k] = static_cast<float>(slope.y() / speed);
      speed_[k] = static_cast<float>(speed);
      across_[k] = 1.0F;
      along_[k] = 1.0F;
    }
    lens.distort(
        center_,
        {size_, x_.data(), y_.data(), nx_.data(), ny_.data(), across_.data(), along_.data()});
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Eigen::Vector2d foot(std::size_t k) const {
    return center_ + Eigen::Vector2d(x_[k], y_[k]);
  }
  [[nodiscard]] Eigen::Vector2d normal(std::size_t k) const { return {nx_[k], ny_[k]}; }
  // Pixels of the picture per pixel of the ideal plane, across the perimeter.
  [[nodiscard]] double px_per_ideal(std::size_t k) const { return across_[k]; }
  // Of the perimeter that a place stands for.
  [[nodiscard]] double length_px(std::size_t k) const {
    return static_cast<double>(along_[k]) * speed_[k] * step_;
  }
  // Of the perimeter; what the lens itself distorts is far less.
  [[nodiscard]] double curvature(std::size_t k) const {
    const double speed = static_cast<double>(speed_[k]) * along_[k];
    return axes_product_ / (speed * speed * speed_[k]) * across_[k];
  }

 private:
  using PerSampleOf = std::array<float, kMaxRefinementSamples>;

  Eigen::Vector2d center_;
  double axes_product_;
  double step_;
  std::size_t size_;
  PerSampleOf x_;
  PerSampleOf y_;
  PerSampleOf nx_;
  PerSampleOf ny_;
  PerSampleOf speed_;  // length per eccentric anomaly, in the ideal plane
  PerSampleOf across_;
  PerSampleOf along_;
};

// A gradient maximum, taken to the ideal plane.
struct FoundPoint {
  Eigen::Vector2d ideal;
  double px_per_ideal;  // pixels of the picture per one there, across the perimeter
  double length_px;     // of the perimeter that it stands for
};

// A distance from the perimeter is one of the picture.
PerimeterOffset scaled(PerimeterOffset offset, double px_per_ideal) {
  offset.distance_px *= px_per_ideal;
  offset.px_per_unit *= px_per_ideal;
  return offset;
}

}  // namespace

std::optional<RefinedEllipse> refined_on_picture(const ImageView& luma,
                                                 const Ellipse& e,
                                                 Polarity polarity,
                                                 double min_gradient,
                                                 int places,
                                                 const LensView& lens) {
  places = std::min(places, kMaxRefinementSamples);
  const double sign = static_cast<int>(polarity);
  std::array<FoundPoint, kMaxRefinementSamples> points;
  std::size_t count = 0;
  int inside = 0;
  double heights = 0.0;
  const SamplesAround around(e, places, lens);
  for (std::size_t k = 0; k < around.size(); ++k) {
    const Eigen::Vector2d foot = around.foot(k);
    if (!is_inside(luma, foot)) continue;
    ++inside;
    const auto maximum = maximum_across(luma, foot, sign * around.normal(k), min_gradient);
    if (!maximum) continue;
    const Eigen::Vector2d edge =
        maximum->point + kMaximumShift * around.curvature(k) * around.normal(k);
    points[count++] = {lens.near_ideal(edge), around.px_per_ideal(k), around.length_px(k)};
    heights += maximum->height;
  }
  if (count < kMinPoints) return std::nullopt;

  Ellipse refined = e;
  RingUncertainty uncertainty{};
  for (const double reach : kTukeyReach) {
    GeometricFit fit(refined);
    double squares = kMinVariance;
    double weights = 1.0;
    for (std::size_t i = 0; i < count; ++i) {
      const PerimeterOffset offset = scaled(fit.offset_of(points[i].ideal), points[i].px_per_ideal);
      const double weight = points[i].length_px * tukey_weight(offset.distance_px, reach);
      if (!(weight > 0.0)) continue;
      fit.add(offset, weight);
      squares += weight * offset.distance_px * offset.distance_px;
      weights += weight;
    }
    const double spacing_px = weights / static_cast<double>(count);
    const double independent_px = std::max(kIndependentPx, spacing_px);
    uncertainty = {image_from_pad(refined), weights / squares / independent_px * fit.information()};
    const auto better = fit.solve();
    if (!better) return std::nullopt;
    refined = *better;
  }
  const auto maxima = static_cast<double>(count);
  return RefinedEllipse{refined, uncertainty, maxima / inside, heights / maxima};
}

}  // namespace ellipse
