// SPDX-License-Identifier: MIT
#include "core/detection/arcs/arc_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/detection/detection_trace.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/target_selection.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/polygon.hpp"
#include "core/scene/random.hpp"
#include "tests/support/finding.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::best_iou;
using support::detecting;
using support::GrayPicture;
using support::plain_disc;
using support::plain_ring;
using support::rendered;

bool finds_nothing(const GrayPicture& picture) {
  ArcDetector detector;
  return detector.detect(picture.view(), detecting<ArcDetector>()).empty();
}

TEST(ArcDetector, FindsRingsOfEitherPolarity) {
  const Ellipse truth{160.2, 119.7, 70.0, 45.0, 0.6};
  Scene scene = plain_ring();
  EXPECT_GT(best_iou<ArcDetector>(rendered(scene, truth), truth, detecting<ArcDetector>()), 0.97);
  std::swap(scene.pad.paint_level, scene.ground.level);
  EXPECT_GT(best_iou<ArcDetector>(rendered(scene, truth), truth, detecting<ArcDetector>()), 0.97);
}

TEST(ArcDetector, FindsABallBrighterThanTheGroundAboveAndDarkerBelow) {
  const Ellipse truth{160.3, 120.6, 50.0, 50.0, 0.0};
  const GrayPicture ball = support::lit_ball(truth, 320, 240);
  EXPECT_GT(best_iou<ArcDetector>(ball, truth, detecting<ArcDetector>()), 0.97);
  ArcDetector detector;
  const auto odds = detector.log_odds_of({ball.view()}, truth, detecting<ArcDetector>());
  ASSERT_TRUE(odds);
  EXPECT_GT(*odds, 0.0);
}

// An ellipse along the edge of one half and the shading inside the other is accepted, but
// uncertain. It must not exclude the right one.
TEST(ArcDetector, FindsABallBesideAnUncertainFitToItsHalf) {
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.contour_overlap = thresholds.ellipse_overlap = 0.0;
  for (int x = 0; x < 60; ++x) {
    const Ellipse truth{130.3 + x, 120.6, 50.0, 50.0, 0.0};
    EXPECT_GT(best_iou<ArcDetector>(support::lit_ball(truth, 320, 240), truth, thresholds), 0.99)
        << x;
  }
}

// Brighter than the ground above its centre; darker below, where short pieces of the outline are
// visible. Only the upper half is an arc.
TEST(ArcDetector, MeasuresADoubtfulOutlineWithEdgesOfBothPolarities) {
  constexpr double kDash = 18.0;
  constexpr double kGap = 10.0;
  const Ellipse truth{160.3, 120.6, 60.0, 60.0, 0.0};
  GrayPicture picture(320, 240);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double from_centre = std::hypot(x - truth.cx, y - truth.cy);
      const double along = std::atan2(y - truth.cy, x - truth.cx) * truth.semi_major;
      const bool is_dash = std::fmod(along, kDash + kGap) < kDash;
      const double ground = along < 0.0 ? 80.0 : (is_dash ? 160.0 : 120.0);
      const double covered = std::clamp(truth.semi_major - from_centre + 0.5, 0.0, 1.0);
      picture.at(x, y) = static_cast<std::uint8_t>(ground + covered * (120.0 - ground));
    }
  }
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.contour_overlap = thresholds.ellipse_overlap = 0.0;
  ArcDetector detector;
  const auto found = detector.detect({picture.view()}, thresholds);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(iou_inside(found[0].ellipse, truth, picture.width, picture.height), 0.99);
  EXPECT_GT(found[0].probability, 0.95);
}

