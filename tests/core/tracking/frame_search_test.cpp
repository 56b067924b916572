// SPDX-License-Identifier: MIT
#include "core/tracking/frame_search.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "tests/support/picture.hpp"
#include "tests/support/scripted_detector.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::ScriptedDetector;

class ScriptedFrameSearch : public testing::Test {
 protected:
  void SetUp() override {
    script_.region = [this] { return search_.region(); };
    search_.configure({});
    search_.begin(picture_.view());
  }
  [[nodiscard]] ScopedFrame frame() const {
    return {picture_.view(), picture_.view().bounds(), 1, {}};
  }

  ScriptedDetector::Script script_;
  GrayPicture picture_{640, 360};
  FrameSearch search_{std::make_unique<ScriptedDetector>(script_)};
};

TEST_F(ScriptedFrameSearch, ReportsTargetsInFramePixels) {
  script_.answers = {{support::detection_at(180, 120, 40)}};
  const Rect region{96, 64, 200, 120};
  const auto target = search_.find_target(frame(), region, 2, search_.detecting_thresholds(2));
  ASSERT_TRUE(target);
  EXPECT_EQ(script_.calls[0].width, 100);
  EXPECT_DOUBLE_EQ(target->ellipse.cx, 180.0);
  EXPECT_DOUBLE_EQ(target->ellipse.semi_major, 40.0);
  EXPECT_EQ(target->state, TargetState::kDetected);
  EXPECT_EQ(target->scale, 2);
  EXPECT_EQ(target->search_region, region);
  ASSERT_EQ(search_.candidates().size(), 1U);
  EXPECT_DOUBLE_EQ(search_.candidates()[0].ellipse.cy, 120.0);
}

TEST_F(ScriptedFrameSearch, AcceptsOnlyTheSameTargetWhileTracking) {
  const Detection elsewhere = support::detection_at(400, 120, 40);
  script_.answers = {{elsewhere}};
  const auto find = [&](const Ellipse& last) {
    return search_.find_target(
        frame(), frame().searchable, 1, search_.tracking_thresholds(1), last);
  };
  EXPECT_FALSE(find({180.0, 120.0, 40.0, 36.0, 0.0}));
  const auto target = find(elsewhere.ellipse);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->state, TargetState::kTracked);
}

TEST_F(ScriptedFrameSearch, SettingsOverrideTheDetectorsOverlaps) {
  TrackerSettings settings;
  settings.detect_overlaps = {0.5, 0.0};
  settings.track_overlaps = {0.0, 0.2};
  search_.configure(settings);
  const Thresholds detecting = search_.detecting_thresholds(1);
  const Thresholds tracking = search_.tracking_thresholds(1);
  EXPECT_EQ(std::pair(detecting.contour_overlap, detecting.ellipse_overlap), std::pair(0.5, 0.94));
  EXPECT_EQ(std::pair(tracking.contour_overlap, tracking.ellipse_overlap), std::pair(0.7, 0.2));
}

}  // namespace
}  // namespace ellipse
