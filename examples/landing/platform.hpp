#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

namespace landing {

/// The platform's path.
enum class Course { kStraight, kCircle, kFigureOfEight };

/// The name of a course.
[[nodiscard]] const char* name_of(Course course);

/// A flat platform with the pad, driving over level ground at constant speed.
class Platform {
 public:
  /// @param speed  [m/s]; 0 = stationary.
  /// @param phase  Start position on the course, 0 to 1.
  Platform(Course course, double speed, double phase);

  /// Advances by at most 0.01 s.
  void step(double step_s);

  [[nodiscard]] const Eigen::Vector2d& position() const { return position_; }  ///< [m]
  [[nodiscard]] const Eigen::Vector2d& velocity() const { return velocity_; }  ///< [m/s]
  [[nodiscard]] double heading_rad() const { return heading_rad_; }            ///< From x to y.

 private:
  [[nodiscard]] Eigen::Vector2d slope(double parameter) const;

  Course course_;
  double speed_;
  double parameter_;  // parameter of the course
  Eigen::Vector2d position_{0.0, 0.0};
  Eigen::Vector2d velocity_{0.0, 0.0};
  double heading_rad_ = 0.0;
};

}  // namespace landing