// 108 half discs, each with an arc that is longer than the outline of the disc below one of them.
TEST(ArcDetector, FindsASmallDiscAmongManyLongerArcs) {
  constexpr int kCell = 106;
  constexpr double kHalfDisc = 48.0;
  constexpr double kContrast = 70.0;
  for (int n = 0; n < 5; ++n) {
    const Ellipse truth{53.4 + kCell * 2 * n, 81.2 + kCell * n, 12.0, 12.0, 0.0};
    GrayPicture picture(12 * kCell, 9 * kCell);
    Random noise(1);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const int above = kCell / 2 - y % kCell;
        const double from_centre = std::hypot(x % kCell - kCell / 2, above);
        const double half = above < 0 ? 0.0 : std::clamp(kHalfDisc - from_centre, 0.0, 1.0);
        const double from_truth = std::hypot(x - truth.cx, y - truth.cy);
        const double disc = std::clamp(truth.semi_major - from_truth + 0.5, 0.0, 1.0);
        const double level = 80.0 + kContrast * std::max(half, disc) + 4.0 * noise.unit();
        picture.at(x, y) = static_cast<std::uint8_t>(level);
      }
    }
    ArcDetector detector;
    const auto target = select_target(detector.detect(picture.view(), detecting<ArcDetector>()));
    ASSERT_TRUE(target) << n;
    EXPECT_GT(iou_inside(target->ellipse, truth, picture.width, picture.height), 0.9) << n;
  }
}

// The slope of the ground is not noise, although its gradient exceeds that of the noise.
TEST(ArcDetector, FindsASoftFaintDiscInAShadedPicture) {
  const Ellipse truth{160.2, 119.7, 50.0, 42.0, 0.6};
  Scene scene = plain_disc();
  scene.pad.paint_level = 60.0;
  scene.ground.level = 80.0;
  scene.sensor.blur_px = 4.0;
  scene.sensor.read_noise = 1.0;
  GrayPicture picture = rendered(scene, truth);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      picture.at(x, y) = static_cast<std::uint8_t>(picture.at(x, y) + x / 2 - y / 8);
    }
  }
  EXPECT_GT(best_iou<ArcDetector>(picture, truth, detecting<ArcDetector>()), 0.95);
}

// Nearly all pixels are saturated, and most of the others are edges.
TEST(ArcDetector, FindsADrawnDiscInBlackAndWhite) {
  for (const double radius : {20.0, 40.0, 100.0}) {
    for (const int inside : {0, 255}) {
      const Ellipse truth{160.2, 119.7, radius, 0.7 * radius, 0.6};
      GrayPicture picture(320, 240);
      for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
          const double covered = std::clamp(0.5 - sampson_distance(truth, {x, y}), 0.0, 1.0);
          picture.at(x, y) = static_cast<std::uint8_t>(
              std::lround(covered * inside + (1.0 - covered) * (255 - inside)));
        }
      }
      EXPECT_GT(best_iou<ArcDetector>(picture, truth, detecting<ArcDetector>()), 0.97)
          << radius << ", " << inside;
    }
  }
}

// The ring is 4 px wide on its long sides and 8 px at its ends. The correction for thin rings does
// not apply.
TEST(ArcDetector, IsExactOnAFlatRingFoundInAReducedPicture) {
  GrayPicture picture(640, 360);
  ArcDetector detector;
  for (const std::uint64_t seed : {6U, 8U, 9U, 42U}) {
    SceneRenderer renderer(scene_by_name("oblique", seed));
    for (std::uint64_t frame = 0; frame < 15; ++frame) {
      const Truth truth =
          renderer.render(static_cast<double>(frame) / 30.0, frame, picture.writable());
      const auto target = select_target(detector.detect(picture.view(), detecting<ArcDetector>()));
      ASSERT_TRUE(target);
      EXPECT_LT(max_difference_px(target->ellipse, *truth.outer_edge), 0.1) << seed << " " << frame;
    }
  }
}

const Ellipse kNoisyDisc{160.2, 119.7, 50.0, 42.0, 0.6};

// At the full size the noise hides the edge.
GrayPicture noisy_disc(std::uint64_t seed) {
  Scene scene = plain_disc();
  scene.seed = seed;
  scene.pad.paint_level = 90.0;
  scene.ground.level = 125.0;
  scene.sensor.blur_px = 1.5;
  scene.sensor.read_noise = 25.0;
  return rendered(scene, kNoisyDisc);
}

TEST(ArcDetector, FindsADiscVisibleOnlyInReducedPictures) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    EXPECT_GT(best_iou<ArcDetector>(noisy_disc(seed), kNoisyDisc, detecting<ArcDetector>()), 0.9)
        << seed;
  }
}

TEST(ArcDetector, JudgesAnOutlineVisibleOnlyInReducedPictures) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    ArcDetector detector;
    const GrayPicture picture = noisy_disc(seed);
    EXPECT_GT(detector.log_odds_of(picture.view(), kNoisyDisc, {}).value(), 0.0) << seed;
    const Ellipse beside = translated(kNoisyDisc, 30.0, 0.0);
    EXPECT_LT(detector.log_odds_of(picture.view(), beside, {}).value(), -1.0) << seed;
  }
}

