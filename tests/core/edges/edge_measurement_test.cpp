// SPDX-License-Identifier: MIT
#include "core/edges/edge_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/edges/chains.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::plain_ring;
using support::rendered;

constexpr Ellipse kTruth{160.3, 120.6, 90.0, 65.0, 0.3};

GrayPicture picture_of_disc(double blur_px, double noise, std::uint64_t seed) {
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
    const GrayPicture picture = picture_of_disc(blur_px, noise, seed);
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

TEST(EdgeMeasurer, FindsTheVarianceOfDefocus) {
  EdgeMeasurer measurer;
  EXPECT_EQ(measurer.defocus_variance(), 0.0F);
  for (const double blur_px : {0.6, 1.0, 1.6, 2.5}) {
    const GrayPicture picture = picture_of_disc(blur_px, 1.0, 1);
    (void)measurer.measure(picture.view(), kTruth, Polarity::kDarkInside, 96, 200.0);
    const double defocus = blur_px * blur_px - kLensVariance;
    EXPECT_NEAR(measurer.defocus_variance(), defocus, 0.15 * defocus + 0.05) << blur_px;
  }
}

// Blur moves the gradient maxima of a curved edge inwards by half of its variance over the radius.
TEST(EdgeMeasurer, CorrectsTheShiftOfDefocusedEdges) {
  const Ellipse truth{60.3, 60.6, 18.0, 18.0, 0.0};
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  scene.sensor.blur_px = 2.0;
  scene.sensor.read_noise = 1.0;
  const GrayPicture picture = rendered(scene, truth, 120, 120);
  EdgeMeasurer measurer;
  (void)measurer.measure(picture.view(), truth, Polarity::kDarkInside, 96, 200.0);
  double sum_px = 0.0;
  for (const EdgeMeasurement& edge : measurer.edges()) sum_px += edge.offset.distance_px;
  const auto count = static_cast<double>(measurer.edges().size());
  EXPECT_GT(count, 90.0);
  EXPECT_NEAR(sum_px / count, 0.0, 0.03);
}

TEST(EdgeMeasurer, MatchesEdgesOfBothPolaritiesIfMixed) {
  const Ellipse truth{160.3, 120.6, 50.0, 50.0, 0.0};
  const GrayPicture ball = support::lit_ball(truth, 320, 240);
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

GrayPicture blurred_disc(const Ellipse& e, int length_px) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  return support::blurred_by_motion(e, length_px, [&](const Ellipse& at, int k) {
    return rendered(scene, at, 200, 160, std::uint64_t(k));
  });
}

// The centroid is over at least 2 x 9 + 1 pixels instead of 2 x 3 + 1.
TEST(EdgeMeasurer, IsLessSureOfEdgesBlurredByMotion) {
  const Ellipse truth{100.0, 80.0, 60.0, 50.0, 0.0};
  const GrayPicture picture = blurred_disc(truth, 12);
  EdgeMeasurer measurer;
  measurer.measure({picture.view(), {}}, truth, Polarity::kMixed, 64, 200.0, {36.0F, 0.0F});
  int across = 0;
  for (const EdgeMeasurement& edge : measurer.edges()) {
    if (std::abs(edge.normal.x()) > 0.99F) {
      ++across;
      EXPECT_GE(edge.sigma_px, 0.99 * std::pow(19.0 / 7.0, 1.5) * kVertexError);
    } else if (std::abs(edge.normal.y()) > 0.999F) {
      EXPECT_LT(edge.sigma_px, 2.0F * kVertexError);
    }
  }
  EXPECT_GT(across, 4);
}

// Of a view into a larger picture.
TEST(EdgeMeasurer, ReadsNothingOutsideThePictureInMotionBlur) {
  const Ellipse truth{100.0, 80.0, 92.0, 60.0, 0.0};
  const GrayPicture inside = blurred_disc(truth, 12);
  std::vector<Eigen::Vector2f> points[2];
  for (int i = 0; i < 2; ++i) {
    GrayPicture around(240, 160);
    for (int y = 0; y < 160; ++y) {
      for (int x = 0; x < 240; ++x) {
        const bool is_inside = x >= 20 && x < 220;
        around.at(x, y) = is_inside ? inside.pixels[std::size_t(200 * y + x - 20)]
                                    : static_cast<std::uint8_t>(i * 255 * (x & 1));
      }
    }
    const ImageView view{around.pixels.data() + 20, 200, 160, 240};
    EdgeMeasurer measurer;
    measurer.measure({view, {}}, truth, Polarity::kMixed, 64, 200.0, {36.0F, 0.0F});
    for (const EdgeMeasurement& edge : measurer.edges()) points[i].push_back(edge.point);
  }
  EXPECT_GT(points[0].size(), 40U);
  EXPECT_EQ(points[0], points[1]);
}

}  // namespace
}  // namespace ellipse
