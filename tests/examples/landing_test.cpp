// SPDX-License-Identifier: MIT
//
// The parts of the landing, and whole landings through real pipelines.
#include "examples/landing/landing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/geometry/homography.hpp"
#include "examples/landing/pipeline.hpp"
#include "examples/landing/pipeline_eye.hpp"
#include "examples/landing/report.hpp"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using landing::Command;
using landing::Controller;
using landing::ControllerSettings;
using landing::Course;
using landing::Flight;
using landing::Motion;
using landing::Observation;
using landing::Phase;
using landing::Platform;
using landing::Rig;
using landing::TargetFilter;
using landing::Vehicle;
using landing::VehicleModel;

constexpr double kStep_s = 0.005;

VehicleModel in_still_air() {
  VehicleModel model;
  model.gust = 0.0;
  model.velocity_error = 0.0;
  model.attitude_error_rad = 0.0;
  return model;
}

TEST(Vehicle, TiltsToReachTheCommandedVelocity) {
  Vehicle vehicle(in_still_air(), {0.0, 0.0, 5.0}, 0.0, 1);
  const Command command{{3.0, 0.0, 0.0}, 0.0};
  for (int i = 0; i < 60; ++i) vehicle.step(command, kStep_s);
  const Vector3d up = vehicle.truth().world_from_body * Vector3d::UnitZ();
  EXPECT_GT(up.x(), 0.2);  // it leans forward to speed up
  for (int i = 0; i < 600; ++i) vehicle.step(command, kStep_s);
  EXPECT_NEAR((vehicle.truth().velocity - command.velocity).norm(), 0.0, 0.02);
  EXPECT_NEAR(vehicle.truth().position.z(), 5.0, 0.3);
}

TEST(Vehicle, HoldsItsPositionInGusts) {
  VehicleModel model = in_still_air();
  model.gust = 3.0;
  Vehicle vehicle(model, {0.0, 0.0, 5.0}, 0.0, 7);
  double squared = 0.0;
  constexpr int kSteps = 12000;
  for (int i = 0; i < kSteps; ++i) {
    vehicle.step({}, kStep_s);
    squared += vehicle.truth().velocity.head<2>().squaredNorm();
  }
  const double speed = std::sqrt(squared / kSteps);
  EXPECT_GT(speed, 0.02);  // gusts act
  EXPECT_LT(speed, 0.3);   // and are mostly compensated
}

TEST(Vehicle, IsTheSameForTheSameSeed) {
  Vehicle one(VehicleModel{}, {0.0, 0.0, 5.0}, 0.0, 3);
  Vehicle same(VehicleModel{}, {0.0, 0.0, 5.0}, 0.0, 3);
  Vehicle other(VehicleModel{}, {0.0, 0.0, 5.0}, 0.0, 4);
  for (int i = 0; i < 200; ++i) {
    for (Vehicle* vehicle : {&one, &same, &other}) vehicle->step({}, kStep_s);
  }
  EXPECT_EQ(one.truth().position, same.truth().position);
  EXPECT_NE(one.truth().position, other.truth().position);
}

TEST(Platform, MovesAtItsSpeedAlongItsHeading) {
  for (const Course course : {Course::kStraight, Course::kCircle, Course::kFigureOfEight}) {
    Platform platform(course, 4.2, 0.3);
    double way = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const Vector2d before = platform.position();
      platform.step(kStep_s);
      const Vector2d step = platform.position() - before;
      way += step.norm();
      const Vector2d ahead(std::cos(platform.heading_rad()), std::sin(platform.heading_rad()));
      ASSERT_GT(step.normalized().dot(ahead), 0.999) << name_of(course);
    }
    EXPECT_NEAR(way, 4.2 * 4000 * kStep_s, 0.05) << name_of(course);
  }
  const Platform still(Course::kCircle, 0.0, 0.0);
  EXPECT_EQ(still.velocity().norm(), 0.0);
}

