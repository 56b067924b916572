// SPDX-License-Identifier: MIT
//
// The stages of the arc detector, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/detection/arcs/arcs.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/scene/random.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::plain_ring;
using support::rendered;

GrayPicture random_picture(int width, int height, std::uint64_t seed) {
  GrayPicture picture(width, height);
  Random random(seed);
  for (std::uint8_t& level : picture.pixels) level = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

Scene disc(double paint = 55.0) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  scene.pad.paint_level = paint;
  scene.ground.level = 140.0;
  scene.sensor.read_noise = 1.0;
  return scene;
}

TEST(GradientMap, EqualsTheConvolution) {
  const GrayPicture picture = random_picture(61, 23, 3);
  constexpr int kSmooth[5] = {1, 4, 6, 4, 1};
  constexpr int kDifference[5] = {-1, -2, 0, 2, 1};
  GradientMap map;
  map.compute(picture.view());
  for (int y = 3; y < 20; ++y) {
    for (int x = 3; x < 59; ++x) {
      int gx = 0;
      int gy = 0;
      for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i) {
          const int level = picture.view().row(y + j - 2)[x + i - 2];
          gx += kSmooth[j] * kDifference[i] * level;
          gy += kDifference[j] * kSmooth[i] * level;
        }
      }
      const Gradient& g = map.gradients()[y * map.stride() + x];
      ASSERT_EQ(g.x, gx);
      ASSERT_EQ(g.y, gy);
      for (const bool is_row : {false, true}) {
        std::array<Gradient, 2> line;
        gradients_along(picture.view(), is_row ? x - 1 : x, is_row ? y : y - 1, is_row, line);
        ASSERT_EQ(line[1].x, gx);
        ASSERT_EQ(line[1].y, gy);
      }
    }
  }
}

TEST(GradientMap, IsTheSameWithEachInstructionSet) {
  if (best_simd() == Simd::kBaseline) GTEST_SKIP() << "this processor has one kind only";
  for (const int width : {1, 5, 31, 32, 33, 97, 321}) {
    const GrayPicture picture = rendered(disc(), {width / 2.0, 20.0, 15.0, 10.0, 0.4}, width, 41);
    GradientMap baseline(Simd::kBaseline);
    GradientMap best(best_simd());
    baseline.compute(picture.view());
    best.compute(picture.view());
    ASSERT_EQ(baseline.thresholds().low, best.thresholds().low);
    for (int i = 0; i < baseline.stride() * 41; ++i) {
      ASSERT_EQ(baseline.maxima()[i], best.maxima()[i]) << width;
      ASSERT_EQ(baseline.gradients()[i].x, best.gradients()[i].x) << width;
      ASSERT_EQ(baseline.gradients()[i].y, best.gradients()[i].y) << width;
    }
  }
}

TEST(GradientMap, MeasuresTheNoise) {
  // The norm of a 5 x 5 kernel is sqrt(70 x 10) = 26.5.
  for (const double noise : {2.0, 5.0, 14.0}) {
    Scene scene = plain_ring();
    scene.sensor.read_noise = noise;
    scene.ground.level = 128.0;
    const GrayPicture picture = rendered(scene, {-90.0, 0.0, 5.0, 5.0, 0.0}, 320, 240);
    GradientMap map;
    map.compute(picture.view());
    EXPECT_NEAR(map.noise() / (26.5 * noise), 1.0, 0.15) << noise;
    EXPECT_NEAR(map.thresholds().low, 3.0 * map.noise() / kGradientGain, 1e-9);
    EXPECT_NEAR(map.thresholds().high, 2.0 * map.thresholds().low, 1e-9);
  }
}

