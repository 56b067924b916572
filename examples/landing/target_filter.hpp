#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>

namespace landing {

/// Estimates the platform's motion in the vehicle's dead-reckoning frame: one Kalman filter per
/// axis with position, velocity and a decaying acceleration.
class TargetFilter {
 public:
  /// @param position, velocity  Rough prior, for example by radio [m, m/s].
  /// @param position_error, velocity_error  Standard deviations of the horizontal axes.
  TargetFilter(double time_s,
               const Eigen::Vector3d& position,
               const Eigen::Vector2d& velocity,
               double position_error,
               double velocity_error);

  /// Updates with a detection, in order of time. An outlier is rejected and casts doubt on the
  /// state, too: the uncertainty of the coordinates that it contradicts grows, at most to that
  /// without a picture. So the filter recovers from wrong detections.
  /// @param error  Standard deviations of the coordinates [m].
  /// @return false if it is rejected, or not finite.
  bool see(double time_s, const Eigen::Vector3d& position, const Eigen::Vector3d& error);

  /// Updates with a radio report of position and velocity. A report that contradicts the state
  /// resets it, because the detections must have been of another object.
  /// @param is_recently_seen  The target was detected recently. The estimate is then more accurate
  /// than radio and is not corrected.
  /// @param position_error, velocity_error  Standard deviations of the horizontal coordinates [m,
  /// m/s]. The report contains no height.
  void hear(double time_s,
            const Eigen::Vector2d& position,
            const Eigen::Vector2d& velocity,
            double position_error,
            double velocity_error,
            bool is_recently_seen);

  /// The predicted state at a time not before the last update [m, m/s].
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
    double jerk;         // spectral density of the unmodelled jerk [m^2/s^5]
    double prior_error;  // standard deviation of the position without a picture [m]
  };

  [[nodiscard]] static Axis upright_axis(double height);
  [[nodiscard]] static Axis level_axis(double position,
                                       double velocity,
                                       double position_error,
                                       double velocity_error);
  [[nodiscard]] static double normalized_innovation(const Axis& axis,
                                                    double position,
                                                    double variance);
  static void correct(Axis& axis, Eigen::Index part, double value, double variance);
  void move_to(double time_s);
  void forget_climb();
  [[nodiscard]] static Axis moved(const Axis& axis, double by_s);

  double time_s_;
  std::array<Axis, 3> axes_;
};

}  // namespace landing