TEST(CameraView, ProjectsThePadAsTheVehicleSeesIt) {
  const Rig rig;
  Motion vehicle;
  vehicle.position = {-1.0, 0.5, 6.0};  // the pad is ahead of it, and to its right
  const Platform platform(Course::kStraight, 0.0, 0.0);
  const auto outline = ellipse::project_circle(view_of(rig, vehicle, platform).image_from_pad, 1.0);
  ASSERT_TRUE(outline);
  EXPECT_LT(outline->cy, rig.camera.cy);
  EXPECT_GT(outline->cx, rig.camera.cx);
  const double height = vehicle.position.z() + rig.position.z();
  EXPECT_NEAR(outline->cx, rig.camera.cx + rig.camera.fx * 0.5 / height, 1e-6);
  EXPECT_NEAR(outline->semi_major, rig.camera.fx * rig.pad_radius / height, 1e-6);
}

TEST(CameraView, RecoversThePositionOfThePad) {
  Rig rig;
  rig.pitch_rad = 0.3;
  Motion vehicle;
  vehicle.position = {2.0, -1.0, 6.0};
  vehicle.world_from_body =
      Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Vector3d::UnitX());
  const Platform platform(Course::kStraight, 0.0, 0.0);
  const Eigen::Matrix3d view = view_of(rig, vehicle, platform).image_from_pad;
  // The third column is the pad's centre in radii, multiplied by the camera matrix.
  const Vector3d in_camera = rig.pad_radius * (rig.camera.matrix().inverse() * view.col(2));
  const Vector3d pad = vehicle.position + pad_from_body(rig, vehicle, in_camera);
  EXPECT_NEAR(pad.norm(), 0.0, 1e-9);
  EXPECT_NEAR((gravity_of(rig, vehicle) -
               (vehicle.world_from_body.toRotationMatrix() * rig.body_from_camera()).transpose() *
                   -Vector3d::UnitZ())
                  .norm(),
              0.0,
              1e-12);
}

TEST(TargetFilter, EstimatesVelocityAndRejectsOutliers) {
  TargetFilter filter(0.0, Vector3d::Zero(), Vector2d::Zero(), 2.0, 1.0);
  for (int i = 0; i <= 60; ++i) {
    const double time_s = i / 30.0;
    EXPECT_TRUE(filter.see(time_s, {3.0 * time_s, 0.0, 0.0}, Vector3d::Constant(0.02))) << i;
  }
  EXPECT_NEAR(filter.at(2.5).velocity.x(), 3.0, 0.1);
  EXPECT_NEAR(filter.at(2.5).position.x(), 7.5, 0.1);
  EXPECT_FALSE(filter.see(2.1, {3.0 * 2.1, 4.0, 0.0}, Vector3d::Constant(0.02)));
  EXPECT_NEAR(filter.at(2.5).position.y(), 0.0, 0.05);
}

// For half a second the detections are off by ten times their stated error. The target is not
// forgotten, because that takes five rejected detections in a row.
TEST(TargetFilter, RecoversFromWrongDetections) {
  TargetFilter filter(0.0, Vector3d::Zero(), Vector2d::Zero(), 2.0, 1.0);
  for (int i = 0; i < 15; ++i) {
    ASSERT_TRUE(filter.see(i / 30.0, {0.1, 0.0, 0.0}, Vector3d::Constant(0.01))) << i;
  }
  int rejected = 0;
  for (int i = 15; i < 30; ++i) {
    if (!filter.see(i / 30.0, Vector3d::Zero(), Vector3d::Constant(0.01))) ++rejected;
  }
  EXPECT_GE(rejected, 1);
  EXPECT_LE(rejected, 4);
  EXPECT_NEAR(filter.at(1.0).position.x(), 0.0, 0.05);
}