// Rounding turns slow shading into steps of one grey level.
TEST(GradientMap, HasNoSeedsOnAStepOfOneGreyLevel) {
  GrayPicture picture(64, 64, 100);
  for (int y = 0; y < 64; ++y) {
    for (int x = 32; x < 64; ++x) picture.at(x, y) = 101;
  }
  GradientMap map;
  map.compute(picture.view());
  for (int i = 0; i < 64 * map.stride(); ++i) EXPECT_EQ(map.maxima()[i] & maximum::kSeed, 0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 32; x < 64; ++x) picture.at(x, y) = 104;
  }
  map.compute(picture.view());
  EXPECT_NE(map.maxima()[32 * map.stride() + 32] & maximum::kSeed, 0);
}

TEST(GradientMap, UsesGivenThresholds) {
  const GrayPicture picture = random_picture(40, 40, 1);
  GradientMap map;
  const auto expect = [&](EdgeThresholds given, double low, double high) {
    map.compute(picture.view(), given);
    EXPECT_EQ(map.thresholds().low, low);
    EXPECT_EQ(map.thresholds().high, high);
  };
  expect({3.0, 4.0}, 3.0, 4.0);
  expect({3.0, 0.0}, 3.0, 6.0);
  expect({0.0, 4.0}, 2.0, 4.0);
}

TEST(GradientMap, HasNoMaximaNearTheBorderOrInTinyPictures) {
  for (const int width : {1, 2, 6, 7, 40}) {
    for (const int height : {1, 2, 6, 7, 40}) {
      const GrayPicture picture = random_picture(width, height, 5);
      GradientMap map;
      map.compute(picture.view(), {0.1, 0.1});
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < map.stride(); ++x) {
          const bool is_inside = x >= 3 && y >= 3 && x < width - 3 && y < height - 3;
          if (!is_inside) {
            ASSERT_EQ(map.maxima()[y * map.stride() + x], 0);
          }
        }
      }
    }
  }
}

TEST(GradientMap, HasNoBlocksOfAnEarlierPicture) {
  const GrayPicture picture = random_picture(40, 40, 5);
  GradientMap map;
  map.compute(picture.view());
  EXPECT_FALSE(map.blocks().empty());
  map.compute(ImageView{});
  EXPECT_TRUE(map.blocks().empty());
}

struct Traced {
  explicit Traced(const GrayPicture& picture) {
    map.compute(picture.view());
    chains.trace(map);
    arcs = splitter.split(map, chains);
  }
  GradientMap map;
  ChainTracer chains;
  ArcSplitter splitter;
  std::span<Arc> arcs;
};

TEST(ChainTracer, MakesOneChainOfADisc) {
  const Traced traced(rendered(disc(), {100.0, 80.0, 50.0, 35.0, 0.3}, 200, 160));
  ASSERT_EQ(traced.chains.size(), 1U);
  EXPECT_GT(traced.chains.chain(0).size(), 200U);
  for (const std::int32_t pixel : traced.chains.chain(0)) {
    EXPECT_NE(traced.map.maxima()[pixel] & maximum::kChained, 0);
  }
}

// A vertical edge whose contrast falls from row to row.
TEST(ChainTracer, ContinuesBelowTheHighThreshold) {
  GrayPicture picture(60, 120, 100);
  for (int y = 0; y < 120; ++y) {
    for (int x = 30; x < 60; ++x) picture.at(x, y) = static_cast<std::uint8_t>(220 - y);
  }
  const auto longest_chain = [&](EdgeThresholds thresholds) {
    GradientMap map;
    map.compute(picture.view(), thresholds);
    ChainTracer chains;
    chains.trace(map);
    return chains.size() == 1 ? chains.chain(0).size() : 0;
  };
  // 48 units of Gradient are 0.375 grey levels per pixel and grey level of the step.
  const std::size_t above_30 = longest_chain({11.25, 11.25});
  EXPECT_NEAR(static_cast<double>(above_30), 87.0, 3.0);
  EXPECT_NEAR(static_cast<double>(longest_chain({7.5, 11.25})), 97.0, 3.0);
  EXPECT_EQ(longest_chain({7.5, 60.0}), 0U);
}

