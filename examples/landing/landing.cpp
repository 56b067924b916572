// SPDX-License-Identifier: MIT
#include "examples/landing/landing.hpp"

#include <cmath>
#include <deque>
#include <memory>
#include <numbers>

#include "core/scene/catalog.hpp"
#include "core/scene/random.hpp"
#include "core/scene/renderer.hpp"
#include "examples/landing/method.hpp"
#include "examples/landing/noise.hpp"

namespace landing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxStep_s = 0.005;
constexpr double kGoodView = 0.3;  // visible fraction sufficient for detection
// The platform's radio report, once a second, with the errors of a satellite receiver.
constexpr double kRadioOffset = 1.5;    // constant bias [m]
constexpr double kRadioNoise = 0.5;     // [m]
constexpr double kVelocityError = 0.3;  // [m/s]

constexpr std::array kConditions = {"approach", "dusk", "glare", "noise"};
constexpr std::array kGrounds = {ellipse::GroundKind::kAsphalt,
                                 ellipse::GroundKind::kRoad,
                                 ellipse::GroundKind::kTiles,
                                 ellipse::GroundKind::kGrass};

enum class Stream : std::uint64_t { kStart, kWind, kScene, kRadio };

std::uint64_t seed_of(const Flight& flight, Stream stream) {
  return ellipse::hash(ellipse::hash(flight.seed) ^ static_cast<std::uint64_t>(stream));
}

ellipse::Scene scene_of(const Flight& flight) {
  ellipse::Scene scene =
      ellipse::scene_by_name(flight.condition.c_str(), seed_of(flight, Stream::kScene));
  scene.ground.kind = kGrounds.at(scene.seed % kGrounds.size());
  return scene;
}

ellipse::Scene with_pad(const Flight& flight) {
  ellipse::Scene scene = scene_of(flight);
  lay_pad(flight.method, scene);
  return scene;
}

ellipse::Scene without_pad(const Flight& flight) {
  ellipse::Scene scene = scene_of(flight);
  scene.pad.pattern = ellipse::Pattern::kNone;
  return scene;
}

struct Start {
  Vector3d position;
  double yaw_rad;
  double course_phase;
  Vector2d radio_offset;
};

Start start_of(const Flight& flight) {
  ellipse::Random random(seed_of(flight, Stream::kStart));
  Start start;
  start.course_phase = random.unit();
  const double direction = random.between(-std::numbers::pi, std::numbers::pi);
  const double away = random.between(3.0, 12.0);
  start.position << away * std::cos(direction), away * std::sin(direction),
      random.between(7.0, 11.0);
  start.yaw_rad = random.between(-std::numbers::pi, std::numbers::pi);
  start.radio_offset = kRadioOffset * normal_vector(random).head<2>();
  return start;
}

// A landing in progress.
class Run {
 public:
  explicit Run(const Flight& flight)
      : flight_(flight),
        start_(start_of(flight)),
        platform_(flight.course, flight.speed, start_.course_phase),
        vehicle_(flight.vehicle, start_.position, start_.yaw_rad, seed_of(flight, Stream::kWind)),
        controller_(flight.controller,
                    TargetFilter(0.0,
                                 {start_.radio_offset.x(), start_.radio_offset.y(), 0.0},
                                 platform_.velocity(),
                                 flight.controller.radio_error,
                                 flight.controller.radio_velocity_error)),
        radio_(seed_of(flight, Stream::kRadio)),
        renderer_(with_pad(flight)),
        eye_(eye_of(flight.method, flight.rig, renderer_.scene().pad, flight.rate)) {
    if (flight.hidden_s > 0.0) bare_renderer_.emplace(without_pad(flight));
  }

  Outcome fly(const Watcher& watcher) {
    const int frames = static_cast<int>(flight_.longest_s * flight_.rate);
    for (int frame = 0; frame < frames && !outcome_.has_touched_down; ++frame) {
      const double now_s = static_cast<double>(frame) / flight_.rate;
      take_picture(now_s, watcher);
      const Command command = controller_.update(now_s, vehicle_.estimate(), arrived_observation());
      if (controller_.is_off_target()) eye_->forget();
      move(command);
    }
    outcome_.climbs = controller_.climbs();
    return std::move(outcome_);
  }

