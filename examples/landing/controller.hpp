#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>

#include "examples/landing/target_filter.hpp"
#include "examples/landing/vehicle.hpp"

namespace landing {

/// What the vehicle is about.
enum class Phase {
  kSearch,     ///< Circles, higher and lower, where the platform should be.
  kApproach,   ///< Flies to above it.
  kAlign,      ///< Takes on its velocity and its heading.
  kFollow,     ///< Stays above it until that is steady.
  kDescend,    ///< Comes down, the slower the less it is above the middle.
  kTouchDown,  ///< The last half metre, where nothing of the pad needs to be in view.
  kClimb,      ///< Something was not safe: up, and again.
};
inline constexpr std::array kPhaseNames = {
    "search", "approach", "align", "follow", "descend", "touch down", "climb"};

/// What it flies by. A value.
struct ControllerSettings {
  double gain = 1.2;                  ///< Velocity per distance [1/s].
  double most_correction = 5.0;       ///< Velocity beside the platform's own [m/s].
  double braking = 2.0;               ///< Deceleration that it counts on [m/s^2].
  double lead_s = 0.35;               ///< Of the command: the vehicle's own lag.
  double approach_height = 5.0;       ///< [m]
  double search_height = 8.5;         ///< In the middle [m], and
  double search_sweep = 2.5;          ///< so far up and down [m].
  double touch_down_height = 0.55;    ///< Below it there is no waiting [m].
  double safe_height = 4.0;           ///< Where a climb ends [m].
  double radio_error = 1.8;           ///< Standard deviation of what the platform tells [m],
  double radio_velocity_error = 0.4;  ///< and of its velocity [m/s].
  double most_unseen_s = 0.6;         ///< That is safe while it comes down.
  double most_unseen_low_s = 1.5;     ///< And below `blind_height`.
  double blind_height = 1.0;          ///< From here on little of the pad is in view [m].
  double last_height = 0.2;           ///< From here on down in any case [m].
  double most_off_touching = 0.22;    ///< Distance from the middle that is safe there [m].
};

/// What the platform tells by radio.
struct Radio {
  Eigen::Vector2d position;  ///< From the body's origin [m].
  Eigen::Vector2d velocity;  ///< [m/s]
};

/// What was told at a time, and what the vehicle believed then.
struct Observation {
  double time_s = 0.0;
  Motion own;                          ///< Its autopilot's estimate.
  std::optional<Eigen::Vector3d> pad;  ///< From the body's origin, in the world's axes [m].
  double error = 0.0;                  ///< Standard deviation of that, as the picture tells [m].
  double visible_fraction = 1.0;       ///< Share of the pad's outline that the picture shows.
  std::optional<Radio> radio;
};

/// Lands by what the camera sees: velocity commands from where the pad is, beside an estimate of
/// the platform's own velocity.
class Controller {
 public:
  /// @param platform  What is known of it before it is seen.
  Controller(const ControllerSettings& settings, const TargetFilter& platform);

  /// The command at a time. @param seen  The picture that has just come, not before the last one.
  Command update(double now_s, const Motion& own, const std::optional<Observation>& seen);

  [[nodiscard]] Phase phase() const { return phase_; }

  /// Whether ellipsetrack follows something else: it had better search anew.
  [[nodiscard]] bool is_deceived() const { return refused_in_a_row_ >= kMaxRefused; }

  /// Times that something was not safe.
  [[nodiscard]] int climbs() const { return climbs_; }

 private:
  struct Situation;  // what it decides by
  static constexpr int kMaxRefused = 5;

  void take_in(const Observation& seen);
  void look(const Observation& seen);
  [[nodiscard]] Situation judge(double now_s, const Motion& own) const;
  void decide(const Situation& now);
  void begin(Phase phase, double now_s);
  [[nodiscard]] bool is_unsafe(const Situation& now) const;
  [[nodiscard]] bool has_been_steady(const Situation& now, double off, double drift, double for_s);
  [[nodiscard]] Command command(const Situation& now) const;
  [[nodiscard]] double climb_rate(const Situation& now) const;
  [[nodiscard]] double yaw_rate(const Situation& now) const;

  ControllerSettings settings_;
  TargetFilter platform_;
  Phase phase_ = Phase::kSearch;
  double phase_since_s_ = 0.0;
  double steady_since_s_ = 0.0;
  double last_seen_s_ = -1e9;
  int seen_in_a_row_ = 0;
  int refused_in_a_row_ = 0;
  int climbs_ = 0;
};

}  // namespace landing