TEST(ArcDetector, JudgesOnlyTheGivenOutlineAtAnySize) {
  for (const double radius : {9.0, 30.0, 70.0, 100.0}) {
    SCOPED_TRACE(radius);
    const Ellipse truth{160.2, 119.7, radius, 0.7 * radius, 0.6};
    const GrayPicture picture = rendered(plain_ring(), truth);
    ArcDetector detector;
    EXPECT_GT(detector.log_odds_of(picture.view(), truth, {}).value(), 2.0);
    EXPECT_GT(detector.log_odds_of(picture.view(), translated(truth, 1.0, 0.5), {}).value(), 2.0);
    const Ellipse beside = translated(truth, 0.6 * radius, 0.0);
    EXPECT_LT(detector.log_odds_of(picture.view(), beside, {}).value(), -1.0);
  }
  ArcDetector detector;
  EXPECT_LT(detector.log_odds_of({}, {10.0, 10.0, 5.0, 4.0, 0.0}, {}).value(), -5.0);
}

TEST(ArcDetector, JudgesAnOutlineOfEitherPolarity) {
  const Ellipse truth{160.2, 119.7, 50.0, 35.0, 0.6};
  for (const double paint : {30.0, 215.0}) {
    Scene scene = plain_ring();
    scene.pad.pattern = Pattern::kDisc;
    scene.ground.level = 120.0;
    scene.pad.paint_level = paint;
    const GrayPicture picture = rendered(scene, truth);
    ArcDetector detector;
    EXPECT_GT(detector.log_odds_of(picture.view(), truth, {}).value(), 2.0) << paint;
  }
}

TEST(ArcDetector, FindsPartlyOccludedRings) {
  const Ellipse truth{160.2, 119.7, 70.0, 55.0, 0.6};
  Scene scene = plain_ring();
  scene.pad.gaps_rad = {0.3, 2.5};
  scene.pad.gap_width_rad = 0.5;
  scene.bars = {support::bar_px({60.0, 0.0}, {220.0, 239.0}, 14.0, 90.0)};
  EXPECT_GT(best_iou<ArcDetector>(rendered(scene, truth), truth, detecting<ArcDetector>()), 0.95);
}

TEST(ArcDetector, FindsRingsCutByTheFrame) {
  const Ellipse truth{20.0, 119.7, 80.0, 60.0, 0.2};
  EXPECT_GT(best_iou<ArcDetector>(rendered(plain_ring(), truth), truth, detecting<ArcDetector>()),
            0.95);
}

// Its nearly parallel sides may as well be those of a blade of grass.
TEST(ArcDetector, IsLessSureOfALongEllipseWhoseEndsAreOutside) {
  const auto log_odds = [](double cy) {
    const Ellipse e{160.3, cy, 240.0, 80.0, 0.5 * std::numbers::pi};
    const GrayPicture picture = rendered(plain_disc(), e);
    ArcDetector detector;
    EXPECT_GT(best_iou<ArcDetector>(picture, e, detecting<ArcDetector>()), 0.97) << cy;
    return detector.log_odds_of({picture.view()}, e, detecting<ArcDetector>()).value_or(-9.0);
  };
  EXPECT_LT(log_odds(119.6), log_odds(229.6) - 2.0);
}

// At a quarter of the size the border hides the outer edge.
TEST(ArcDetector, FindsTheOuterEdgeInASmallPicture) {
  const Ellipse truth{45.0, 45.0, 31.5, 25.2, 0.3};
  ArcDetector detector;
  const GrayPicture picture = rendered(plain_ring(), truth, 90, 90);
  const auto target = select_target(detector.detect(picture.view(), detecting<ArcDetector>()));
  ASSERT_TRUE(target);
  EXPECT_NEAR(target->ellipse.semi_major, truth.semi_major, 0.3);
}

TEST(ArcDetector, FindsCrumpledRings) {
  const Ellipse truth{160.0, 120.0, 90.0, 70.0, 0.2};
  for (const double deviation : {0.01, 0.02, 0.03}) {
    Scene scene = plain_ring();
    scene.pad.deformation = deviation;
    EXPECT_GT(best_iou<ArcDetector>(rendered(scene, truth), truth, detecting<ArcDetector>()), 0.93)
        << deviation;
  }
}

