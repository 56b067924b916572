#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "examples/landing/camera_view.hpp"
#include "examples/landing/controller.hpp"
#include "examples/landing/platform.hpp"
#include "examples/landing/vehicle.hpp"

namespace landing {

/// The catalog's scenes available for landings.
[[nodiscard]] std::span<const char* const> condition_names();

/// Parameters of one landing. Value type; equal flights have bit-identical outcomes.
struct Flight {
  std::uint64_t seed = 1;
  double speed = 4.2;  ///< Speed of the platform [m/s].
  Course course = Course::kStraight;
  std::string condition = "approach";  ///< A scene of the catalog.
  std::string method = "arcs+edges";   ///< See method.hpp.
  VehicleModel vehicle;
  ControllerSettings controller;
  Rig rig;
  int rate = 30;              ///< Pictures per second.
  int delay = 2;              ///< Latency from sensor to controller [pictures].
  double longest_s = 90.0;    ///< Time limit; then the landing has failed.
  double hidden_below = 0.0;  ///< Height below which the pad disappears [m],
  double hidden_s = 0.0;      ///< and for how long.
};

/// A picture and its results.
struct Moment {
  double time_s = 0.0;
  Phase phase = Phase::kSearch;
  Motion vehicle;
  Eigen::Vector2d platform{0.0, 0.0};
  Eigen::Vector2d platform_velocity{0.0, 0.0};
  double heading_rad = 0.0;
  bool is_visible = false;  ///< The method reports a target.
  double visible = 0.0;     ///< Ground truth: visible fraction of the pad's outline.
};

struct Outcome {
  bool has_touched_down = false;
  Eigen::Vector2d off{0.0, 0.0};  ///< From the pad's centre to the vehicle, forward and left [m].
  double drift = 0.0;             ///< Horizontal speed relative to the platform [m/s].
  double sink = 0.0;              ///< Downward speed [m/s].
  double time_s = 0.0;
  int climbs = 0;
  std::array<int, kPhaseNames.size()> frames{};  ///< Pictures by phase.
  std::array<int, kPhaseNames.size()> unseen{};  ///< Of those, pictures without a target.
  std::array<int, kPhaseNames.size()> missed{};  ///< Of those, 30 % of the outline visible.
  std::vector<Moment> moments;                   ///< One per picture.

  /// @param max_off  [m]
  [[nodiscard]] bool is_within(double max_off) const {
    return has_touched_down && off.norm() <= max_off;
  }
};

/// Called for each picture, in order.
using Watcher = std::function<void(const Moment&, GstSample*)>;

/// Simulates one landing. Throws std::runtime_error if the pipeline fails.
[[nodiscard]] Outcome fly(const Flight& flight, const Watcher& watcher = {});

}  // namespace landing
