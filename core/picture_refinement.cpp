// SPDX-License-Identifier: MIT
#include "core/picture_refinement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/ellipse_fit.hpp"

namespace ellipse {
namespace {

constexpr int kReach = 2;   // pixels to both sides
constexpr int kBorder = 3;  // of the 5 x 5 kernels and the parabola
constexpr double kLeastCosine = 0.87;
constexpr std::size_t kLeastPoints = 12;
constexpr std::array<double, 2> kTukeyReach = {2.0, 1.0};  // [px]

bool is_inside(const ImageView& luma, const Eigen::Vector2d& place) {
  const double margin = kReach + 1 + kBorder;
  return place.x() >= margin && place.y() >= margin && place.x() <= luma.width - 1 - margin &&
         place.y() <= luma.height - 1 - margin;
}

struct Crest {
  Eigen::Vector2d point;
  double height;  // of the gradient, along the normal
};

// Where the gradient has its crest across an ellipse's perimeter; nullopt where there is none.
std::optional<Crest> crest_across(const ImageView& luma,
                                  const Eigen::Vector2d& foot,
                                  const Eigen::Vector2d& to_bright,
                                  double least_gradient) {
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
  if (*top < least_gradient || *top < kLeastCosine * strength) return std::nullopt;
  const double curvature = heights[i - 1] - 2.0 * heights[i] + heights[i + 1];
  if (!(curvature < 0.0)) return std::nullopt;
  const double offset = std::clamp(0.5 * (heights[i - 1] - heights[i + 1]) / curvature, -0.7, 0.7);
  const double along = static_cast<double>(i) + first + offset;
  return Crest{{x + (is_flat ? along : 0.0), y + (is_flat ? 0.0 : along)}, *top};
}

}  // namespace

std::optional<RefinedEllipse> refined_on_picture(
    const ImageView& luma, const Ellipse& e, Polarity polarity, double least_gradient, int places) {
  places = std::min(places, kMostPlaces);
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d across(-axis.y(), axis.x());
  const double sign = static_cast<int>(polarity);
  std::array<Eigen::Vector2d, kMostPlaces> points;
  std::array<double, kMostPlaces> lengths{};
  std::size_t count = 0;
  int inside = 0;
  double heights = 0.0;
  const double step = 2.0 * std::numbers::pi / places;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(step).toRotationMatrix();
  Eigen::Vector2d anomaly(1.0, 0.0);
  for (int i = 0; i < places; ++i, anomaly = turn * anomaly) {
    const double u = anomaly.x();
    const double v = anomaly.y();
    const Eigen::Vector2d foot = e.center() + e.semi_major * u * axis + e.semi_minor * v * across;
    if (!is_inside(luma, foot)) continue;
    ++inside;
    const Eigen::Vector2d slope = e.semi_minor * u * axis + e.semi_major * v * across;
    const double speed = slope.norm();
    const Eigen::Vector2d normal = slope / speed;
    const auto crest = crest_across(luma, foot, sign * normal, least_gradient);
    if (!crest) continue;
    const double curvature = e.semi_major * e.semi_minor / (speed * speed * speed);
    points[count] = crest->point + kCrestShift * curvature * normal;
    lengths[count++] = speed * step;
    heights += crest->height;
  }
  if (count < kLeastPoints) return std::nullopt;

  Ellipse refined = e;
  for (const double reach : kTukeyReach) {
    GeometricFit fit(refined);
    for (std::size_t i = 0; i < count; ++i) {
      const PerimeterOffset offset = fit.offset_of(points[i]);
      const double weight = lengths[i] * tukey_weight(offset.distance_px, reach);
      if (weight > 0.0) fit.add(offset, weight);
    }
    const auto better = fit.solve();
    if (!better) return std::nullopt;
    refined = *better;
  }
  const auto crests = static_cast<double>(count);
  return RefinedEllipse{refined, crests / inside, heights / crests};
}

}  // namespace ellipse