TEST(ChainTracer, BridgesAGapOfOnePixel) {
  GrayPicture picture(120, 60, 140);
  for (int y = 0; y < 60; ++y) {
    for (int x = 60; x < 120; ++x) picture.at(x, y) = 40;
  }
  GradientMap map;
  map.compute(picture.view());
  for (int x = 0; x < map.stride(); ++x) map.maxima()[30 * map.stride() + x] = 0;
  ChainTracer chains;
  chains.trace(map);
  EXPECT_EQ(chains.size(), 1U);
}

TEST(ArcSplitter, DeterminesThePolarity) {
  const Ellipse e{100.0, 80.0, 50.0, 35.0, 0.3};
  for (const double paint : {40.0, 230.0}) {
    const Traced traced(rendered(disc(paint), e, 200, 160));
    ASSERT_EQ(traced.arcs.size(), 2U);  // the arc, and the closed chain as a whole
    for (const Arc& arc : traced.arcs) {
      EXPECT_EQ(arc.polarity, paint < 140.0 ? Polarity::kDarkInside : Polarity::kBrightInside);
      const auto fit = fit_ellipse(arc.moments);
      ASSERT_TRUE(fit);
      EXPECT_LT(max_difference_px(*fit, e), 0.2);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GT(arc.inwards[k].dot(e.center() - arc.points[k]), 0.0);
      }
    }
  }
}

TEST(ArcSplitter, CutsAtCorners) {
  GrayPicture picture(120, 100, 150);
  for (int y = 30; y < 70; ++y) {
    for (int x = 30; x < 90; ++x) picture.at(x, y) = 40;
  }
  const Traced traced(picture);
  EXPECT_FALSE(traced.arcs.empty());  // the closed chain as a whole, and straight lines
  for (const Arc& arc : traced.arcs) {
    const bool is_whole = arc.end - arc.begin > 150;
    EXPECT_TRUE(is_whole || arc.inwards.front().dot(arc.inwards.back()) > std::cos(0.5));
  }
}

TEST(ArcSplitter, CutsWhereTheCurvatureChangesItsSign) {
  // The upper side of a dark ground is a wave.
  GrayPicture picture(260, 120, 150);
  for (int x = 0; x < 260; ++x) {
    const double edge = 60.0 + 25.0 * std::sin(2.0 * std::numbers::pi * x / 130.0);
    for (int y = 0; y < 120; ++y) {
      const double share = std::clamp(y - edge + 0.5, 0.0, 1.0);
      picture.at(x, y) = static_cast<std::uint8_t>(150.0 - 100.0 * share);
    }
  }
  const Traced traced(picture);
  int dark_inside = 0;
  for (const Arc& arc : traced.arcs) dark_inside += arc.polarity == Polarity::kDarkInside ? 1 : 0;
  EXPECT_EQ(dark_inside, 2);
  EXPECT_EQ(traced.arcs.size() - 2U, 2U);
}

TEST(MomentFit, AddsMomentsAndReportsTheResidual) {
  const Ellipse e{120.0, 90.0, 60.0, 30.0, 0.4};
  Random random(9);
  Moments first(Eigen::Vector2d(100.0, 100.0));
  Moments second(Eigen::Vector2d(100.0, 100.0));
  Moments all(Eigen::Vector2d(100.0, 100.0));
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d on = e.point_at(i * 0.0157);
    const double off = 0.5 * (random.unit() + random.unit() + random.unit() - 1.5) * 2.0;
    const Eigen::Vector2d p = on + off * (on - e.center()).normalized();
    (i < 150 ? first : second).add(p);
    all.add(p);
  }
  first.add(second);
  const auto fit = fit_with_residual(first);
  ASSERT_TRUE(fit);
  EXPECT_LT(max_difference_px(fit->ellipse, fit_with_residual(all)->ellipse), 1e-6);
  EXPECT_NEAR(fit->rms_px, 0.5, 0.06);  // a standard deviation of .5 along the radius
}

