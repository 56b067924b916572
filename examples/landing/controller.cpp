// SPDX-License-Identifier: MIT
#include "examples/landing/controller.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace landing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMinConsecutive = 4;           // consecutive detections before the target is trusted
constexpr double kMinVisibleToStart = 0.6;   // visible fraction of the outline
constexpr double kLost_s = 1.0;              // max. time without detection, except in the descent
constexpr double kRecent_s = 2.0;            // after a detection, without correction by radio
constexpr double kSpiralGrowth = 0.5;        // growth of the search spiral [m/s]
constexpr double kSpiralSpeed = 1.5;         // speed along the spiral [m/s]
constexpr double kSweepRate = 0.5;           // of the search height [rad/s]
constexpr double kMaxSpiralRadius = 3.0;     // [m]
constexpr double kTouchDownSpeed = 0.8;      // [m/s]
constexpr double kMaxDrift = 1.2;            // safe relative speed near the ground [m/s]
constexpr double kMinSpeedForHeading = 0.5;  // below it the direction of motion is not used [m/s]

}  // namespace

struct Controller::Situation {
  double now_s = 0.0;
  Motion own;
  TargetFilter::State platform;
  Vector2d off{0.0, 0.0};  // horizontal vector from vehicle to platform [m]
  double distance = 0.0;   // its length
  double drift = 0.0;      // relative horizontal speed [m/s]
  double height = 0.0;     // above the platform [m]
  double unseen_s = 0.0;
};

Controller::Controller(const ControllerSettings& settings, const TargetFilter& platform)
    : settings_(settings), platform_(platform) {}

Command Controller::update(double now_s,
                           const Motion& own,
                           const std::optional<Observation>& seen) {
  if (seen) observe(*seen);
  const Situation now = judge(now_s, own);
  decide(now);
  return command(now);
}

void Controller::observe(const Observation& seen) {
  look(seen);
  if (!seen.radio) return;
  platform_.hear(seen.time_s,
                 seen.own.position.head<2>() + seen.radio->position,
                 seen.radio->velocity,
                 settings_.radio_error,
                 settings_.radio_velocity_error,
                 seen.time_s - last_seen_s_ < kRecent_s);
}

// During the search, ignores a target with too little of its outline in the picture, because its
// position is inaccurate.
void Controller::look(const Observation& seen) {
  const bool is_partial = phase_ == Phase::kSearch && seen.visible_fraction < kMinVisibleToStart;
  if (!seen.pad || is_partial) {
    consecutive_ = 0;
    rejected_ = 0;
    return;
  }
  // An attitude error, which the picture cannot show, rotates the measurement.
  const double attitude = 0.01 + 0.01 * seen.pad->norm();
  const Vector3d error = (seen.error.array().square() + attitude * attitude).sqrt();
  if (!platform_.see(seen.time_s, seen.own.position + *seen.pad, error)) {
    consecutive_ = 0;
    rejected_ = rejected_ % kMaxRejected + 1;
    return;
  }
  rejected_ = 0;
  ++consecutive_;
  last_seen_s_ = seen.time_s;
}

Controller::Situation Controller::judge(double now_s, const Motion& own) const {
  Situation now;
  now.now_s = now_s;
  now.own = own;
  now.platform = platform_.at(now_s);
  now.off = (now.platform.position - own.position).head<2>();
  now.distance = now.off.norm();
  now.drift = (now.platform.velocity - own.velocity).head<2>().norm();
  now.height = own.position.z() - now.platform.position.z();
  now.unseen_s = now_s - last_seen_s_;
  return now;
}

void Controller::begin(Phase phase, double now_s) {
  phase_ = phase;
  phase_since_s_ = now_s;
  steady_since_s_ = now_s;
}

void Controller::decide(const Situation& now) {
  const bool is_low = phase_ == Phase::kDescend || phase_ == Phase::kTouchDown;
  if (is_low && is_unsafe(now)) {
    ++climbs_;
    return begin(Phase::kClimb, now.now_s);
  }
  const bool is_lost = now.unseen_s > kLost_s;
  const bool may_be_lost = !is_low && phase_ != Phase::kSearch && phase_ != Phase::kClimb;
  if (is_lost && may_be_lost) return begin(Phase::kSearch, now.now_s);

  switch (phase_) {
    case Phase::kSearch:
      if (consecutive_ >= kMinConsecutive) begin(Phase::kApproach, now.now_s);
      break;
    case Phase::kApproach:
      if (now.distance < 0.8 + 0.1 * now.height) begin(Phase::kAlign, now.now_s);
      break;
    case Phase::kAlign:
      if (has_been_steady(now, 0.6, 0.8, 0.3)) begin(Phase::kFollow, now.now_s);
      break;
    case Phase::kFollow:
      if (has_been_steady(now, 0.5, 0.7, 0.7)) begin(Phase::kDescend, now.now_s);
      break;
    case Phase::kDescend:
      if (now.height < settings_.touch_down_height &&
          now.distance < 0.6 * settings_.max_off_touching) {
        begin(Phase::kTouchDown, now.now_s);
      }
      break;
    case Phase::kTouchDown:
      break;
    case Phase::kClimb:
      if (now.height > settings_.safe_height) {
        begin(is_lost ? Phase::kSearch : Phase::kApproach, now.now_s);
      }
      break;
  }
}

