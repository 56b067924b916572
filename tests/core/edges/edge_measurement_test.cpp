// SPDX-License-Identifier: MIT
#include "core/edges/edge_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/edges/chains.hpp"
#include "core/edges/outline_samples.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::Picture;
using support::plain_ring;
using support::rendered;

constexpr Ellipse kTruth{160.3, 120.6, 90.0, 65.0, 0.3};

Picture picture_of_disc(double blur_px, double noise, std::uint64_t seed) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  scene.pad.paint_level = 60.0;
  scene.ground.level = 160.0;
  scene.sensor.blur_px = blur_px;
  scene.sensor.read_noise = noise;
  scene.seed = seed;
  return rendered(scene, kTruth, 320, 240);
}

// RMS of the errors over their standard deviations, around a disc.
double errors_over_sigma(double blur_px, double noise) {
  double squares = 0.0;
  double count = 0.0;
  EdgeMeasurer measurer;
  GradientMap map;
  ChainTracer chains;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Picture picture = picture_of_disc(blur_px, noise, seed);
    map.compute(picture.view());
    chains.trace(map);
    (void)measurer.measure(map, kTruth, Polarity::kDarkInside, 256, 2);
    for (const EdgeMeasurement& edge : measurer.edges()) {
      const double error = edge.offset.distance_px / edge.sigma_px;
      squares += error * error;
      count += 1.0;
    }
  }
  EXPECT_GT(count, 8 * 200.0) << blur_px << ' ' << noise;
  return std::sqrt(squares / count);
}

TEST(EdgeMeasurer, ReportsItsStandardDeviation) {
  for (const double noise : {1.0, 2.0, 4.0, 8.0, 14.0}) {
    for (const double blur : {0.6, 1.0, 1.5}) {
      EXPECT_NEAR(errors_over_sigma(blur, noise), 1.025, 0.12) << blur << ' ' << noise;
    }
    // Edges so soft that noise splits one maximum into several.
    EXPECT_NEAR(errors_over_sigma(2.5, noise), noise < 8.0 ? 1.08 : 1.28, 0.12) << noise;
  }
}

TEST(EdgeMeasurer, MatchesEdgesOfBothPolaritiesIfMixed) {
  const Ellipse truth{160.3, 120.6, 50.0, 50.0, 0.0};
  const Picture ball = support::lit_ball(truth, 320, 240);
  GradientMap map;
  ChainTracer chains;
  map.compute(ball.view());
  chains.trace(map);
  EdgeMeasurer measurer;
  EXPECT_LT(measurer.measure(map, truth, Polarity::kDarkInside, 64, 2).support, 0.6);
  EXPECT_LT(measurer.measure(map, truth, Polarity::kBrightInside, 64, 2).support, 0.6);
  EXPECT_GT(measurer.measure(map, truth, Polarity::kMixed, 64, 2).support, 0.8);
  for (const EdgeMeasurement& edge : measurer.edges()) {
    if (std::abs(edge.normal.y()) < 0.5F) continue;  // little contrast
    EXPECT_EQ(edge.is_bright_inside, edge.normal.y() < 0.0F);
    EXPECT_NEAR(edge.direction_error_rad, 0.0F, 0.1F);
    EXPECT_NEAR(edge.offset.distance_px, 0.0F, 0.3F);
  }
  EXPECT_GT(measurer.measure(ball.view(), truth, Polarity::kMixed, 64, 10.0).support, 0.8);
}

// Edges all around an outline, as sharp as `sharpness_of` their normal.
template <class SharpnessOf>
OutlineSharpness sharpness_around(const Eigen::Vector2f& motion_px,
                                  const SharpnessOf& sharpness_of) {
  OutlineSharpness sharpness(motion_px);
  for (const Eigen::Vector2f& normal : circle_directions(64)) {
    sharpness.add(normal, sharpness_of(normal));
  }
  sharpness.solve();
  return sharpness;
}

TEST(OutlineSharpness, FollowsTheMotionBlur) {
  const Eigen::Vector2f motion(6.0F, 0.0F);
  const auto blurred = [](const Eigen::Vector2f& n) { return 0.5F - 0.4F * n.x() * n.x(); };
  const OutlineSharpness sharpness = sharpness_around(motion, blurred);
  EXPECT_NEAR(sharpness.max(), 0.5F, 1e-4F);
  EXPECT_NEAR(sharpness.loss_at({0.0F, 1.0F}), 1.0F, 1e-4F);
  EXPECT_NEAR(sharpness.loss_at({0.6F, 0.8F}), 0.5F / blurred({0.6F, 0.8F}), 1e-3F);
  // As blurred as motion during the whole time can make it: a variance of 6^2 / 12 px^2.
  EXPECT_NEAR(sharpness.loss_at({1.0F, 0.0F}), 1.0F + 0.5F * 36.0F / 12.0F, 1e-3F);
}

TEST(OutlineSharpness, DoesNotTakeOtherBlurForMotionBlur) {
  const auto blurred = [](const Eigen::Vector2f& n) { return 0.5F - 0.4F * n.x() * n.x(); };
  const OutlineSharpness at_rest = sharpness_around({0.0F, 0.0F}, blurred);
  EXPECT_NEAR(at_rest.max(), 0.3F, 1e-4F);  // the mean
  EXPECT_EQ(at_rest.loss_at({1.0F, 0.0F}), 1.0F);
  // Motion of a pixel hardly blurs.
  const OutlineSharpness slow = sharpness_around({1.0F, 0.0F}, blurred);
  EXPECT_LT(slow.loss_at({1.0F, 0.0F}), 1.05F);
  // Motion along y does not blur the edges across x.
  const OutlineSharpness across = sharpness_around({0.0F, 6.0F}, blurred);
  EXPECT_EQ(across.loss_at({1.0F, 0.0F}), 1.0F);
  EXPECT_EQ(across.loss_at({0.0F, 1.0F}), 1.0F);
  // Scatter that happens to be larger along x.
  int k = 0;
  const auto scattered = [&](const Eigen::Vector2f& n) {
    return 0.5F - 0.05F * n.x() * n.x() + (++k % 3 == 0 ? 0.3F : -0.15F);
  };
  EXPECT_EQ(sharpness_around({6.0F, 0.0F}, scattered).loss_at({1.0F, 0.0F}), 1.0F);
  // Without edges.
  EXPECT_EQ(OutlineSharpness(Eigen::Vector2f(6.0F, 0.0F)).loss_at({1.0F, 0.0F}), 1.0F);
}

}  // namespace
}  // namespace ellipse
