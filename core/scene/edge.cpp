// SPDX-License-Identifier: MIT
#include "core/scene/edge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kStepsPerSigma = 256;
constexpr int kTableSize = 2 * static_cast<int>(kStepReach) * kStepsPerSigma;

// Linear interpolation between the entries has an error below 1e-6.
using StepTable = std::array<double, kTableSize + 2>;

StepTable make_step_table() {
  StepTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double sigmas = static_cast<double>(i) / kStepsPerSigma - kStepReach;
    table[i] = 0.5 * std::erfc(sigmas / std::numbers::sqrt2);
  }
  return table;
}

const StepTable kStepTable = make_step_table();

}  // namespace

double blurred_step(double sigmas) {
  const double position = (sigmas + kStepReach) * kStepsPerSigma;
  if (!(position > 0.0)) return 1.0;
  if (position >= kTableSize) return 0.0;
  const auto i = static_cast<std::size_t>(position);
  return std::lerp(kStepTable[i], kStepTable[i + 1], position - static_cast<double>(i));
}

StraightEdge project_half_plane(const Matrix3d& plane_from_image,
                                const Vector2d& normal,
                                double offset) {
  const Vector3d line = plane_from_image.transpose() * Vector3d(normal.x(), normal.y(), -offset);
  // A line at infinity has no normal: the half plane is everything, or nothing.
  const double length = std::max(line.head<2>().norm(), 1e-12 * std::abs(line.z()));
  return {length > 0.0 ? Vector3d(line / length) : line};
}

bool Band::is_clear_of(const Vector2d& pixel, double reach_px) const {
  return std::abs(outer.distance_px(pixel)) > reach_px &&
         std::abs(inner.distance_px(pixel)) > reach_px;
}

Band project_band(const Matrix3d& plane_from_image,
                  const Vector2d& normal,
                  double center,
                  double half_width) {
  return {project_half_plane(plane_from_image, normal, center + half_width),
          project_half_plane(plane_from_image, normal, center - half_width)};
}

Box project_box(const Matrix3d& plane_from_image,
                const Vector2d& center,
                const Vector2d& along,
                double half_length,
                double half_width) {
  const Vector2d across(-along.y(), along.x());
  return {project_band(plane_from_image, along, along.dot(center), half_length),
          project_band(plane_from_image, across, across.dot(center), half_width)};
}

CircularEdge::CircularEdge(const Matrix3d& plane_from_image, double radius) : radius_(radius) {
  const Vector3d circle(1.0, 1.0, -radius * radius);
  conic_ = plane_from_image.transpose() * circle.asDiagonal() * plane_from_image;
}

double CircularEdge::coverage(const Vector2d& pixel, double blur_px) const {
  const Vector3d half_gradient = conic_ * pixel.homogeneous();
  const double value = half_gradient.dot(pixel.homogeneous());
  const Vector2d gradient = 2.0 * half_gradient.head<2>();
  const double slope = gradient.norm();
  if (!(slope > 0.0)) return value < 0.0 ? 1.0 : 0.0;

  // Along the gradient the conic is a parabola; its root is the distance to the edge.
  const Vector2d normal = gradient / slope;
  const double second_derivative = 2.0 * normal.dot(conic_.topLeftCorner<2, 2>() * normal);
  const double discriminant = slope * slope - 2.0 * second_derivative * value;
  if (!(discriminant > 0.0)) return value < 0.0 ? 1.0 : 0.0;
  const double slope_at_edge = std::sqrt(discriminant);
  const double distance = 2.0 * value / (slope + slope_at_edge);

  // Blur shifts a curved edge inwards by sigma^2 curvature / 2, to second order.
  const Vector2d tangent(-normal.y(), normal.x());
  const double curvature =
      2.0 * tangent.dot(conic_.topLeftCorner<2, 2>() * tangent) / slope_at_edge;
  return blurred_step(distance / blur_px + 0.5 * blur_px * curvature);
}

}  // namespace ellipse