// Such as a bright spot on the pad, which looks like a pad far below.
TEST(TargetFilter, RejectsAnotherObjectRepeatedly) {
  TargetFilter filter(0.0, Vector3d::Zero(), Vector2d::Zero(), 2.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(filter.see(i / 30.0, Vector3d::Zero(), Vector3d::Constant(0.02))) << i;
  }
  for (int i = 0; i < 60; ++i) {
    EXPECT_FALSE(filter.see(2.0 + i / 30.0, {0.0, 0.0, -8.5}, Vector3d::Constant(0.1))) << i;
  }
  EXPECT_NEAR(filter.at(4.0).position.z(), 0.0, 0.1);
}

TEST(TargetFilter, RejectsWhatIsNotANumber) {
  TargetFilter filter(0.0, Vector3d::Zero(), Vector2d::Zero(), 2.0, 1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(filter.see(0.1, {0.0, nan, 0.0}, Vector3d::Constant(0.02)));
  EXPECT_FALSE(filter.see(0.1, Vector3d::Zero(), {0.0, nan, 0.0}));
  EXPECT_TRUE(filter.at(0.2).position.allFinite());
}

TEST(TargetFilter, PrefersTheRadioWhereTheVisualEstimateIsFarFromIt) {
  TargetFilter filter(0.0, {20.0, 0.0, 0.0}, Vector2d::Zero(), 1.0, 0.5);
  filter.hear(1.0, {0.0, 0.0}, {1.0, 0.0}, 1.8, 0.4, true);
  EXPECT_NEAR(filter.at(1.0).position.x(), 0.0, 1e-9);
  EXPECT_NEAR(filter.at(1.0).velocity.x(), 1.0, 1e-9);
  // When the radio agrees roughly, the visual estimate is more accurate.
  filter.hear(2.0, {2.5, 0.0}, {1.0, 0.0}, 1.8, 0.4, true);
  EXPECT_NEAR(filter.at(2.0).position.x(), 1.0, 1e-9);
}

// A few frames show a climbing pad, then it is lost. A minute later the filter accepts the pad at
// its true position, although dead reckoning has risen by some metres.
TEST(TargetFilter, DampsTheVerticalVelocityAfterALoss) {
  TargetFilter filter(0.0, Vector3d::Zero(), Vector2d::Zero(), 1.0, 0.1);
  for (int i = 0; i < 15; ++i) {
    const double time_s = i / 30.0;
    EXPECT_TRUE(filter.see(time_s, {0.0, 0.0, -0.3 * time_s}, Vector3d::Constant(0.05))) << i;
  }
  for (int i = 1; i <= 60; ++i) filter.hear(i, {0.0, 0.0}, {0.0, 0.0}, 1.8, 0.4, i < 3);
  EXPECT_GT(filter.at(60.0).position.z(), -1.5);
  EXPECT_TRUE(filter.see(60.1, {0.2, 0.1, 3.0}, Vector3d::Constant(0.05)));
}

// A vehicle that follows its commands without delay, over a static pad.
class Hovering {
 public:
  explicit Hovering(const Vector3d& position) {
    own_.position = position;
    controller_.emplace(ControllerSettings{},
                        TargetFilter(0.0, Vector3d::Zero(), Vector2d::Zero(), 1.0, 0.1));
  }

  void fly_for(double duration_s, bool is_visible, double visible_fraction = 1.0) {
    const int frames = static_cast<int>(std::lround(30.0 * duration_s));
    for (int i = 0; i < frames; ++i, ++frame_) {
      Observation observation;
      observation.time_s = frame_ / 30.0;
      observation.own = own_;
      if (is_visible) observation.pad = aside_ - own_.position;
      observation.error.setConstant(error_);
      observation.visible_fraction = visible_fraction;
      last_ = controller_->update(observation.time_s, own_, observation);
      own_.velocity = last_.velocity;
      own_.position += last_.velocity / 30.0;
    }
  }

  /// Offsets the measured position of the pad from now on, with this stated error [m].
  void see_aside(const Vector3d& by, double error) {
    aside_ = by;
    error_ = error;
  }

  [[nodiscard]] Phase phase() const { return controller_->phase(); }
  [[nodiscard]] int climbs() const { return controller_->climbs(); }
  [[nodiscard]] const Vector3d& position() const { return own_.position; }
  [[nodiscard]] const Command& last() const { return last_; }

 private:
  Motion own_;
  std::optional<Controller> controller_;
  Command last_;
  Vector3d aside_ = Vector3d::Zero();
  double error_ = 0.0;
  int frame_ = 0;
};

TEST(Controller, PassesThroughAllPhasesToTouchDown) {
  Hovering hover({4.0, -3.0, 8.0});
  EXPECT_EQ(hover.phase(), Phase::kSearch);
  hover.fly_for(0.5, true);
  EXPECT_EQ(hover.phase(), Phase::kApproach);
  EXPECT_LT(hover.last().velocity.x(), 0.0);  // towards it
  EXPECT_GT(hover.last().velocity.y(), 0.0);
  for (int i = 0; i < 60 && hover.position().z() > 0.0; ++i) hover.fly_for(0.5, true);
  EXPECT_EQ(hover.phase(), Phase::kTouchDown);
  EXPECT_LT(hover.position().head<2>().norm(), 0.05);
  EXPECT_EQ(hover.climbs(), 0);
}

TEST(Controller, StartsOnlyOnSufficientlyVisibleTargets) {
  Hovering hover({4.0, -3.0, 8.0});
  hover.fly_for(0.5, true, 0.4);
  EXPECT_EQ(hover.phase(), Phase::kSearch);
  hover.fly_for(0.5, true, 0.8);
  EXPECT_EQ(hover.phase(), Phase::kApproach);
  hover.fly_for(3.0, true, 0.4);  // a known target is followed while less of it is visible
  EXPECT_NE(hover.phase(), Phase::kSearch);
}

// The first positions were of another object, such as the ring's inner edge, which is farther away.
TEST(Controller, RecoversFromAWrongHeight) {
  Hovering hover({1.0, 0.0, 8.0});
  hover.see_aside({0.0, 0.0, -2.4}, 0.0);
  hover.fly_for(0.1, true);
  EXPECT_EQ(hover.phase(), Phase::kSearch);
  hover.see_aside({0.0, 0.0, 0.0}, 0.0);
  hover.fly_for(0.5, true);
  EXPECT_NE(hover.phase(), Phase::kSearch);
}

// Lateral motion caused by a position that is off by 0.1 m and states this error [m].
double led_astray(double error) {
  Hovering hover({0.2, 0.0, 8.0});
  for (int i = 0; i < 100 && hover.position().z() > 1.5; ++i) hover.fly_for(0.1, true);
  EXPECT_EQ(hover.phase(), Phase::kDescend);
  const double before = hover.position().x();
  hover.see_aside({0.1, 0.0, 0.0}, error);
  hover.fly_for(0.3, true);
  return hover.position().x() - before;
}

TEST(Controller, WeighsPositionsByTheirStatedError) {
  EXPECT_GT(led_astray(0.0), 0.02);
  EXPECT_LT(led_astray(0.1), 0.5 * led_astray(0.0));
}

TEST(Controller, ClimbsAfterLosingTheTargetInDescent) {
  Hovering hover({0.2, 0.0, 8.0});
  for (int i = 0; i < 100 && hover.position().z() > 3.0; ++i) hover.fly_for(0.1, true);
  ASSERT_EQ(hover.phase(), Phase::kDescend);
  hover.fly_for(0.4, false);
  EXPECT_EQ(hover.phase(), Phase::kDescend);  // a short loss is tolerated
  hover.fly_for(0.4, false);
  EXPECT_EQ(hover.phase(), Phase::kClimb);
  EXPECT_GT(hover.last().velocity.z(), 1.0);
  EXPECT_EQ(hover.climbs(), 1);
  hover.fly_for(5.0, false);
  EXPECT_EQ(hover.phase(), Phase::kSearch);
  EXPECT_GT(hover.position().z(), 6.0);
}

Flight short_flight() {
  Flight flight;
  flight.seed = 3;
  flight.speed = 1.5;
  flight.rig.camera = flight.rig.camera.resized(320, 180);
  return flight;
}

TEST(Landing, EndsOnTheMovingPadAndIsDeterministic) {
  const landing::Outcome outcome = landing::fly(short_flight());
  ASSERT_TRUE(outcome.has_touched_down);
  EXPECT_LE(outcome.off.norm(), landing::kMaxOff);
  EXPECT_LE(outcome.drift, 1.0);
  EXPECT_LE(outcome.sink, 1.2);
  EXPECT_GT(outcome.frames[static_cast<std::size_t>(Phase::kDescend)], 30);

  const landing::Outcome again = landing::fly(short_flight());
  EXPECT_EQ(again.off, outcome.off);  // bit for bit
  EXPECT_EQ(again.time_s, outcome.time_s);
  EXPECT_EQ(again.moments.size(), outcome.moments.size());
}

TEST(Landing, AbortsAndRetriesWhenThePadIsHidden) {
  Flight flight = short_flight();
  flight.hidden_below = 2.5;
  flight.hidden_s = 3.0;
  const landing::Outcome outcome = landing::fly(flight);
  EXPECT_GE(outcome.climbs, 1);
  ASSERT_TRUE(outcome.has_touched_down);
  EXPECT_LE(outcome.off.norm(), landing::kMaxOff);
  // It climbed again before it landed.
  double highest = 0.0;
  bool was_low = false;
  for (const landing::Moment& moment : outcome.moments) {
    was_low = was_low || moment.vehicle.position.z() < 2.5;
    if (was_low) highest = std::max(highest, moment.vehicle.position.z());
  }
  EXPECT_GT(highest, 3.5);
}

TEST(Landing, UnknownMethodsAreRejected) {
  Flight flight = short_flight();
  flight.method = "arcs";
  EXPECT_THROW((void)landing::fly(flight), std::invalid_argument);
  flight.method = "arcs+magic";
  EXPECT_THROW((void)landing::fly(flight), std::runtime_error);
}

TEST(Report, CountsLandingsByMethodAndSpeed) {
  Flight flight;
  landing::Outcome right;
  right.has_touched_down = true;
  right.off = {0.1, 0.0};
  landing::Outcome wide = right;
  wide.off = {0.4, 0.0};
  const auto table = landing::outcome_table({{flight, right}, {flight, wide}, {flight, {}}});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], "arcs+edges, 4.2 m/s");
  EXPECT_EQ(table.rows[0][1], "3");
  EXPECT_EQ(table.rows[0][2], "1");
  EXPECT_EQ(table.rows[0][3], "33.3");
  EXPECT_EQ(table.rows[0].back(), "1");
}

