// SPDX-License-Identifier: MIT
#include "examples/landing/target_filter.hpp"

#include <algorithm>
#include <cmath>

namespace landing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFade_s = 4.0;        // time constant of an acceleration
constexpr double kLevelJerk = 1.0;     // [m^2/s^5]
constexpr double kUprightJerk = 1e-5;  // small: the platform drives on level ground
constexpr double kGate = 25.0;         // squared innovation / variance
constexpr double kDoubt = 2.0;         // growth of a position's variance by a rejected one
constexpr double kHeightError = 0.5;   // platform height, standard deviation [m]
constexpr double kHeightDrift = 0.1;   // vertical dead reckoning, standard deviation [m/s]
constexpr double kMaxSpeed = 15.0;     // of any platform [m/s]

}  // namespace

TargetFilter::TargetFilter(double time_s,
                           const Vector3d& position,
                           const Eigen::Vector2d& velocity,
                           double position_error,
                           double velocity_error)
    : time_s_(time_s),
      axes_{level_axis(position.x(), velocity.x(), position_error, velocity_error),
            level_axis(position.y(), velocity.y(), position_error, velocity_error),
            upright_axis(position.z())} {}

TargetFilter::Axis TargetFilter::upright_axis(double height) {
  return {{height, 0.0, 0.0},
          Vector3d(kHeightError, kHeightDrift, 0.01).cwiseAbs2().asDiagonal(),
          kUprightJerk,
          kHeightError};
}

TargetFilter::Axis TargetFilter::level_axis(double position,
                                            double velocity,
                                            double position_error,
                                            double velocity_error) {
  return {{position, velocity, 0.0},
          Vector3d(position_error, velocity_error, 0.5).cwiseAbs2().asDiagonal(),
          kLevelJerk,
          position_error};
}

// Squared innovation divided by its expected variance.
double TargetFilter::normalized_innovation(const Axis& axis, double position, double variance) {
  const double innovation = position - axis.mean[0];
  return innovation * innovation / (axis.covariance(0, 0) + variance);
}

// Kalman update with a measured position (part 0) or velocity (part 1).
void TargetFilter::correct(Axis& axis, Eigen::Index part, double value, double variance) {
  const Vector3d gain = axis.covariance.col(part) / (axis.covariance(part, part) + variance);
  axis.mean += gain * (value - axis.mean[part]);
  axis.mean[1] = std::clamp(axis.mean[1], -kMaxSpeed, kMaxSpeed);
  axis.covariance -= (gain * axis.covariance.row(part)).eval();
}

// Prediction: white jerk, and an exponentially decaying acceleration.
TargetFilter::Axis TargetFilter::moved(const Axis& axis, double by_s) {
  const double t = by_s;
  const double kept = std::exp(-t / kFade_s);
  const double to_velocity = kFade_s * (1.0 - kept);
  Matrix3d step = Matrix3d::Identity();
  step(0, 1) = t;
  step(0, 2) = kFade_s * (t - to_velocity);
  step(1, 2) = to_velocity;
  step(2, 2) = kept;
  const double t2 = t * t;
  const double t3 = t2 * t;
  Matrix3d noise;
  noise << t2 * t3 / 20.0, t2 * t2 / 8.0, t3 / 6.0,  //
      t2 * t2 / 8.0, t3 / 3.0, t2 / 2.0,             //
      t3 / 6.0, t2 / 2.0, t;
  Axis result = axis;
  result.mean = step * axis.mean;
  result.covariance = step * axis.covariance * step.transpose() + axis.jerk * noise;
  return result;
}

void TargetFilter::move_to(double time_s) {
  for (Axis& axis : axes_) axis = moved(axis, time_s - time_s_);
  time_s_ = time_s;
}

bool TargetFilter::see(double time_s, const Vector3d& position, const Vector3d& error) {
  move_to(time_s);
  const Vector3d variance = error.cwiseAbs2();
  if (!position.allFinite() || !variance.allFinite()) return false;
  bool is_outlier = false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (normalized_innovation(axis, position[i], variance[i]) <= kGate) continue;
    double& spread = axis.covariance(0, 0);
    spread = std::max(spread, std::min(kDoubt * spread, axis.prior_error * axis.prior_error));
    is_outlier = true;
  }
  if (is_outlier) return false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    correct(axes_[static_cast<std::size_t>(i)], 0, position[i], variance[i]);
  }
  return true;
}

void TargetFilter::hear(double time_s,
                        const Eigen::Vector2d& position,
                        const Eigen::Vector2d& velocity,
                        double position_error,
                        double velocity_error,
                        bool is_recently_seen) {
  move_to(time_s);
  if (!is_recently_seen) forget_climb();
  const double variance = position_error * position_error;
  for (Eigen::Index i = 0; i < 2; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (normalized_innovation(axis, position[i], variance) > kGate) {
      axis = level_axis(position[i], velocity[i], position_error, velocity_error);
    } else if (!is_recently_seen) {
      correct(axis, 0, position[i], variance);
      correct(axis, 1, velocity[i], velocity_error * velocity_error);
    }
  }
}

// The platform stays on level ground, but the vertical drift may have changed since the last
// detection.
void TargetFilter::forget_climb() {
  Axis& upright = axes_[2];
  const double variance = std::max(upright.covariance(0, 0), kHeightError * kHeightError);
  upright.mean.tail<2>().setZero();
  upright.covariance = Vector3d(std::sqrt(variance), kHeightDrift, 0.01).cwiseAbs2().asDiagonal();
}

TargetFilter::State TargetFilter::at(double time_s) const {
  State state;
  for (int i = 0; i < 3; ++i) {
    const Axis axis = moved(axes_[static_cast<std::size_t>(i)], time_s - time_s_);
    state.position[i] = axis.mean[0];
    state.velocity[i] = axis.mean[1];
    state.acceleration[i] = axis.mean[2];
  }
  return state;
}

}  // namespace landing