// Dark discs in rows, each at a different sub-pixel position.
GrayPicture board_of_discs(int columns, int rows, double radius) {
  const int pitch = static_cast<int>(3.0 * radius);
  GrayPicture picture(columns * pitch, rows * pitch);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int column = x / pitch;
      const int row = y / pitch;
      const double cx = (column + 0.5) * pitch + 0.1 * (column % 7);
      const double cy = (row + 0.5) * pitch + 0.1 * (row % 5);
      const double outside = std::hypot(x - cx, y - cy) - radius;
      picture.at(x, y) = static_cast<std::uint8_t>(130.0 + 80.0 * std::erf(outside));
    }
  }
  return picture;
}

TEST(ArcDetector, FindsAllOfFourHundredDiscs) {
  const GrayPicture picture = board_of_discs(25, 16, 10.0);
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.wants_all = true;
  ArcDetector detector;
  const auto found = detector.detect(picture.view(), thresholds);
  EXPECT_EQ(found.size(), 400U);
  for (const Detection& disc : found) EXPECT_NEAR(disc.ellipse.semi_major, 10.0, 0.1);
}

// Each disc has a single arc; at most 50 such ellipses are accepted at each of the three sizes.
TEST(ArcDetector, StopsAfterEnoughTargets) {
  const GrayPicture picture = board_of_discs(25, 16, 10.0);
  ArcDetector detector;
  const auto found = detector.detect(picture.view(), detecting<ArcDetector>());
  EXPECT_GE(found.size(), 50U);
  EXPECT_LE(found.size(), 150U);
  for (const Detection& disc : found) EXPECT_NEAR(disc.ellipse.semi_major, 10.0, 0.1);
}

TEST(ArcDetector, FindsSmallDiscsWithASmallerMinContourSize) {
  const Ellipse truth{60.3, 50.2, 6.5, 5.5, 0.3};
  const GrayPicture picture = rendered(plain_disc(), truth, 120, 100);
  EXPECT_EQ(best_iou<ArcDetector>(picture, truth, detecting<ArcDetector>()), 0.0);
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.min_contour_size = 20;
  EXPECT_GT(best_iou<ArcDetector>(picture, truth, thresholds), 0.85);
}

TEST(ArcDetector, FindsSmallDiscsWhenAllAreWanted) {
  const Ellipse truth{60.3, 50.2, 6.5, 5.5, 0.3};
  const GrayPicture picture = rendered(plain_disc(), truth, 120, 100);
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.wants_all = true;
  EXPECT_GT(best_iou<ArcDetector>(picture, truth, thresholds), 0.85);
  ArcDetector detector;
  const auto found = detector.detect(picture.view(), thresholds);
  ASSERT_FALSE(found.empty());
  for (const Detection& one : found) {
    EXPECT_EQ(one.as_target.reason, Reason::kContourTooShort);
    EXPECT_LT(one.as_target.measured, one.as_target.limit);
  }
  EXPECT_FALSE(select_target(found));
  thresholds.min_contour_size = 20;
  EXPECT_TRUE(select_target(detector.detect(picture.view(), thresholds)));
}

TEST(ArcDetector, FindsNearlyAllSmallTargetsUnderNoise) {
  Random random(11);
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.min_contour_size = 20;
  for (const Pattern pattern : {Pattern::kDisc, Pattern::kRing}) {
    int found = 0;
    for (std::uint64_t i = 0; i < 50; ++i) {
      Scene scene = plain_ring();
      scene.pad.pattern = pattern;
      scene.pad.paint_level = 110.0;
      scene.ground.level = 170.0;
      scene.sensor.read_noise = 3.0;
      scene.seed = i;
      const Ellipse truth = support::random_ellipse(random, 60, 50, 6.0);
      found += best_iou<ArcDetector>(rendered(scene, truth, 120, 100, i), truth, thresholds) >= 0.8
                   ? 1
                   : 0;
    }
    EXPECT_GE(found, 42) << static_cast<int>(pattern);
  }
}

