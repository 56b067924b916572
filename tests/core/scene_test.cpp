// SPDX-License-Identifier: MIT
#include "core/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::Picture;

Scene clean_disc() {
  Scene scene = support::plain_ring();
  scene.pattern = Pattern::kDisc;
  scene.noise = 0.0;
  return scene;
}

TEST(Scene, DarkAreaIsTheEllipsesArea) {
  // Each pixel's share of paint adds up to the area of the disc.
  const Scene scene = clean_disc();
  const Ellipse truth{80.3, 70.6, 50.0, 25.0, 0.7};
  const Picture picture = support::rendered(scene, truth, 160, 140);
  double area = 0.0;
  for (const std::uint8_t level : picture.pixels) {
    area += (scene.ground_level - level) / (scene.ground_level - scene.paint_level);
  }
  EXPECT_NEAR(area / (std::acos(-1.0) * 50.0 * 25.0), 1.0, 2e-3);
}

TEST(Scene, DarkAreasCentroidIsTheTruthsCentre) {
  const Scene scene = clean_disc();
  const Ellipse truth{80.3, 70.6, 40.0, 30.0, -0.4};
  const Picture picture = support::rendered(scene, truth, 160, 140);
  Eigen::Vector2d sum(0.0, 0.0);
  double weight = 0.0;
  for (int y = 0; y < 140; ++y) {
    for (int x = 0; x < 160; ++x) {
      const double share = scene.ground_level - picture.view().row(y)[x];
      sum += share * Eigen::Vector2d(x, y);
      weight += share;
    }
  }
  EXPECT_NEAR(sum.x() / weight, truth.cx, 0.01);
  EXPECT_NEAR(sum.y() / weight, truth.cy, 0.01);
}

TEST(Scene, ProjectedCircleLiesOnProjectedPoints) {
  const Eigen::Matrix3d view = image_from_pad(approach_pose(3.0, 10.0), 1.0, 640, 360);
  const auto e = project_circle(view, 1.0);
  ASSERT_TRUE(e);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d p = view * Eigen::Vector3d(std::cos(0.5 * i), std::sin(0.5 * i), 1.0);
    EXPECT_NEAR(sampson_distance(*e, p.head<2>() / p.z()), 0.0, 1e-9);
  }
}

TEST(Scene, CircleThatReachesBehindTheCameraIsNoEllipse) {
  CameraPose pose;
  pose.position = {0.0, -0.5, 0.1};
  pose.looks_at = {0.0, 1.0, 0.1};
  EXPECT_FALSE(project_circle(image_from_pad(pose, 1.0, 640, 360), 1.0));
}

TEST(Scene, SeedAndFrameDecideTheNoise) {
  const Ellipse e{40.0, 40.0, 20.0, 20.0, 0.0};
  Scene scene;
  const Picture a = support::rendered(scene, e, 80, 80, 3);
  EXPECT_EQ(a.pixels, support::rendered(scene, e, 80, 80, 3).pixels);
  EXPECT_NE(a.pixels, support::rendered(scene, e, 80, 80, 4).pixels);
  scene.seed = 2;
  EXPECT_NE(a.pixels, support::rendered(scene, e, 80, 80, 3).pixels);
}

TEST(Scene, NoiseHasItsStandardDeviation) {
  Scene scene = support::plain_ring();
  scene.ground_level = 128.0;
  scene.noise = 5.0;
  const Picture picture = support::rendered(scene, {-500.0, 0.0, 10.0, 10.0, 0.0}, 200, 200);
  double sum = 0.0;
  for (const std::uint8_t level : picture.pixels) sum += (level - 128.0) * (level - 128.0);
  EXPECT_NEAR(std::sqrt(sum / 40000.0), 5.0, 0.1);
}

}  // namespace
}  // namespace ellipse
