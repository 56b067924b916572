#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>

#include "examples/landing/target_filter.hpp"
#include "examples/landing/vehicle.hpp"

namespace landing {

/// Phase of the landing.
enum class Phase {
  kSearch,     ///< Circles at varying height around the platform's expected position.
  kApproach,   ///< Flies to a position above the platform.
  kAlign,      ///< Matches its velocity and heading.
  kFollow,     ///< Stays above it until distance and velocity are steady.
  kDescend,    ///< Descends, more slowly when off centre.
  kTouchDown,  ///< The last half metre; the pad need not be visible.
  kClimb,      ///< Climbs after an unsafe descent, then tries again.
};
inline constexpr std::array kPhaseNames = {
    "search", "approach", "align", "follow", "descend", "touch down", "climb"};

/// Settings of the controller. Value type.
struct ControllerSettings {
  double gain = 1.2;                  ///< Velocity per distance [1/s].
  double max_correction = 5.0;        ///< Velocity relative to the platform [m/s].
  double braking = 2.0;               ///< Assumed deceleration [m/s^2].
  double lead_s = 0.35;               ///< Compensates the vehicle's velocity lag.
  double approach_height = 5.0;       ///< [m]
  double search_height = 8.5;         ///< Mean height [m],
  double search_sweep = 2.5;          ///< and amplitude [m].
  double touch_down_height = 0.55;    ///< No hovering below this height [m].
  double safe_height = 4.0;           ///< Height at which a climb ends [m].
  double radio_error = 1.8;           ///< Standard deviation of the reported position [m],
  double radio_velocity_error = 0.4;  ///< and velocity [m/s].
  double max_unseen_s = 0.6;          ///< Maximum time without detection while descending,
  double max_unseen_low_s = 1.5;      ///< and below `blind_height`.
  double blind_height = 1.0;          ///< Below it the camera sees little of the pad [m].
  double last_height = 0.4;           ///< Below it no climb stops the descent in time [m].
  double max_off_touching = 0.22;     ///< Maximum distance from the centre at touchdown [m].
};

/// The platform's radio report.
struct Radio {
  Eigen::Vector2d position;  ///< From the body's origin [m].
  Eigen::Vector2d velocity;  ///< [m/s]
};

/// A measurement and the vehicle's state estimate at that time.
struct Observation {
  double time_s = 0.0;
  Motion own;                            ///< The autopilot's estimate.
  std::optional<Eigen::Vector3d> pad;    ///< Vector from the body's origin, in world axes [m].
  Eigen::Vector3d error{0.0, 0.0, 0.0};  ///< Its standard deviations by the picture alone [m].
  double visible_fraction = 1.0;         ///< Visible fraction of the pad's outline.
  std::optional<Radio> radio;
};

/// Lands by velocity commands, computed from the observed pad position and an estimate of the
/// platform's motion.
class Controller {
 public:
  /// @param platform  Prior knowledge of the platform.
  Controller(const ControllerSettings& settings, const TargetFilter& platform);

  /// The command at time now_s. @param seen  A new measurement, in order of time.
  Command update(double now_s, const Motion& own, const std::optional<Observation>& seen);

  [[nodiscard]] Phase phase() const { return phase_; }

  /// Whether the method tracks a false target and should search again.
  [[nodiscard]] bool is_off_target() const { return rejected_ >= kMaxRejected; }

  /// Number of aborted descents.
  [[nodiscard]] int climbs() const { return climbs_; }

 private:
  struct Situation;  // input of the decisions
  static constexpr int kMaxRejected = 5;

  void observe(const Observation& seen);
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
  int consecutive_ = 0;
  int rejected_ = 0;
  int climbs_ = 0;
};

}  // namespace landing