// The affine image of a regular polygon with the area of an ellipse, blurred.
GrayPicture polygon(const Ellipse& e, int corners, double blur_px) {
  constexpr int kGround = 60;
  GrayPicture picture(320, 240);
  cv::Mat tile(picture.height, picture.width, CV_32F, cv::Scalar(kGround));
  std::vector<cv::Point> points;
  const double turn = kTwoPi / corners;
  for (int i = 0; i < corners; ++i) {
    const Eigen::Vector2d from_centre = e.point_at(turn * i) - e.center();
    const Eigen::Vector2d at = e.center() + std::sqrt(turn / std::sin(turn)) * from_centre;
    points.emplace_back(cvRound(kPolygonUnitsPerPx * at.x()), cvRound(kPolygonUnitsPerPx * at.y()));
  }
  fill_polygon(tile, points, 180.0F);
  if (blur_px > 0.0) cv::GaussianBlur(tile, tile, {}, blur_px);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      picture.at(x, y) = cv::saturate_cast<std::uint8_t>(tile.at<float>(y, x));
    }
  }
  return picture;
}

// Of the candidate nearest to an ellipse.
double corners_of(const GrayPicture& picture, const Ellipse& e) {
  Thresholds thresholds = detecting<ArcDetector>();
  thresholds.min_probability = 1.0;  // no candidate is accepted, so that all are measured
  thresholds.wants_all = true;
  ArcDetector detector;
  DetectionTrace trace;
  detector.set_trace(&trace);
  (void)detector.detect(picture.view(), thresholds);
  double best = 0.0;
  double corners = -1.0;
  for (const TracedCandidate& candidate : trace.candidates()) {
    if (candidate.probability == 0.0) continue;
    const double iou = iou_inside(*candidate.ellipse, e, picture.width, picture.height);
    if (iou <= best) continue;
    best = iou;
    corners = candidate.features[static_cast<std::size_t>(Feature::kCorners)];
  }
  return corners;
}

TEST(ArcDetector, MeasuresTheTurnInCorners) {
  const Ellipse e{160.2, 119.7, 80.0, 60.0, 0.4};
  constexpr int kEllipse = 256;  // corners
  for (const double blur_px : {0.0, 1.0, 3.0}) {
    EXPECT_LT(corners_of(polygon(e, kEllipse, blur_px), e), 0.05) << blur_px;
    for (int corners = 6; corners <= 8; ++corners) {
      const double measured = corners_of(polygon(e, corners, blur_px), e);
      EXPECT_GT(measured, 0.75) << corners << " corners, " << blur_px;
      EXPECT_LT(measured, 1.2) << corners << " corners, " << blur_px;
    }
  }
}

TEST(ArcDetector, AppliesEachThreshold) {
  const Ellipse truth{160.0, 120.0, 60.0, 30.0, 0.2};
  const GrayPicture picture = rendered(plain_disc(), truth);
  ASSERT_GT(best_iou<ArcDetector>(picture, truth, detecting<ArcDetector>()), 0.95);
  const auto with = [&](auto change) {
    Thresholds thresholds = detecting<ArcDetector>();
    change(thresholds);
    return best_iou<ArcDetector>(picture, truth, thresholds);
  };
  EXPECT_EQ(with([](Thresholds& t) { t.min_axis_px = 62.0; }), 0.0);
  EXPECT_EQ(with([](Thresholds& t) { t.max_axis_px = 118.0; }), 0.0);
  EXPECT_EQ(with([](Thresholds& t) { t.max_axis_ratio = 1.9; }), 0.0);
  EXPECT_EQ(with([](Thresholds& t) { t.min_contour_size = 400; }), 0.0);
  EXPECT_EQ(with([](Thresholds& t) { t.edge_high = 60.0; }), 0.0);
}