TEST(EdgeMeasurer, CountsEdgesOfTheRightPolarity) {
  const Ellipse e{100.0, 80.0, 50.0, 35.0, 0.3};
  const Traced traced(rendered(disc(), e, 200, 160));
  EdgeMeasurer measurer;
  const OutlineSupport found = measurer.measure(traced.map, e, Polarity::kDarkInside, 128, 2);
  EXPECT_GT(found.support, 0.99);
  EXPECT_GT(found.turn_support, 0.99);
  EXPECT_EQ(found.inside_fraction, 1.0);
  EXPECT_EQ(found.inside_turn_fraction, 1.0);
  EXPECT_EQ(measurer.measure(traced.map, e, Polarity::kBrightInside, 128, 2).support, 0.0);
  const Ellipse other = translated(e, 0.0, 9.0);
  EXPECT_LT(measurer.measure(traced.map, other, Polarity::kDarkInside, 128, 2).support, 0.3);
}

TEST(EdgeMeasurer, CountsInsideThePictureOnly) {
  const Ellipse e{0.0, 80.0, 50.0, 40.0, 0.0};
  const Traced traced(rendered(disc(), e, 200, 160));
  EdgeMeasurer measurer;
  const OutlineSupport found = measurer.measure(traced.map, e, Polarity::kDarkInside, 128, 2);
  EXPECT_NEAR(found.inside_fraction, 0.46, 0.05);
  EXPECT_NEAR(found.inside_turn_fraction, 0.5, 0.03);
  EXPECT_GT(found.support, 0.95);
  // Above and below the picture are the ends of a long ellipse, and with them most of its turn: the
  // normals inside are within atan(b / a tan(t)) of a row, where sin(t) = 80 / a.
  const Ellipse upright{100.0, 79.5, 120.0, 40.0, 0.5 * std::numbers::pi};
  const double shown = std::atan(40.0 / 120.0 * std::tan(std::asin(80.0 / 120.0)));
  const OutlineSupport sides = measurer.measure(traced.map, upright, Polarity::kDarkInside, 256, 2);
  // The outermost pixels have no gradient.
  EXPECT_NEAR(sides.inside_turn_fraction, shown / (0.5 * std::numbers::pi), 0.02);
}

// A lens compresses the margin of the picture, but does not change the ellipse's turn.
TEST(OutlineSamples, TurnInTheIdealPlane) {
  const Lens lens(support::fisheye());
  const Ellipse e{300.0, 170.0, 240.0, 90.0, 0.3};
  const OutlineSamples distorted(e, 64, lens);
  const OutlineSamples ideal(e, 64, {});
  ASSERT_GT((distorted.point(0) - ideal.point(0)).norm(), 10.0);
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    EXPECT_NEAR(distorted.turn(k) / ideal.turn(k), 1.0, 1e-4) << k;
  }
}

TEST(PictureRefinement, FindsTheEdgeFromAPixelAway) {
  const Ellipse truth{100.3, 80.6, 50.0, 30.0, 0.3};
  const GrayPicture picture = rendered(disc(), truth, 200, 160);
  Ellipse start = translated(truth, 0.8, -0.7);
  start.semi_major += 0.8;
  const auto refined = refined_on_picture(picture.view(), start, Polarity::kDarkInside, 200.0);
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 0.03);
  EXPECT_FALSE(refined_on_picture(picture.view(), start, Polarity::kBrightInside, 200.0));
}

// Glare on the right half clips the picture, which moves its edges towards the dark disc.
TEST(PictureRefinement, GivesEdgesBesideSaturatedPixelsLittleWeight) {
  const Ellipse truth{100.3, 80.6, 50.0, 30.0, 0.3};
  GrayPicture picture = rendered(disc(), truth, 200, 160);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      std::uint8_t& level = picture.pixels[static_cast<std::size_t>(y * picture.width + x)];
      const int glare = std::clamp(4 * (x - 90), 0, 180);
      level = static_cast<std::uint8_t>(std::min(255, level + glare));
    }
  }
  const auto refined = refined_on_picture(picture.view(), truth, Polarity::kDarkInside, 200.0);
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 0.1);
}

