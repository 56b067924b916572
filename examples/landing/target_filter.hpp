#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>

namespace landing {

/// Where the platform is and how it moves, in the world that the vehicle's dead reckoning knows:
/// for each axis a Kalman filter of position, velocity and an acceleration that fades.
class TargetFilter {
 public:
  /// @param position, velocity  A rough knowledge at a time, as by radio [m, m/s].
  /// @param position_error, velocity_error  Its standard deviations, of the level axes.
  TargetFilter(double time_s,
               const Eigen::Vector3d& position,
               const Eigen::Vector2d& velocity,
               double position_error,
               double velocity_error);

  /// Takes in where the pad was seen at a time, not before the last one.
  /// @param error  Standard deviation of each coordinate [m].
  /// @return false where this cannot be the target; then nothing was taken in.
  bool see(double time_s, const Eigen::Vector3d& position, double error);

  /// Takes in where the platform says that it is and how it moves, by radio. Where that cannot be,
  /// what was seen was something else, and is forgotten.
  /// @param is_in_sight  Then it is known better, and not corrected.
  /// @param position_error, velocity_error  Standard deviations of the level coordinates; of the
  ///                                        height nothing is told [m, m/s].
  void hear(double time_s,
            const Eigen::Vector2d& position,
            const Eigen::Vector2d& velocity,
            double position_error,
            double velocity_error,
            bool is_in_sight);

  /// What it would be at a time, not before the last one [m, m/s].
  struct State {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
    Eigen::Vector3d acceleration;
  };
  [[nodiscard]] State at(double time_s) const;

 private:
  struct Axis {
    Eigen::Vector3d mean;  // position, velocity, acceleration
    Eigen::Matrix3d covariance;
    double jerk;  // spectral density of what is not known of it [m^2/s^5]
  };

  [[nodiscard]] static Axis level_axis(double position,
                                       double velocity,
                                       double position_error,
                                       double velocity_error);
  [[nodiscard]] static double surprise(const Axis& axis, double position, double variance);
  static void correct(Axis& axis, Eigen::Index part, double value, double variance);
  void move_to(double time_s);
  void forget_climb();
  [[nodiscard]] static Axis moved(const Axis& axis, double by_s);

  double time_s_;
  std::array<Axis, 3> axes_;
};

}  // namespace landing