 private:
  void take_picture(double now_s, const Watcher& watcher) {
    const ellipse::View view = view_of(flight_.rig, vehicle_.truth(), platform_);
    const auto frame = static_cast<std::uint64_t>(outcome_.moments.size());
    ellipse::SceneRenderer& renderer = is_hidden(now_s) ? *bare_renderer_ : renderer_;
    ellipse::Truth truth;
    Observation seen;
    seen.time_s = now_s;
    seen.own = vehicle_.estimate();
    seen.radio = radio_at(frame);
    const Look look =
        eye_->look(gravity_of(flight_.rig, seen.own), [&](const ellipse::MutableImage& picture) {
          truth = renderer.render(view, frame, picture);
        });
    if (look.position) {
      seen.pad = pad_from_body(flight_.rig, seen.own, *look.position);
      seen.error = errors_from_body(flight_.rig, seen.own, look.covariance);
      seen.visible_fraction = look.visible_fraction;
    }
    under_way_.push_back(seen);

    Moment moment{now_s,
                  controller_.phase(),
                  vehicle_.truth(),
                  platform_.position(),
                  platform_.velocity(),
                  platform_.heading_rad(),
                  look.has_target,
                  truth.visible_fraction};
    count(moment);
    if (watcher) watcher(moment, look.sample.get());
    outcome_.moments.push_back(std::move(moment));
  }

  // Reports once a second. The relative position comes from both satellite receivers, because the
  // vehicle's dead reckoning drifts.
  std::optional<Radio> radio_at(std::uint64_t frame) {
    if (frame % static_cast<std::uint64_t>(flight_.rate) != 0) return std::nullopt;
    const Vector2d away = platform_.position() - vehicle_.truth().position.head<2>();
    const Vector3d noise = kRadioNoise * normal_vector(radio_);
    return Radio{away + start_.radio_offset + noise.head<2>(),
                 platform_.velocity() + kVelocityError * normal_vector(radio_).head<2>()};
  }

  void count(const Moment& moment) {
    const auto phase = static_cast<std::size_t>(moment.phase);
    ++outcome_.frames.at(phase);
    if (moment.is_visible) return;
    ++outcome_.unseen.at(phase);
    if (moment.visible >= kGoodView) ++outcome_.missed.at(phase);
  }

  bool is_hidden(double now_s) {
    if (!bare_renderer_) return false;
    if (!hidden_from_s_ && vehicle_.truth().position.z() < flight_.hidden_below) {
      hidden_from_s_ = now_s;
    }
    return hidden_from_s_ && now_s < *hidden_from_s_ + flight_.hidden_s;
  }

  std::optional<Observation> arrived_observation() {
    if (under_way_.size() <= static_cast<std::size_t>(flight_.delay)) return std::nullopt;
    const Observation seen = under_way_.front();
    under_way_.pop_front();
    return seen;
  }

  // Simulates until the next picture or touchdown.
  void move(const Command& command) {
    const int steps = static_cast<int>(std::ceil(1.0 / flight_.rate / kMaxStep_s));
    const double step_s = 1.0 / flight_.rate / steps;
    for (int i = 0; i < steps; ++i) {
      vehicle_.step(command, step_s);
      platform_.step(step_s);
      if (vehicle_.truth().position.z() <= 0.0) {
        touch_down(static_cast<double>(outcome_.moments.size() - 1) / flight_.rate +
                   (i + 1) * step_s);
        return;
      }
    }
  }

  void touch_down(double time_s) {
    const Motion& vehicle = vehicle_.truth();
    const Eigen::Rotation2Dd pad_from_world(-platform_.heading_rad());
    outcome_.has_touched_down = true;
    outcome_.off = pad_from_world * (vehicle.position.head<2>() - platform_.position());
    outcome_.drift = (vehicle.velocity.head<2>() - platform_.velocity()).norm();
    outcome_.sink = -vehicle.velocity.z();
    outcome_.time_s = time_s;
  }

  const Flight& flight_;
  Start start_;
  Platform platform_;
  Vehicle vehicle_;
  Controller controller_;
  ellipse::Random radio_;
  ellipse::SceneRenderer renderer_;
  std::optional<ellipse::SceneRenderer> bare_renderer_;  // renders the scene without the pad
  std::unique_ptr<Eye> eye_;
  std::deque<Observation> under_way_;
  std::optional<double> hidden_from_s_;
  Outcome outcome_;
};

}  // namespace

std::span<const char* const> condition_names() {
  return kConditions;
}

Outcome fly(const Flight& flight, const Watcher& watcher) {
  return Run(flight).fly(watcher);
}

}  // namespace landing