TEST(ArcDetector, IsUnbiasedAndAccurate) {
  // Discs of 10 to 120 px under noise: the centre and both axes, without bias.
  Random random(4);
  std::vector<double> centre;
  std::vector<double> axes;
  ArcDetector detector;
  for (int i = 0; i < 60; ++i) {
    const double radius = 10.0 * std::pow(12.0, random.unit());
    const Ellipse truth = support::random_ellipse(random, 200, 180, radius);
    Scene scene = plain_disc();
    scene.sensor.read_noise = 3.0;
    scene.seed = static_cast<std::uint64_t>(i);
    const GrayPicture picture = rendered(scene, truth, 400, 360);
    const auto target = select_target(detector.detect(picture.view(), detecting<ArcDetector>()));
    ASSERT_TRUE(target) << truth.semi_major;
    centre.push_back((target->ellipse.center() - truth.center()).norm());
    axes.push_back(target->ellipse.semi_major - truth.semi_major);
    axes.push_back(target->ellipse.semi_minor - truth.semi_minor);
  }
  std::sort(centre.begin(), centre.end());
  std::sort(axes.begin(), axes.end());
  EXPECT_LE(centre[30], 0.02);
  EXPECT_NEAR(axes[60], 0.0, 0.01);
  EXPECT_GT(axes.front(), -0.1);
  EXPECT_LT(axes.back(), 0.1);
}

TEST(ArcDetector, AdaptsToTheLight) {
  const Ellipse truth{160.0, 120.0, 60.0, 40.0, 0.2};
  for (const double gain : {1.0, 0.4, 0.14}) {
    Scene scene = plain_ring();
    scene.sensor.gain = gain;
    EXPECT_GT(best_iou<ArcDetector>(rendered(scene, truth), truth, detecting<ArcDetector>()), 0.9)
        << gain;
  }
}

TEST(ArcDetector, FindsNothingInAFlatPicture) {
  for (const int level : {0, 128, 255}) {
    EXPECT_TRUE(finds_nothing(GrayPicture(200, 150, static_cast<std::uint8_t>(level)))) << level;
  }
}

TEST(ArcDetector, FindsNothingInNoise) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    GrayPicture picture(320, 240);
    Random random(seed);
    for (std::uint8_t& level : picture.pixels) level = static_cast<std::uint8_t>(random.below(256));
    EXPECT_TRUE(finds_nothing(picture)) << seed;
  }
}

TEST(ArcDetector, FindsNothingOnACheckerboard) {
  for (const int square : {1, 2, 7, 20, 33}) {
    GrayPicture picture(320, 240);
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        picture.at(x, y) = ((x / square + y / square) & 1) != 0 ? 255 : 0;
      }
    }
    EXPECT_TRUE(finds_nothing(picture)) << square;
  }
}

TEST(ArcDetector, SurvivesAnySizeAndStride) {
  ArcDetector detector;
  Random random(8);
  for (const int width : {1, 2, 3, 5, 8, 33, 257}) {
    for (const int height : {1, 2, 3, 5, 8, 33, 257}) {
      const int stride = width + 7;
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(stride * height));
      for (std::uint8_t& level : pixels) level = random.below(8) == 0 ? 255 : 0;
      EXPECT_LE(
          detector.detect({pixels.data(), width, height, stride}, detecting<ArcDetector>()).size(),
          400U);
    }
  }
  EXPECT_TRUE(detector.detect({}, detecting<ArcDetector>()).empty());
}

TEST(ArcDetector, IsDeterministic) {
  const GrayPicture picture = rendered(plain_ring(), {160.0, 120.0, 70.0, 45.0, 0.6});
  ArcDetector used;
  (void)used.detect(GrayPicture(500, 300, 90).view(), detecting<ArcDetector>());
  const auto again = used.detect(picture.view(), detecting<ArcDetector>());
  ArcDetector fresh;
  const auto first = fresh.detect(picture.view(), detecting<ArcDetector>());
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].ellipse, again[i].ellipse);
}

TEST(ArcDetector, GivesTheSameWithEachInstructionSet) {
  if (best_simd() == Simd::kBaseline) GTEST_SKIP() << "this processor has one kind only";
  for (const double radius : {9.0, 30.0, 90.0}) {
    const Ellipse truth{160.0, 120.0, radius * 1.2, radius / 1.2, 0.6};
    const GrayPicture picture = rendered(plain_ring(), truth);
    ArcDetector baseline(Simd::kBaseline);
    ArcDetector best(best_simd());
    const auto a = baseline.detect(picture.view(), detecting<ArcDetector>());
    const auto b = best.detect(picture.view(), detecting<ArcDetector>());
    ASSERT_EQ(a.size(), b.size());
    ASSERT_FALSE(a.empty()) << radius;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LT(max_difference_px(a[i].ellipse, b[i].ellipse), 0.001) << radius;
    }
  }
}

}  // namespace
}  // namespace ellipse
