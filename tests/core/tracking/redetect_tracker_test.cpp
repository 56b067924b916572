// SPDX-License-Identifier: MIT
#include "core/tracking/redetect_tracker.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>

#include "core/detection/detectors.hpp"
#include "tests/support/picture.hpp"
#include "tests/support/scripted_detector.hpp"

namespace ellipse {
namespace {

using support::detection_at;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;
using support::ScriptedDetector;

class ScriptedRedetectTracker : public testing::Test {
 protected:
  void SetUp() override {
    script_.region = [this] { return search_.region(); };
    search_.configure(settings_);
  }
  std::optional<Target> track() { return track(picture_.view().bounds(), 1); }
  std::optional<Target> track(const Rect& searchable, int finest_scale) {
    search_.begin(picture_.view());
    return tracker_.track_target(
        {picture_.view(), searchable, finest_scale, {}}, search_, settings_);
  }

  TrackerSettings settings_;
  ScriptedDetector::Script script_;
  GrayPicture picture_{640, 360};
  FrameSearch search_{std::make_unique<ScriptedDetector>(script_)};
  RedetectTracker tracker_;
};

TEST_F(ScriptedRedetectTracker, DetectsInTheWholeFrameAndTracksInTheRegion) {
  script_.answers = {{detection_at(100, 100, 30)}, {detection_at(103, 98, 30)}};
  const auto detected = track();
  const auto tracked = track();
  ASSERT_TRUE(detected && tracked);
  EXPECT_EQ(detected->state, TargetState::kDetected);
  EXPECT_EQ(tracked->state, TargetState::kTracked);
  EXPECT_EQ(script_.calls[0].width, 640);
  EXPECT_EQ(script_.calls[0].thresholds.contour_overlap, 0.95);
  EXPECT_EQ(script_.calls[0].thresholds.ellipse_overlap, 0.94);
  // 100 px +- 2 x 30 px, and the last pixel: [40, 161).
  EXPECT_EQ(script_.calls[1].width, 121);
  EXPECT_EQ(script_.calls[1].thresholds.contour_overlap, 0.7);
  EXPECT_EQ(script_.calls[1].thresholds.ellipse_overlap, 0.3);
  EXPECT_DOUBLE_EQ(tracked->ellipse.cx, 103.0);
  EXPECT_EQ(tracked->search_region.x, 40);
}

TEST_F(ScriptedRedetectTracker, ALossClearsTheRegion) {
  script_.answers = {{detection_at(100, 100, 30)}, {}, {detection_at(100, 100, 30)}};
  EXPECT_TRUE(track());
  EXPECT_FALSE(track());
  EXPECT_EQ(track()->state, TargetState::kDetected);
  EXPECT_EQ(script_.calls[2].width, 640);
  EXPECT_EQ(script_.calls[2].thresholds.contour_overlap, 0.95);
}

TEST_F(ScriptedRedetectTracker, ScaleDoublesWhileTheTargetIsLarge) {
  // 260 px across at scale 1, 130 at 2, 65 at 4: above 120 twice.
  script_.answers = {{detection_at(320, 180, 130)}};
  EXPECT_EQ(track()->scale, 1);
  EXPECT_EQ(track()->scale, 2);
  EXPECT_EQ(track()->scale, 4);
  EXPECT_EQ(track()->scale, 4);
  EXPECT_EQ(script_.calls[1].height, 180);
  EXPECT_EQ(script_.calls[1].thresholds.max_axis_px, kAxisRangePx.max / 2.0);
}

TEST_F(ScriptedRedetectTracker, ScaleHalvesWhileTheTargetIsSmall) {
  script_.answers = {{detection_at(320, 180, 70)}, {detection_at(320, 180, 39)}};
  EXPECT_EQ(track()->scale, 1);
  EXPECT_EQ(track()->scale, 2);  // 39 px across, below 40
  EXPECT_EQ(track()->scale, 1);
  EXPECT_EQ(track()->scale, 1);
}

TEST_F(ScriptedRedetectTracker, LossAtACoarseScaleIsRetriedInTheSameFrame) {
  script_.answers = {{detection_at(320, 180, 80)}, {}, {detection_at(320, 180, 80)}};
  EXPECT_TRUE(track());
  const auto retried = track();
  ASSERT_TRUE(retried);
  ASSERT_EQ(script_.calls.size(), 3U);
  EXPECT_EQ(script_.calls[1].width, 161);  // 320 +- 160 px, and the last pixel, at scale 2
  EXPECT_EQ(script_.calls[1].thresholds.contour_overlap, 0.7);
  EXPECT_EQ(script_.calls[2].width, 322);
  EXPECT_EQ(script_.calls[2].thresholds.contour_overlap, 0.95);
  EXPECT_EQ(retried->scale, 1);
  EXPECT_EQ(retried->state, TargetState::kTracked);
}

TEST_F(ScriptedRedetectTracker, LossIsFinalAfterTheRetry) {
  script_.answers = {{detection_at(320, 180, 80)}, {}};
  EXPECT_TRUE(track());
  EXPECT_FALSE(track());
  EXPECT_EQ(script_.calls.size(), 3U);
  EXPECT_FALSE(track());
  EXPECT_EQ(script_.calls.back().width, 640);
}

TEST_F(ScriptedRedetectTracker, LossAtScaleOneIsNotRetried) {
  script_.answers = {{detection_at(320, 180, 30)}, {}};
  EXPECT_TRUE(track());
  EXPECT_FALSE(track());
  EXPECT_EQ(script_.calls.size(), 2U);
}

TEST_F(ScriptedRedetectTracker, SearchesOnlyInsideTheScope) {
  const Rect within{80, 60, 200, 100};
  script_.answers = {{detection_at(100, 100, 30)}};
  EXPECT_EQ(track(within, 1)->search_region, within);
  // Without the limit the region would be [40, 161) by [43, 158).
  EXPECT_EQ(track(within, 1)->search_region, (Rect{80, 60, 81, 98}));
  (void)track({600, 300, 40, 60}, 1);
  EXPECT_EQ(script_.calls.back().width, 0);  // the target's region does not intersect it
}

TEST_F(ScriptedRedetectTracker, ScaleStaysAtOrAboveTheFinest) {
  script_.answers = {{detection_at(320, 180, 60)}, {}};
  const Rect all{0, 0, 640, 360};
  EXPECT_EQ(track(all, 4)->scale, 4);
  EXPECT_EQ(script_.calls[0].width, 160);
  EXPECT_FALSE(track(all, 4));
  EXPECT_EQ(script_.calls.size(), 2U);  // a loss is not retried
  (void)track(all, 1);
  (void)track(all, 1);
  EXPECT_EQ(script_.calls.back().width, 640);
}

TEST_F(ScriptedRedetectTracker, FollowsALowerLimitOfTheScale) {
  script_.answers = {{detection_at(320, 180, 130)}};
  for (int frame = 0; frame < 3; ++frame) EXPECT_TRUE(track());
  settings_.max_scale = 3;
  EXPECT_EQ(track()->scale, 2);
}

TEST(RedetectTracker, OffsetsBetweenScalesAreCompensated) {
  // Still pictures, so that only scale and region change; many positions, so that pixel
  // quantization averages out and only the compensation's error remains.
  Scene scene = plain_ring();
  scene.sensor.read_noise = 0.0;
  scene.sensor.blur_px = 2.0;
  constexpr int kPositions = 60;
  std::array<Eigen::Vector2d, 3> mean_error;
  mean_error.fill({0.0, 0.0});
  FrameSearch search(make_detector(DetectorKind::kArcs));
  for (int position = 0; position < kPositions; ++position) {
    const Ellipse truth{
        310.37 + 0.71 * position, 171.81 + 0.37 * position, 130.0, 110.0, 0.3 * position};
    const GrayPicture picture = rendered(scene, truth, 640, 360);
    RedetectTracker tracker;
    for (int step = 0; step < 3; ++step) {
      const ScopedFrame frame{picture.view(), picture.view().bounds(), 1, {}};
      search.begin(frame.pixels);
      const Target target = tracker.track_target(frame, search, {}).value();
      EXPECT_EQ(target.scale, 1 << step);
      mean_error[static_cast<std::size_t>(step)] +=
          (target.ellipse.center() - truth.center()) / kPositions;
    }
  }
  for (const Eigen::Vector2d& error : mean_error) {
    EXPECT_NEAR(error.x(), 0.0, 0.01);
    EXPECT_NEAR(error.y(), 0.0, 0.01);
  }
}

TEST(NextScale, DoublesAndHalvesWithinItsLimits) {
  EXPECT_EQ(next_scale(1, 100, 200.0, 40.0, 120.0), 2);
  EXPECT_EQ(next_scale(64, 100, 200.0, 40.0, 120.0), 64);
  EXPECT_EQ(next_scale(4, 100, 20.0, 40.0, 120.0), 2);
  EXPECT_EQ(next_scale(1, 100, 20.0, 40.0, 120.0), 1);
  EXPECT_EQ(next_scale(4, 100, 80.0, 40.0, 120.0), 4);
}

}  // namespace
}  // namespace ellipse