// A pipeline that cannot start leaves no thread waiting.
TEST(LandingPipeline, ThrowsIfItCannotStart) {
  landing::Pipeline pipeline("videotestsrc ! filesink location=/no/such/folder/file");
  EXPECT_THROW(pipeline.play(), std::runtime_error);
}

TEST(LandingEye, ThrowsOnAPipelineError) {
  landing::PipelineEye eye({64, 48, 30}, "! identity error-after=3");
  const auto look = [&] {
    return eye.look(Vector3d::UnitZ(), [](const ellipse::MutableImage& picture) {
      std::fill_n(picture.data, picture.stride * picture.height, std::uint8_t{0});
    });
  };
  EXPECT_FALSE(look().has_target);
  EXPECT_FALSE(look().has_target);
  EXPECT_THROW((void)look(), std::runtime_error);
}

TEST(LandingPipeline, ThrowsOnAnErrorWhileFed) {
  landing::Pipeline pipeline(
      "appsrc name=source ! filesink buffer-mode=unbuffered location=/dev/full");
  const landing::Element source = pipeline.element("source");
  pipeline.play();
  const auto feed = [&] {
    for (int i = 0; i < 100; ++i) {
      pipeline.push(source, gst_buffer_new_allocate(nullptr, 4096, nullptr));
    }
  };
  EXPECT_THROW(feed(), std::runtime_error);
}

}  // namespace
