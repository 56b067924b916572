#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/scene/random.hpp"

namespace landing {

// World: x and y horizontal, z up, the platform at z = 0; metres and seconds. Body: x forward, y
// left, z up (REP 103), origin between the feet.

/// Command to the autopilot.
struct Command {
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< In the world [m/s].
  double yaw_rate = 0.0;                    ///< To the left [rad/s].
};

struct Motion {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  ///< [m]
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< [m/s]
  Eigen::Quaterniond world_from_body = Eigen::Quaterniond::Identity();
};

/// Dynamics of a multirotor with its autopilot. Value type.
struct VehicleModel {
  double velocity_lag_s = 0.35;       ///< Of the velocity behind its command.
  double thrust_lag_s = 0.12;         ///< Of the thrust, and thus the tilt.
  double yaw_lag_s = 0.3;             ///< Of the yaw rate.
  double max_acceleration = 4.0;      ///< Maximum that the autopilot requests [m/s^2].
  double drag = 0.25;                 ///< Deceleration per airspeed [1/s].
  double gust = 3.0;                  ///< Root mean square of the horizontal wind [m/s].
  double gust_lag_s = 1.5;            ///< Correlation time of the wind.
  double velocity_error = 0.05;       ///< Constant bias of the autopilot's velocity estimate [m/s].
  double attitude_error_rad = 0.006;  ///< Constant bias of its attitude estimate, per axis.
};

/// A multirotor controlled by velocity commands, in gusty wind.
class Vehicle {
 public:
  /// @param seed  For the wind and the estimation errors.
  Vehicle(const VehicleModel& model,
          const Eigen::Vector3d& position,
          double yaw_rad,
          std::uint64_t seed);

  /// Advances by at most 0.01 s.
  void step(const Command& command, double step_s);

  [[nodiscard]] const Motion& truth() const { return truth_; }

  /// The autopilot's estimate. Its position is dead reckoning and drifts.
  [[nodiscard]] const Motion& estimate() const { return estimate_; }

 private:
  void blow(double step_s);
  void tilt(const Eigen::Vector3d& wanted_thrust, double step_s);
  void update_estimate(double step_s);

  VehicleModel model_;
  ellipse::Random random_;
  Motion truth_;
  Motion estimate_;
  Eigen::Vector3d wind_{0.0, 0.0, 0.0};
  Eigen::Vector3d thrust_;                        // acceleration by the rotors [m/s^2]
  Eigen::Vector3d gust_estimate_{0.0, 0.0, 0.0};  // the autopilot's, as an acceleration [m/s^2]
  Eigen::Vector3d velocity_error_;                // [m/s]
  Eigen::Quaterniond body_from_estimate_;         // attitude error
  double yaw_rad_;
  double yaw_rate_ = 0.0;
};

}  // namespace landing
