#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

namespace landing {

/// Where the platform drives.
enum class Course { kStraight, kCircle, kFigureOfEight };

/// Their names, in their order.
[[nodiscard]] const char* name_of(Course course);

/// A flat platform that drives over level ground at a constant speed, the pad on it.
class Platform {
 public:
  /// @param speed  [m/s]; 0 = it stands.
  /// @param phase  Where on its course it begins, 0 to 1.
  Platform(Course course, double speed, double phase);

  /// Drives on by a short time: a hundredth of a second at most.
  void step(double step_s);

  [[nodiscard]] const Eigen::Vector2d& position() const { return position_; }  ///< [m]
  [[nodiscard]] const Eigen::Vector2d& velocity() const { return velocity_; }  ///< [m/s]
  [[nodiscard]] double heading_rad() const { return heading_rad_; }            ///< From x to y.

 private:
  [[nodiscard]] Eigen::Vector2d slope(double place) const;

  Course course_;
  double speed_;
  double place_;  // the course's own parameter
  Eigen::Vector2d position_{0.0, 0.0};
  Eigen::Vector2d velocity_{0.0, 0.0};
  double heading_rad_ = 0.0;
};

}  // namespace landing