// @param motion_px  As of motion_blur().
std::optional<FittedEllipse> refined_in_motion(const GrayPicture& picture,
                                               const Ellipse& start,
                                               const Eigen::Vector2f& motion_px) {
  EdgeMeasurer measurer;
  (void)measurer.measure(
      picture.view(), start, Polarity::kDarkInside, kRefinementSamples, 200.0, motion_px);
  return fitted_to_edges(measurer, {}, start);
}

// The gradient of the edges across the motion is even over its length; it has no clear maximum.
TEST(PictureRefinement, FindsTheMeanPositionOfEdgesBlurredByMotion) {
  const Ellipse truth{100.3, 80.6, 40.0, 36.0, 0.0};
  Scene scene = disc();
  scene.sensor.read_noise = 6.0;
  for (scene.seed = 1; scene.seed <= 20; ++scene.seed) {
    const GrayPicture picture = support::blurred_by_motion(truth, 12, [&](const Ellipse& e, int k) {
      return rendered(scene, e, 200, 160, std::uint64_t(k));
    });
    const Ellipse start = translated(truth, 0.8, -0.5);
    const auto error_px = [&](const Eigen::Vector2f& motion_px) {
      const auto refined = refined_in_motion(picture, start, motion_px);
      return refined ? max_difference_px(refined->ellipse, truth) : 1e9;
    };
    EXPECT_LT(error_px({36.0F, 0.0F}), 0.15) << scene.seed;
    EXPECT_GT(error_px({0.0F, 0.0F}), 0.25) << scene.seed;
  }
}

// The range of this lens ends inside the picture, across the disc.
TEST(PictureRefinement, IgnoresEdgesOutsideTheRangeOfTheLens) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 320.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.distortion = {-0.35};
  const Lens lens(camera);
  const Ellipse truth{500.0, 240.0, 114.0, 90.0, 0.0};
  GrayPicture picture(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d ideal = LensView(lens).approximate_ideal({double(x), double(y)});
      const bool is_known = ideal.allFinite();  // the disc ends a pixel beyond the range
      const double inside = is_known ? 0.5 - sampson_distance(truth, ideal) : 529.0 - x;
      picture.pixels[std::size_t(y * camera.width + x)] =
          static_cast<std::uint8_t>(200.0 - 150.0 * std::clamp(inside, 0.0, 1.0));
    }
  }
  EdgeMeasurer measurer;
  const Picture distorted(picture.view(), lens);
  (void)measurer.measure(distorted, truth, Polarity::kDarkInside, kRefinementSamples, 200.0);
  const auto edges = measurer.edges();
  const auto outside = std::count_if(edges.begin(), edges.end(), [&](const EdgeMeasurement& edge) {
    const Eigen::Vector2d point = measurer.origin() + edge.point.cast<double>();
    return !LensView(lens).approximate_ideal(point).allFinite();
  });
  EXPECT_GT(outside, 0);
  const auto refined = fitted_to_edges(measurer, lens, truth);
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 1.0);
  EXPECT_TRUE(refined->uncertainty.information.allFinite());
}

// Where the line of pixels would leave the picture, the maximum counts.
TEST(PictureRefinement, SurvivesMotionBlurAtTheBorder) {
  const Ellipse truth{100.0, 80.0, 92.0, 60.0, 0.0};
  const Scene scene = disc();
  const GrayPicture picture = support::blurred_by_motion(truth, 12, [&](const Ellipse& e, int k) {
    return rendered(scene, e, 200, 160, std::uint64_t(k));
  });
  const auto refined = refined_in_motion(picture, truth, {1e6F, 0.0F});
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 0.5);
}

}  // namespace
}  // namespace ellipse