bool Controller::is_unsafe(const Situation& now) const {
  if (now.height < settings_.last_height) return false;
  const double allowed_s =
      now.height < settings_.blind_height ? settings_.max_unseen_low_s : settings_.max_unseen_s;
  if (now.unseen_s > allowed_s) return true;
  if (phase_ == Phase::kTouchDown) {
    return now.distance > settings_.max_off_touching || now.drift > kMaxDrift;
  }
  return now.distance > 0.6 + 0.4 * now.height || (now.height < 1.5 && now.drift > kMaxDrift);
}

bool Controller::has_been_steady(const Situation& now, double off, double drift, double for_s) {
  const bool is_steady = now.distance < off && now.drift < drift;
  if (!is_steady) steady_since_s_ = now.now_s;
  return now.now_s - steady_since_s_ >= for_s;
}

Command Controller::command(const Situation& now) const {
  Vector2d goal = now.off;
  if (phase_ == Phase::kSearch) {
    const double since_s = now.now_s - phase_since_s_;
    const double radius = std::min(kSpiralGrowth * since_s, kMaxSpiralRadius);
    const double turn = kSpiralSpeed / std::max(radius, 1.0) * since_s;
    goal += radius * Vector2d(std::cos(turn), std::sin(turn));
  }
  // Commands the platform's velocity at the time when the command takes effect, plus a correction
  // limited by the braking distance.
  const double distance = goal.norm();
  Vector2d correction{0.0, 0.0};
  if (distance > 0.0) {
    const double speed = std::min({settings_.gain * distance,
                                   std::sqrt(2.0 * settings_.braking * distance),
                                   settings_.max_correction});
    correction = speed / distance * goal;
  }
  const Vector2d ahead =
      now.platform.velocity.head<2>() + settings_.lead_s * now.platform.acceleration.head<2>();
  Command command;
  command.velocity << ahead + correction, climb_rate(now);
  command.yaw_rate = yaw_rate(now);
  return command;
}

double Controller::climb_rate(const Situation& now) const {
  const auto towards = [&](double height) {
    return std::clamp(0.8 * (height - now.height), -1.5, 1.5);
  };
  switch (phase_) {
    case Phase::kSearch: {
      // Flying higher enlarges the field of view; flying lower enlarges the target.
      const double turn = kSweepRate * (now.now_s - phase_since_s_);
      return towards(settings_.search_height + settings_.search_sweep * std::sin(turn));
    }
    case Phase::kApproach:
    case Phase::kAlign:
    case Phase::kFollow:
      return towards(settings_.approach_height);
    case Phase::kDescend: {
      const double cone = 0.2 + 0.12 * now.height;
      const double share = std::clamp(1.2 - now.distance / cone, -0.2, 1.0);
      const double rate = std::min(1.4, 0.3 + 0.3 * now.height);
      const bool must_wait = now.height < 0.9 * settings_.touch_down_height;
      return must_wait ? towards(settings_.touch_down_height) : -share * rate;
    }
    case Phase::kTouchDown:
      return -kTouchDownSpeed;
    case Phase::kClimb:
      break;
  }
  return 1.5;
}

// Aligns with the platform's direction of motion if it moves.
double Controller::yaw_rate(const Situation& now) const {
  const Vector2d way = now.platform.velocity.head<2>();
  const bool turns = phase_ != Phase::kSearch && phase_ != Phase::kApproach;
  if (!turns || way.norm() < kMinSpeedForHeading) return 0.0;
  const Vector3d forward = now.own.world_from_body * Vector3d::UnitX();
  const double off = std::remainder(
      std::atan2(way.y(), way.x()) - std::atan2(forward.y(), forward.x()), 2.0 * std::numbers::pi);
  return std::clamp(0.8 * off, -0.8, 0.8);
}

}  // namespace landing
