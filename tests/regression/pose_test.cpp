// SPDX-License-Identifier: MIT
//
// Accuracy of the pose of a tracked pad on rendered flights from 15 m to 1 m.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "core/camera/circle_pose.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/random.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using support::kHeight;
using support::kWidth;

constexpr double kHfovRad = 1.012;  // 58 degrees
constexpr double kRadius_m = 0.75;
constexpr int kFrames = 90;
constexpr int kFlights = 12;
constexpr std::uint64_t kSeed = 7301;

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

struct Errors {
  std::vector<double> aside;       // across the line of sight, relative to the distance
  std::vector<double> depth;       // along it, relative to the distance
  std::vector<double> normal_rad;  // where the aspect is below .95
  std::vector<double> squared;     // normalised, of the right solution
  int estimates = 0;
  int frames = 0;
  int tilted = 0;  // by 10 degrees and more
  int wrong = 0;   // of these, the other solution
};

// A descent to the pad with roughly constant tilt and azimuth.
class Approach {
 public:
  explicit Approach(Random& random)
      : tilt_(random.between(0.0, std::numbers::pi / 3.0)),
        side_(random.between(0.0, 6.28)),
        roll_(random.between(0.0, 6.28)),
        phase_(random.between(0.0, 6.0)),
        aim_(random.between(-0.12, 0.12), random.between(-0.08, 0.08), 0.0) {}

  [[nodiscard]] CameraPose at(int frame) const {
    const double time = frame / 30.0 + phase_;
    const double distance = 20.0 * std::pow(1.34 / 20.0, frame / (kFrames - 1.0));  // radii
    const double tilt = tilt_ + 0.03 * std::sin(2.0 * time);
    const double side = side_ + 0.05 * std::sin(1.3 * time);
    CameraPose pose;
    pose.position =
        distance *
        Vector3d(std::sin(tilt) * std::cos(side), std::sin(tilt) * std::sin(side), std::cos(tilt));
    const Vector3d sway(0.03 * std::sin(1.7 * time), 0.03 * std::cos(1.1 * time), 0.0);
    pose.looks_at = distance * (aim_ + sway);
    pose.roll_rad = roll_ + 0.1 * std::sin(time);
    return pose;
  }

 private:
  double tilt_;
  double side_;
  double roll_;
  double phase_;
  Vector3d aim_;
};

void compare(const TargetPose& pose, const Ellipse& outline, const Matrix3d& view, Errors& errors) {
  Matrix3d plane = Camera::with_hfov(kHfovRad, kWidth, kHeight).matrix().inverse() * view;
  plane *= kRadius_m / plane.col(0).norm();
  const Vector3d truth = plane.col(2);
  const Vector3d normal = plane.col(0).cross(plane.col(1)).normalized();
  const Vector3d bearing = truth.normalized();
  const Vector3d error = pose.position_m - truth;
  errors.aside.push_back((error - error.dot(bearing) * bearing).norm() / truth.norm());
  errors.depth.push_back(std::abs(error.dot(bearing)) / truth.norm());
  const double off = angle_between(pose.normal, normal);
  if (outline.semi_minor < 0.95 * outline.semi_major) errors.normal_rad.push_back(off);
  const bool is_right = off <= angle_between(pose.other_normal, normal);
  if (angle_between(normal, -bearing) >= std::numbers::pi / 18.0) {
    ++errors.tilted;
    errors.wrong += is_right ? 0 : 1;
  }
  const Vector3d best = is_right ? error : Vector3d(pose.other_position_m - truth);
  errors.squared.push_back(best.dot(pose.covariance_m2.inverse() * best));
}

void fly(std::uint64_t seed, Pattern pattern, Errors& errors) {
  Scene scene = scene_by_name("approach", seed);
  scene.sensor.read_noise = 3.0;
  scene.sensor.shot_noise = 0.0;
  scene.pad.pattern = pattern;
  SceneRenderer renderer(scene);
  Random random(seed);
  const Approach approach(random);
  TrackerSettings settings;
  settings.hfov_rad = kHfovRad;
  settings.target_diameter_m = 2.0 * kRadius_m;
  Tracker tracker(settings);
  support::GrayPicture picture(kWidth, kHeight);
  for (int frame = 0; frame < kFrames; ++frame) {
    const Matrix3d view = image_from_pad(approach.at(frame), kHfovRad, kWidth, kHeight);
    (void)renderer.render(view, static_cast<std::uint64_t>(frame), picture.writable());
    const auto target =
        tracker.process(picture.view(), static_cast<std::int64_t>(frame * 1e9 / 30));
    ++errors.frames;
    if (!target || !target->pose) continue;
    ++errors.estimates;
    compare(*target->pose, target->ellipse, view, errors);
  }
}

TEST(PoseRegression, ErrorsStayWithinLimitsFromFifteenMetresToOne) {
  Errors errors;
  for (int i = 0; i < kFlights; ++i) {
    const Pattern pattern = i % 3 == 0   ? Pattern::kRingX
                            : i % 3 == 1 ? Pattern::kRing
                                         : Pattern::kRingH;
    fly(kSeed + static_cast<std::uint64_t>(i), pattern, errors);
  }
  const auto inside = std::count_if(errors.squared.begin(), errors.squared.end(), [](double e) {
    return e < support::kChiSquare3;
  });
  std::printf(
      "%d of %d frames; lateral %.5f, depth %.5f, normal %.4f rad (median); wrong %d of %d; "
      "normalised error squared: median %.2f, %.3f within 95 %%\n",
      errors.estimates,
      errors.frames,
      quantile(errors.aside, 0.5),
      quantile(errors.depth, 0.5),
      quantile(errors.normal_rad, 0.5),
      errors.wrong,
      errors.tilted,
      quantile(errors.squared, 0.5),
      static_cast<double>(inside) / static_cast<double>(errors.squared.size()));
  EXPECT_GE(errors.estimates, errors.frames * 98 / 100);
  EXPECT_LE(quantile(errors.aside, 0.5), 0.002);
  EXPECT_LE(quantile(errors.depth, 0.5), 0.01);
  EXPECT_LE(quantile(errors.aside, 0.95), 0.01);
  EXPECT_LE(quantile(errors.depth, 0.95), 0.02);
  EXPECT_LE(quantile(errors.normal_rad, 0.5), 1.5 * std::numbers::pi / 180.0);
  EXPECT_LE(errors.wrong, errors.tilted / 100);
  EXPECT_GE(inside, 0.92 * static_cast<double>(errors.squared.size()));
}

}  // namespace
}  // namespace ellipse
