// SPDX-License-Identifier: MIT
#include "examples/landing/platform.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace landing {
namespace {

using Eigen::Vector2d;

constexpr double kCircleRadius = 15.0;  // [m]
constexpr double kEightReach = 40.0;    // from the centre to either end; min radius 8.35 m [m]

}  // namespace

const char* name_of(Course course) {
  constexpr std::array kNames = {"straight", "circle", "eight"};
  return kNames.at(static_cast<std::size_t>(course));
}

Platform::Platform(Course course, double speed, double phase)
    : course_(course), speed_(speed), parameter_(2.0 * std::numbers::pi * phase) {
  step(0.0);
}

// Derivative of the position with respect to the course's parameter. The figure of eight is the
// lemniscate of Gerono.
Vector2d Platform::slope(double parameter) const {
  switch (course_) {
    case Course::kCircle:
      return kCircleRadius * Vector2d(-std::sin(parameter), std::cos(parameter));
    case Course::kFigureOfEight:
      return kEightReach * Vector2d(std::cos(parameter), std::cos(2.0 * parameter));
    case Course::kStraight:
      break;
  }
  return {1.0, 0.0};
}

void Platform::step(double step_s) {
  const double half = parameter_ + 0.5 * step_s * speed_ / slope(parameter_).norm();
  const Vector2d along = slope(half);
  const double share = step_s * speed_ / along.norm();
  position_ += share * along;
  parameter_ += share;
  const Vector2d ahead = slope(parameter_);
  velocity_ = speed_ * ahead.normalized();
  heading_rad_ = std::atan2(ahead.y(), ahead.x());
}

}  // namespace landing
