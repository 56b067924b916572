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

/// The scenes of the catalog that landings are flown in.
[[nodiscard]] std::span<const char* const> condition_names();

/// One landing. A value: the same one ends the same way, to the last bit.
struct Flight {
  std::uint64_t seed = 1;
  double speed = 4.2;  ///< Of the platform [m/s].
  Course course = Course::kStraight;
  std::string condition = "approach";  ///< A scene of the catalog.
  std::string method = "arcs+edges";   ///< See method.hpp.
  VehicleModel vehicle;
  ControllerSettings controller;
  Rig rig;
  int rate = 30;              ///< Pictures a second.
  int delay = 2;              ///< Pictures that are under way from the sensor to the controller.
  double longest_s = 90.0;    ///< Then it has failed.
  double hidden_below = 0.0;  ///< When first this low [m], the pad
  double hidden_s = 0.0;      ///< is gone for so long.
};

/// A picture and what came of it.
struct Moment {
  double time_s = 0.0;
  Phase phase = Phase::kSearch;
  Motion vehicle;
  Eigen::Vector2d platform{0.0, 0.0};
  Eigen::Vector2d platform_velocity{0.0, 0.0};
  double heading_rad = 0.0;
  bool is_visible = false;  ///< The method has a target.
  double visible = 0.0;     ///< Truth: share of the pad's outline in the picture.
};

struct Outcome {
  bool has_touched_down = false;
  Eigen::Vector2d off{0.0, 0.0};  ///< Of the vehicle from the pad's centre, ahead and left [m].
  double drift = 0.0;             ///< Level speed beside the platform [m/s].
  double sink = 0.0;              ///< Downward speed [m/s].
  double time_s = 0.0;
  int climbs = 0;
  std::array<int, kPhaseNames.size()> frames{};  ///< By phase,
  std::array<int, kPhaseNames.size()> unseen{};  ///< and those of them without a target,
  std::array<int, kPhaseNames.size()> missed{};  ///< though 30 % of the outline was in view.
  std::vector<Moment> moments;                   ///< One a picture.

  /// @param most_off  [m]
  [[nodiscard]] bool is_within(double most_off) const {
    return has_touched_down && off.norm() <= most_off;
  }
};

/// Is told of each picture, in order.
using Watcher = std::function<void(const Moment&, GstSample*)>;

/// Flies one landing to its end. Throws std::runtime_error where the pipeline fails.
[[nodiscard]] Outcome fly(const Flight& flight, const Watcher& watcher = {});

}  // namespace landing
