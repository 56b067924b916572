// SPDX-License-Identifier: MIT
#include "examples/landing/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "examples/landing/noise.hpp"

namespace landing {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kUp = Vector3d::UnitZ();
constexpr double kGravity = 9.81;
constexpr double kGustDelay_s = 0.5;    // time constant of the autopilot's gust estimate
constexpr double kMinLift = 4.0;        // minimum upward thrust [m/s^2]; prevents a flip
constexpr double kVerticalShare = 0.3;  // vertical fraction of the gusts

Vector3d limited(const Vector3d& value, double max_norm) {
  const double size = value.norm();
  return size > max_norm ? Vector3d(value * (max_norm / size)) : value;
}

}  // namespace

Vehicle::Vehicle(const VehicleModel& model,
                 const Vector3d& position,
                 double yaw_rad,
                 std::uint64_t seed)
    : model_(model), random_(seed), thrust_(kGravity * kUp), yaw_rad_(yaw_rad) {
  truth_.position = position;
  truth_.world_from_body = AngleAxisd(yaw_rad, kUp);
  velocity_error_ = model.velocity_error * normal_vector(random_);
  const Vector3d turn = model.attitude_error_rad * normal_vector(random_);
  const double angle = turn.norm();
  body_from_estimate_ =
      angle > 0.0 ? Quaterniond(AngleAxisd(angle, turn / angle)) : Quaterniond::Identity();
  estimate_.position = position;
  update_estimate(0.0);
}

void Vehicle::step(const Command& command, double step_s) {
  blow(step_s);
  const Vector3d off = command.velocity - estimate_.velocity;
  const Vector3d wanted = limited(off / model_.velocity_lag_s, model_.max_acceleration);
  gust_estimate_ += (model_.drag * wind_ - gust_estimate_) * std::min(1.0, step_s / kGustDelay_s);
  tilt(wanted - gust_estimate_ + model_.drag * estimate_.velocity + kGravity * kUp, step_s);
  yaw_rate_ += (command.yaw_rate - yaw_rate_) * std::min(1.0, step_s / model_.yaw_lag_s);
  yaw_rad_ += yaw_rate_ * step_s;

  const Vector3d acceleration = thrust_ - kGravity * kUp + model_.drag * (wind_ - truth_.velocity);
  truth_.position += step_s * (truth_.velocity + 0.5 * step_s * acceleration);
  truth_.velocity += step_s * acceleration;
  update_estimate(step_s);
}

// Ornstein-Uhlenbeck process; its variance does not depend on the step.
void Vehicle::blow(double step_s) {
  const double kept = std::exp(-step_s / model_.gust_lag_s);
  const double level = model_.gust / std::sqrt(2.0);  // per horizontal axis
  const Vector3d size(level, level, kVerticalShare * model_.gust);
  wind_ = kept * wind_ + std::sqrt(1.0 - kept * kept) * size.cwiseProduct(normal_vector(random_));
}

// Thrust acts along the body's z axis, so horizontal acceleration requires tilt.
void Vehicle::tilt(const Vector3d& wanted_thrust, double step_s) {
  Vector3d wanted = wanted_thrust;
  wanted.z() = std::max(wanted.z(), kMinLift);
  thrust_ += (wanted - thrust_) * std::min(1.0, step_s / model_.thrust_lag_s);
  truth_.world_from_body = Quaterniond::FromTwoVectors(kUp, thrust_.normalized()) *
                           Quaterniond(AngleAxisd(yaw_rad_, kUp));
}

void Vehicle::update_estimate(double step_s) {
  estimate_.velocity = truth_.velocity + velocity_error_;
  estimate_.position += step_s * estimate_.velocity;
  estimate_.world_from_body = truth_.world_from_body * body_from_estimate_;
}

}  // namespace landing
