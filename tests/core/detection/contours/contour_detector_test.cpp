// SPDX-License-Identifier: MIT
#include "core/detection/contours/contour_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/detection/target_selection.hpp"
#include "tests/support/finding.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::best_iou;
using support::detecting;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;

Thresholds tracking() {
  Thresholds t;
  t.contour_overlap = 0.7;
  t.ellipse_overlap = 0.3;
  return t;
}

// In a target of 12 px radius the ring is 2.5 px wide; blur drives its gradient maxima apart.
constexpr double kFound = 0.9;

// [Keipour2021] Figure 1: the contour types of ellipses, each at three radii.
class ContourTypes : public testing::TestWithParam<double> {
 protected:
  [[nodiscard]] double radius() const { return GetParam(); }
  [[nodiscard]] int width() const { return static_cast<int>(3 * radius()) + 40; }
  [[nodiscard]] Ellipse centred() const {
    return {width() / 2.0 + 0.3, width() / 2.0 - 0.2, radius(), 0.8 * radius(), 0.5};
  }
  [[nodiscard]] Ellipse cut() const {
    Ellipse e = centred();
    e.cx = 0.35 * radius();
    return e;
  }
  [[nodiscard]] Bar bar(const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to,
                        double wide,
                        double level) const {
    return support::bar_px(from, to, wide, level, width(), width());
  }
  [[nodiscard]] GrayPicture picture_of(const Scene& scene, const Ellipse& e) const {
    return rendered(scene, e, width(), width());
  }
};

TEST_P(ContourTypes, AWhole) {
  EXPECT_GT(best_iou<ContourDetector>(
                picture_of(plain_ring(), centred()), centred(), detecting<ContourDetector>()),
            kFound);
}

TEST_P(ContourTypes, BWithAttachedBranches) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kRingX;
  scene.pad.mark_length = 1.0;  // the X joins the ring
  EXPECT_GT(best_iou<ContourDetector>(
                picture_of(scene, centred()), centred(), detecting<ContourDetector>()),
            kFound);
}

TEST_P(ContourTypes, BWithABranchOutside) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  const Ellipse e = centred();
  const Eigen::Vector2d root = e.point_at(0.2);
  const Eigen::Vector2d tip = root + 0.25 * (root - e.center());
  scene.bars = {
      bar(e.center() + 0.9 * (root - e.center()), tip, 0.15 * radius(), scene.pad.paint_level)};
  EXPECT_GT(best_iou<ContourDetector>(picture_of(scene, e), e, tracking()), kFound);
}

TEST_P(ContourTypes, CInSeveralContours) {
  Scene scene = plain_ring();
  scene.pad.gaps_rad = {0.3, 2.5};
  scene.pad.gap_width_rad = 0.15;
  EXPECT_GT(best_iou<ContourDetector>(picture_of(scene, centred()), centred(), tracking()), kFound);
}

TEST_P(ContourTypes, DOccluded) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  const Ellipse e = centred();
  scene.bars = {bar(e.center(), {2.0 * width(), e.cy + 0.4 * radius()}, 0.5 * radius(), 120.0)};
  EXPECT_GT(best_iou<ContourDetector>(picture_of(scene, e), e, tracking()), kFound);
}

TEST_P(ContourTypes, ECutByTheFrame) {
  EXPECT_GT(best_iou<ContourDetector>(
                picture_of(plain_ring(), cut()), cut(), detecting<ContourDetector>()),
            kFound);
}

TEST_P(ContourTypes, FCutWithBranches) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kRingX;
  scene.pad.mark_length = 1.0;
  EXPECT_GT(
      best_iou<ContourDetector>(picture_of(scene, cut()), cut(), detecting<ContourDetector>()),
      kFound);
}

INSTANTIATE_TEST_SUITE_P(Radii, ContourTypes, testing::Values(12.0, 40.0, 120.0));

TEST(ContourDetector, JudgesAnOutlineByItsOverlap) {
  const Ellipse truth{160.2, 119.7, 70.0, 45.0, 0.6};
  const GrayPicture picture = rendered(plain_ring(), truth);
  ContourDetector detector;
  EXPECT_GT(detector.log_odds_of(picture.view(), truth, tracking()).value(), 2.0);
  const Ellipse beside = translated(truth, 30.0, 0.0);
  EXPECT_LT(detector.log_odds_of(picture.view(), beside, tracking()).value(), 0.0);
  EXPECT_FALSE(detector.log_odds_of({}, truth, tracking()));
}

TEST(ContourDetector, FindsTheOuterEdgeExactly) {
  const Ellipse truth{160.37, 119.81, 60.0, 45.0, 0.9};
  ContourDetector detector;
  const GrayPicture picture = rendered(plain_ring(), truth);
  const auto target = select_target(detector.detect(picture.view(), detecting<ContourDetector>()));
  ASSERT_TRUE(target);
  EXPECT_NEAR(target->ellipse.cx, truth.cx, 0.05);
  EXPECT_NEAR(target->ellipse.cy, truth.cy, 0.05);
  EXPECT_NEAR(target->ellipse.semi_major, truth.semi_major, 0.1);
  EXPECT_NEAR(target->ellipse.semi_minor, truth.semi_minor, 0.1);
  EXPECT_NEAR(target->ellipse.angle_rad, truth.angle_rad, 0.01);
  EXPECT_GE(target->contour_overlap, 0.95);
  EXPECT_GE(target->ellipse_overlap, 0.95);
}

