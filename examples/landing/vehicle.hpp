#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/scene/random.hpp"

namespace landing {

// The world: x and y level, z up, the platform at z = 0; metres and seconds. A vehicle's body:
// x forward, y left, z up (REP 103), its origin between its feet.

/// What the autopilot is asked for.
struct Command {
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< In the world [m/s].
  double yaw_rate = 0.0;                    ///< To the left [rad/s].
};

struct Motion {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  ///< [m]
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< [m/s]
  Eigen::Quaterniond world_from_body = Eigen::Quaterniond::Identity();
};

/// How a multirotor with its autopilot answers. A value.
struct VehicleModel {
  double velocity_lag_s = 0.35;       ///< Of the velocity behind its command.
  double thrust_lag_s = 0.12;         ///< Of the thrust, hence of the tilt, behind its own.
  double yaw_lag_s = 0.3;             ///< Of the yaw rate.
  double most_acceleration = 4.0;     ///< That the autopilot asks for [m/s^2].
  double drag = 0.25;                 ///< Acceleration per speed through the air [1/s].
  double gust = 3.0;                  ///< Root mean square of the level wind [m/s].
  double gust_lag_s = 1.5;            ///< How long a gust lasts.
  double velocity_error = 0.05;       ///< Of the autopilot's own velocity [m/s], constant.
  double attitude_error_rad = 0.006;  ///< Of its attitude, about each axis, constant.
};

/// A multirotor that flies by velocity commands, in gusts.
class Vehicle {
 public:
  /// @param seed  Of its wind, and of what it gets wrong of its motion.
  Vehicle(const VehicleModel& model,
          const Eigen::Vector3d& position,
          double yaw_rad,
          std::uint64_t seed);

  /// Flies on by a short time: a hundredth of a second at most.
  void step(const Command& command, double step_s);

  [[nodiscard]] const Motion& truth() const { return truth_; }

  /// What its autopilot believes: the position is dead reckoning, and drifts.
  [[nodiscard]] const Motion& estimate() const { return estimate_; }

 private:
  void blow(double step_s);
  void tilt(const Eigen::Vector3d& wanted_thrust, double step_s);
  void believe(double step_s);

  VehicleModel model_;
  ellipse::Random random_;
  Motion truth_;
  Motion estimate_;
  Eigen::Vector3d wind_{0.0, 0.0, 0.0};
  Eigen::Vector3d thrust_;                 // acceleration by it [m/s^2]
  Eigen::Vector3d felt_{0.0, 0.0, 0.0};    // acceleration by gusts, as the autopilot feels it
  Eigen::Vector3d velocity_error_;         // [m/s]
  Eigen::Quaterniond body_from_believed_;  // the error of its attitude
  double yaw_rad_;
  double yaw_rate_ = 0.0;
};

}  // namespace landing