TEST(ContourDetector, AdaptsToTheLight) {
  const Ellipse truth{160.0, 120.0, 50.0, 40.0, 0.2};
  for (const double gain : {1.0, 0.5, 0.14, 0.08}) {
    Scene scene = plain_ring();
    scene.sensor.gain = gain;
    scene.sensor.read_noise = 1.0;
    EXPECT_GT(
        best_iou<ContourDetector>(rendered(scene, truth), truth, detecting<ContourDetector>()),
        0.95)
        << gain;
  }
  Scene noisy = plain_ring();
  noisy.sensor.read_noise = 10.0;
  EXPECT_GT(best_iou<ContourDetector>(rendered(noisy, truth), truth, tracking()), 0.95);
}

TEST(ContourDetector, ReportsItsEdgeThresholds) {
  ContourDetector detector;
  const auto of_noise = [&](double noise) {
    Scene scene = plain_ring();
    scene.sensor.read_noise = noise;
    const GrayPicture picture = rendered(scene, {160.0, 120.0, 50.0, 40.0, 0.2});
    (void)detector.detect(picture.view(), detecting<ContourDetector>());
    return detector.edge_thresholds();
  };
  EXPECT_NEAR(of_noise(12.0).high / of_noise(6.0).high, 2.0, 0.15);
  EXPECT_EQ(of_noise(0.0).high, 1.0);  // never below quantization noise
  EXPECT_LT(of_noise(6.0).low, of_noise(6.0).high);
  Thresholds asked;
  asked.edge_low = 3.0;
  asked.edge_high = 7.0;
  const GrayPicture picture = rendered(plain_ring(), {160.0, 120.0, 50.0, 40.0, 0.2});
  (void)detector.detect(picture.view(), asked);
  EXPECT_EQ(detector.edge_thresholds().low, 3.0);
  EXPECT_EQ(detector.edge_thresholds().high, 7.0);
}

TEST(ContourDetector, AppliesEachThreshold) {
  const Ellipse truth{160.0, 120.0, 60.0, 20.0, 0.0};
  const GrayPicture picture = rendered(plain_ring(), truth);
  const auto with = [&](auto change) {
    Thresholds t;
    change(t);
    return best_iou<ContourDetector>(picture, truth, t) > 0.9;
  };
  EXPECT_TRUE(with([](Thresholds&) {}));
  EXPECT_FALSE(with([](Thresholds& t) { t.max_axis_px = 110.0; }));
  EXPECT_FALSE(with([](Thresholds& t) { t.min_axis_px = 45.0; }));
  EXPECT_FALSE(with([](Thresholds& t) { t.max_axis_ratio = 2.5; }));
  EXPECT_FALSE(with([](Thresholds& t) { t.min_contour_size = 2000; }));
  EXPECT_FALSE(with([](Thresholds& t) { t.edge_high = 500.0; }));
}

TEST(ContourDetector, FindsNothingWithoutEllipses) {
  ContourDetector detector;
  GrayPicture checkers(200, 150);
  GrayPicture noise(200, 150);
  std::mt19937 random(3);
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) {
      checkers.at(x, y) = ((x / 10 + y / 10) % 2) != 0 ? 255 : 0;
      noise.at(x, y) = static_cast<std::uint8_t>(random() & 0xffU);
    }
  }
  EXPECT_TRUE(detector.detect(checkers.view(), detecting<ContourDetector>()).empty());
  EXPECT_TRUE(detector.detect(noise.view(), detecting<ContourDetector>()).empty());
  EXPECT_TRUE(
      detector.detect(GrayPicture(200, 150, 0).view(), detecting<ContourDetector>()).empty());
  EXPECT_TRUE(
      detector.detect(GrayPicture(200, 150, 255).view(), detecting<ContourDetector>()).empty());
}

TEST(ContourDetector, AcceptsPicturesOfAnySize) {
  ContourDetector detector;
  EXPECT_TRUE(detector.detect(ImageView{}, detecting<ContourDetector>()).empty());
  for (const int width : {1, 2, 3, 5, 17, 64}) {
    for (const int height : {1, 2, 3, 5, 17, 64}) {
      GrayPicture picture(width, height, 30);
      picture.at(width / 2, height / 2) = 255;
      EXPECT_TRUE(detector.detect(picture.view(), detecting<ContourDetector>()).empty())
          << width << 'x' << height;
    }
  }
}

TEST(ContourDetector, HonoursTheStride) {
  const Ellipse truth{60.0, 60.0, 35.0, 30.0, 0.3};
  const GrayPicture wide = rendered(plain_ring(), truth, 203, 130);
  const ImageView part = wide.view().region({0, 0, 121, 125});
  GrayPicture copy(121, 125);
  for (int y = 0; y < 125; ++y) std::copy_n(part.row(y), 121, &copy.at(0, y));
  ContourDetector detector;
  const auto of_part = select_target(detector.detect(part, detecting<ContourDetector>()));
  const auto of_copy = select_target(detector.detect(copy.view(), detecting<ContourDetector>()));
  ASSERT_TRUE(of_part && of_copy);
  EXPECT_EQ(of_part->ellipse, of_copy->ellipse);
}

}  // namespace
}  // namespace ellipse
