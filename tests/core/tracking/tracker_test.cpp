// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/detection/contours/contour_detector.hpp"
#include "core/scene/catalog.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::Picture;
using support::plain_ring;
using support::rendered;

// Answers as it is told, in pixels of the frame, and remembers what it was asked.
class ScriptedDetector final : public Detector {
 public:
  struct Call {
    int width;
    int height;
    Thresholds thresholds;
  };
  struct Script {
    std::vector<std::vector<Detection>> answers;  // the last one goes on
    std::vector<Call> calls;
    const Tracker* tracker = nullptr;
  };

  explicit ScriptedDetector(Script& script) : script_(script) {}

  std::span<const Detection> detect(const ImageView& luma, const Thresholds& thresholds) override {
    const std::size_t turn = std::min(script_.calls.size(), script_.answers.size() - 1);
    script_.calls.push_back({luma.width, luma.height, thresholds});
    answer_ = script_.answers[turn];
    const Rect& region = script_.tracker->search_region();
    for (Detection& detection : answer_) {
      detection.ellipse =
          to_region(detection.ellipse, region, luma.empty() ? 1 : region.width / luma.width);
    }
    return answer_;
  }
  Overlaps detecting_overlaps() const override { return {0.95, 0.94}; }
  Overlaps tracking_overlaps() const override { return {0.7, 0.3}; }

 private:
  Script& script_;
  std::vector<Detection> answer_;
};

Detection at(double cx, double cy, double semi_major) {
  return {{cx, cy, semi_major, 0.9 * semi_major, 0.0}, 1.0, 1.0, 100.0};
}

TrackerSettings redetecting() {
  TrackerSettings settings;
  settings.tracking = TrackingMode::kRedetect;
  return settings;
}

class ScriptedTracker : public testing::Test {
 protected:
  void SetUp() override { script_.tracker = &tracker_; }
  std::optional<Target> process() { return tracker_.process(picture_.view(), 0); }
  std::optional<Target> process(const SearchScope& scope) {
    return tracker_.process(picture_.view(), 0, scope);
  }

  TrackerSettings settings_ = redetecting();
  ScriptedDetector::Script script_;
  Picture picture_{640, 360};
  Tracker tracker_{settings_, std::make_unique<ScriptedDetector>(script_)};
};

TEST_F(ScriptedTracker, DetectsInTheWholeFrameAndTracksInTheRegion) {
  script_.answers = {{at(100, 100, 30)}, {at(103, 98, 30)}};
  const auto detected = process();
  const auto tracked = process();
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

TEST_F(ScriptedTracker, ALossClearsTheRegionAndEndsTheId) {
  script_.answers = {{at(100, 100, 30)}, {}, {at(100, 100, 30)}};
  EXPECT_EQ(process()->id, 1U);
  EXPECT_FALSE(process());
  const auto again = process();
  EXPECT_EQ(again->id, 2U);
  EXPECT_EQ(again->state, TargetState::kDetected);
  EXPECT_EQ(script_.calls[2].width, 640);
  EXPECT_EQ(script_.calls[2].thresholds.contour_overlap, 0.95);
}

TEST_F(ScriptedTracker, ScaleDoublesWhileTheTargetIsLarge) {
  // 260 px across at scale 1, 130 at 2, 65 at 4: above 120 twice.
  script_.answers = {{at(320, 180, 130)}};
  EXPECT_EQ(process()->scale, 1);
  EXPECT_EQ(process()->scale, 2);
  EXPECT_EQ(process()->scale, 4);
  EXPECT_EQ(process()->scale, 4);
  EXPECT_EQ(script_.calls[1].height, 180);
  EXPECT_EQ(script_.calls[1].thresholds.max_axis_px, 350.0);
}

TEST_F(ScriptedTracker, ScaleHalvesWhileTheTargetIsSmall) {
  script_.answers = {{at(320, 180, 70)}, {at(320, 180, 39)}};
  EXPECT_EQ(process()->scale, 1);
  EXPECT_EQ(process()->scale, 2);  // 39 px across, below 40
  EXPECT_EQ(process()->scale, 1);
  EXPECT_EQ(process()->scale, 1);
}

TEST_F(ScriptedTracker, ALossAtACoarseScaleIsTriedAgainAtOnce) {
  script_.answers = {{at(320, 180, 80)}, {}, {at(320, 180, 80)}};
  process();
  const auto retried = process();
  ASSERT_TRUE(retried);
  ASSERT_EQ(script_.calls.size(), 3U);
  EXPECT_EQ(script_.calls[1].width, 161);  // 320 +- 160 px, and the last pixel, at scale 2
  EXPECT_EQ(script_.calls[1].thresholds.contour_overlap, 0.7);
  EXPECT_EQ(script_.calls[2].width, 322);
  EXPECT_EQ(script_.calls[2].thresholds.contour_overlap, 0.95);
  EXPECT_EQ(retried->scale, 1);
  EXPECT_EQ(retried->id, 1U);
}

TEST_F(ScriptedTracker, ALossWhereItWasTriedAgainIsALoss) {
  script_.answers = {{at(320, 180, 80)}, {}};
  process();
  EXPECT_FALSE(process());
  EXPECT_EQ(script_.calls.size(), 3U);
  EXPECT_FALSE(process());
  EXPECT_EQ(script_.calls.back().width, 640);
}

TEST_F(ScriptedTracker, ALossAtScaleOneIsNot) {
  script_.answers = {{at(320, 180, 30)}, {}};
  process();
  EXPECT_FALSE(process());
  EXPECT_EQ(script_.calls.size(), 2U);
}

TEST_F(ScriptedTracker, WithoutTrackingEachFrameStandsAlone) {
  settings_.tracking = TrackingMode::kNone;
  tracker_.configure(settings_);
  script_.answers = {{at(320, 180, 130)}};
  for (int i = 0; i < 3; ++i) {
    const auto target = process();
    EXPECT_EQ(target->scale, 1);
    EXPECT_EQ(target->state, TargetState::kDetected);
    EXPECT_EQ(target->id, 1U);
    EXPECT_EQ(script_.calls.back().width, 640);
  }
}

TEST_F(ScriptedTracker, SettingsOverruleTheDetectorsOwnOverlaps) {
  settings_.detect_overlaps = {0.5, 0.0};
  tracker_.configure(settings_);
  script_.answers = {{}};
  process();
  EXPECT_EQ(script_.calls[0].thresholds.contour_overlap, 0.5);
  EXPECT_EQ(script_.calls[0].thresholds.ellipse_overlap, 0.94);
}

TEST_F(ScriptedTracker, AnotherFrameSizeStartsOver) {
  script_.answers = {{at(100, 100, 30)}};
  process();
  const Picture other(320, 240);
  const auto target = tracker_.process(other.view(), 5);
  EXPECT_EQ(target->state, TargetState::kDetected);
  EXPECT_EQ(target->pts_ns, 5);
  EXPECT_EQ(script_.calls.back().width, 320);
}

TEST_F(ScriptedTracker, SearchesOnlyInsideTheScope) {
  const Rect within{80, 60, 200, 100};
  script_.answers = {{at(100, 100, 30)}};
  process({within});
  EXPECT_EQ(tracker_.search_region(), within);
  // Around the target it would be from 40 to 161, and from 43 to 158.
  EXPECT_EQ(process({within})->search_region, (Rect{80, 60, 81, 98}));
  process({{600, 300, 200, 100}});
  EXPECT_EQ(script_.calls.back().width, 0);  // the target's region is elsewhere
  EXPECT_EQ(script_.calls.size(), 3U);
}

TEST_F(ScriptedTracker, WhereNothingIsSearchedTheTargetIsForgotten) {
  script_.answers = {{at(100, 100, 30)}};
  process();
  for (const Rect& nowhere : {Rect{}, Rect{640, 0, 9, 9}, Rect{10, 10, -5, 9}}) {
    EXPECT_FALSE(process({nowhere}));
    EXPECT_TRUE(tracker_.search_region().empty());
  }
  EXPECT_EQ(script_.calls.size(), 1U);
  EXPECT_EQ(process()->state, TargetState::kDetected);
  EXPECT_EQ(tracker_.search_region(), (Rect{0, 0, 640, 360}));
}

TEST_F(ScriptedTracker, TheFinestScaleIsNotGoneBelow) {
  script_.answers = {{at(320, 180, 60)}, {}};
  const Rect all{0, 0, 640, 360};
  EXPECT_EQ(process({all, 4})->scale, 4);
  EXPECT_EQ(script_.calls[0].width, 160);
  EXPECT_FALSE(process({all, 4}));
  EXPECT_EQ(script_.calls.size(), 2U);  // a loss is not tried again
  process({all, 1});
  process({all, 1});
  EXPECT_EQ(script_.calls.back().width, 640);
}

TEST_F(ScriptedTracker, TheFinestScaleStaysBelowTheCoarsest) {
  settings_.max_scale = 3;
  tracker_.configure(settings_);
  script_.answers = {{at(320, 180, 60)}};
  EXPECT_EQ(process({{0, 0, 640, 360}, 8})->scale, 2);
}

TEST(Tracker, RefusesSettingsAndKeepsTheOldOnes) {
  TrackerSettings bad;
  bad.roi_expansion = std::nan("");
  EXPECT_THROW(Tracker{bad}, std::invalid_argument);
  Tracker tracker;
  EXPECT_THROW(tracker.configure(bad), std::invalid_argument);
  const Picture picture = rendered(plain_ring(), {160.0, 120.0, 50.0, 40.0, 0.0});
  EXPECT_TRUE(tracker.process(picture.view(), 0));
}

TEST(Tracker, OffsetsAreCompensatedExactlyBetweenScales) {
  // Still pictures, so that only scale and region change from frame to frame; several places, so
  // that the grain of the pixels averages away and what is left is the compensation.
  Scene scene = plain_ring();
  scene.sensor.read_noise = 0.0;
  scene.sensor.blur_px = 2.0;
  constexpr int kPlaces = 60;
  std::array<Eigen::Vector2d, 3> mean_error;
  mean_error.fill({0.0, 0.0});
  for (int place = 0; place < kPlaces; ++place) {
    const Ellipse truth{310.37 + 0.71 * place, 171.81 + 0.37 * place, 130.0, 110.0, 0.3 * place};
    const Picture picture = rendered(scene, truth, 640, 360);
    Tracker tracker(redetecting());
    for (int step = 0; step < 3; ++step) {
      const Target target = tracker.process(picture.view(), step).value();
      EXPECT_EQ(target.scale, 1 << step);
      mean_error[static_cast<std::size_t>(step)] +=
          (target.ellipse.center() - truth.center()) / kPlaces;
    }
  }
  for (const Eigen::Vector2d& error : mean_error) {
    EXPECT_NEAR(error.x(), 0.0, 0.01);
    EXPECT_NEAR(error.y(), 0.0, 0.01);
  }
}

TEST(Tracker, FollowsALandingFromFarToNear) {
  SceneRenderer renderer(scene_by_name("approach"));
  Tracker tracker;
  Picture picture(640, 360);
  int right = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const Truth truth = renderer.render(0.1 * frame, frame, picture.writable());
    const auto target = tracker.process(picture.view(), frame);
    right += target && iou_inside(target->ellipse, *truth.outer_edge, 640, 360) >= 0.9 ? 1 : 0;
  }
  EXPECT_GE(right, 95);
}

TEST(Tracker, TheSameFramesGiveTheSameTargets) {
  Tracker first;
  Tracker second;
  for (int frame = 0; frame < 5; ++frame) {
    const Picture picture =
        rendered(plain_ring(), {100.0 + 3 * frame, 90.0, 40.0, 30.0, 0.2}, 320, 240, frame);
    EXPECT_EQ(first.process(picture.view(), 0)->ellipse,
              second.process(picture.view(), 0)->ellipse);
  }
}

constexpr std::int64_t kFrameNs = 33'333'333;

// The darker of two pictures: paint of either on one bright ground.
Picture both(const Picture& a, const Picture& b) {
  Picture result = a;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    result.pixels[i] = std::min(a.pixels[i], b.pixels[i]);
  }
  return result;
}

// Pictures of one pad at a place that moves, frame after frame.
class Film {
 public:
  explicit Film(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] static Ellipse truth_at(int frame) {
    return {120.0 + 2.0 * frame, 110.0 + 0.5 * frame, 40.0, 32.0, 0.3};
  }
  [[nodiscard]] Picture at(int frame) const {
    return rendered(scene_, truth_at(frame), 320, 240, static_cast<std::uint64_t>(frame));
  }
  [[nodiscard]] Picture empty() const { return rendered(scene_, {-900.0, -900.0, 9.0, 9.0, 0.0}); }

 private:
  Scene scene_;
};

TEST(FollowingTracker, FollowsFromTheSecondFrameOn) {
  const Film film(plain_ring());
  Tracker tracker;
  for (int frame = 0; frame < 40; ++frame) {
    const auto target = tracker.process(film.at(frame).view(), frame * kFrameNs);
    ASSERT_TRUE(target) << frame;
    EXPECT_EQ(target->state, frame == 0 ? TargetState::kDetected : TargetState::kTracked) << frame;
    EXPECT_EQ(target->id, 1U);
    EXPECT_LT(max_difference_px(target->ellipse, Film::truth_at(frame)), 0.3) << frame;
  }
}

TEST(FollowingTracker, TellsItsState) {
  const Film film(plain_ring());
  Tracker tracker;
  EXPECT_FALSE(tracker.process(film.empty().view(), 0));
  EXPECT_EQ(tracker.state(), TrackerState::kSearching);
  for (int frame = 1; frame < 5; ++frame) {
    EXPECT_TRUE(tracker.process(film.at(frame).view(), frame * kFrameNs));
    EXPECT_EQ(tracker.state(), TrackerState::kFollowing) << frame;
  }
  tracker.reset();
  EXPECT_EQ(tracker.state(), TrackerState::kSearching);
}

// Half a disc alone may be anything; the more of it comes into view, the surer it is.
TEST(FollowingTracker, ConfirmsOverFrames) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  TrackerSettings settings;
  settings.limits.min_probability = 0.98;
  Tracker tracker(settings);
  int confirming = 0;
  int frame = 0;
  std::optional<Target> target;
  for (; frame < 60 && !target; ++frame) {
    const Ellipse disc{-10.0 + frame, 110.0, 40.0, 32.0, 0.3};
    target = tracker.process(rendered(scene, disc).view(), frame * kFrameNs);
    confirming += tracker.state() == TrackerState::kConfirming ? 1 : 0;
  }
  ASSERT_TRUE(target);
  EXPECT_GT(confirming, 0);
  EXPECT_EQ(target->id, 1U);
  EXPECT_GE(target->probability, 0.98);
}

// A hexagon in the place of a disc has most of its edges within reach of the disc's.
TEST(FollowingTracker, GivesUpWhatIsNoEllipseAnyMore) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  const Film film(scene);
  const Ellipse disc = Film::truth_at(0);
  Tracker tracker;
  for (int frame = 0; frame < 30; ++frame) {
    ASSERT_TRUE(tracker.process(film.at(0).view(), frame * kFrameNs)) << frame;
  }
  Picture hexagon = film.empty();
  const Picture paint = film.at(0);
  const Eigen::Matrix3d to_disc = image_from_pad(disc).inverse();
  for (int y = 0; y < hexagon.height; ++y) {
    for (int x = 0; x < hexagon.width; ++x) {
      const Eigen::Vector2d at = (to_disc * Eigen::Vector3d(x, y, 1.0)).hnormalized();
      bool is_inside = true;
      for (int side = 0; side < 6; ++side) {
        const double angle = side * std::numbers::pi / 3.0;
        is_inside &= at.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))) < 0.93;
      }
      if (is_inside) hexagon.at(x, y) = paint.pixels[std::size_t(110 * paint.width + 120)];
    }
  }
  int reports = 0;
  for (int frame = 30; frame < 60; ++frame) {
    reports += tracker.process(hexagon.view(), frame * kFrameNs) ? 1 : 0;
  }
  RecordProperty("reports", reports);
  EXPECT_LE(reports, 3);
}

TEST(FollowingTracker, ReportsNothingWhereNothingIsSeenAndKnowsTheTargetAgain) {
  const Film film(plain_ring());
  Tracker tracker;
  for (int frame = 0; frame < 20; ++frame) {
    (void)tracker.process(film.at(frame).view(), frame * kFrameNs);
  }
  for (int frame = 20; frame < 25; ++frame) {
    EXPECT_FALSE(tracker.process(film.empty().view(), frame * kFrameNs)) << frame;
  }
  const auto back = tracker.process(film.at(25).view(), 25 * kFrameNs);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id, 1U);
  // Gone for longer it was lost: what comes then is another one.
  for (int frame = 26; frame < 60; ++frame) {
    EXPECT_FALSE(tracker.process(film.empty().view(), frame * kFrameNs)) << frame;
  }
  const auto other = tracker.process(film.at(0).view(), 60 * kFrameNs);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->id, 2U);
}

TEST(FollowingTracker, FollowsWithoutTimeStamps) {
  const Film film(plain_ring());
  Tracker tracker;
  for (int frame = 0; frame < 20; ++frame) {
    const auto target = tracker.process(film.at(frame).view(), -1);
    ASSERT_TRUE(target) << frame;
    EXPECT_EQ(target->state, frame == 0 ? TargetState::kDetected : TargetState::kTracked) << frame;
  }
}

TEST(FollowingTracker, FollowsInsideTheScopeOnly) {
  const Film film(plain_ring());
  Tracker tracker;
  const Rect left{0, 0, 180, 240};  // the pad's right edge is at 160 + 2 px a frame
  for (int frame = 0; frame < 10; ++frame) {
    const auto target = tracker.process(film.at(frame).view(), frame * kFrameNs, {left});
    ASSERT_TRUE(target) << frame;
    EXPECT_LT(max_difference_px(target->ellipse, Film::truth_at(frame)), 0.3) << frame;
    EXPECT_EQ(intersect(target->search_region, left), target->search_region) << frame;
  }
  const auto elsewhere = tracker.process(film.at(10).view(), 10 * kFrameNs, {{240, 180, 80, 60}});
  EXPECT_FALSE(elsewhere);
}

TEST(FollowingTracker, FollowsASmallTargetAlsoWhereTheDetectorLooksTooCoarsely) {
  const Film film(plain_ring());
  Tracker tracker;
  (void)tracker.process(film.at(0).view(), 0);
  for (int frame = 1; frame < 40; ++frame) {
    const auto target =
        tracker.process(film.at(frame).view(), frame * kFrameNs, {{0, 0, 320, 240}, 16});
    ASSERT_TRUE(target) << frame;
    EXPECT_EQ(target->id, 1U) << frame;
    EXPECT_LT(max_difference_px(target->ellipse, Film::truth_at(frame)), 0.3) << frame;
  }
}

TEST(FollowingTracker, LocksExactlyOntoWhatWasFoundAtACoarseScale) {
  const Film film(plain_ring());
  Tracker tracker;
  for (int frame = 0; frame < 10; ++frame) {
    const auto target =
        tracker.process(film.at(frame).view(), frame * kFrameNs, {{0, 0, 320, 240}, 2});
    ASSERT_TRUE(target) << frame;
    const double tolerance_px = frame == 0 ? 1.0 : 0.3;
    EXPECT_LT(max_difference_px(target->ellipse, Film::truth_at(frame)), tolerance_px) << frame;
  }
}

TEST(FollowingTracker, LeavesADiscOrALesserRingForThePad) {
  Scene disc = plain_ring();
  disc.pad.pattern = Pattern::kDisc;
  const Ellipse lone{60.0, 60.0, 34.0, 30.0, 0.0};
  const Ellipse pad{220.0, 150.0, 44.0, 38.0, 0.2};
  const Ellipse small_ring{60.0, 60.0, 20.0, 17.0, 0.0};
  const Picture with_disc = rendered(disc, lone);
  const Picture with_ring = rendered(plain_ring(), small_ring);
  for (const auto& [before, wrong] : {std::pair{with_disc, lone}, {with_ring, small_ring}}) {
    const Picture after = both(before, rendered(plain_ring(), pad));
    Tracker tracker;
    for (int frame = 0; frame < 20; ++frame) {
      const auto target = tracker.process(before.view(), frame * kFrameNs);
      ASSERT_TRUE(target);
      EXPECT_GT(iou_inside(target->ellipse, wrong, 320, 240), 0.9);
    }
    std::optional<Target> target;
    for (int frame = 20; frame < 30; ++frame) {
      target = tracker.process(after.view(), frame * kFrameNs);
    }
    ASSERT_TRUE(target);
    EXPECT_GT(iou_inside(target->ellipse, pad, 320, 240), 0.9) << wrong.semi_major;
    EXPECT_EQ(target->id, 2U);
  }
}

TEST(FollowingTracker, TellsAllCandidatesOfEveryFrameWhereTheyAreWanted) {
  const Picture picture = rendered(plain_ring(), {160.0, 120.0, 60.0, 50.0, 0.2});
  for (const bool is_wanted : {false, true}) {
    TrackerSettings settings;
    settings.wants_candidates = is_wanted;
    Tracker tracker(settings);
    for (int frame = 0; frame < 4; ++frame) {
      ASSERT_TRUE(tracker.process(picture.view(), frame * kFrameNs));
    }
    EXPECT_EQ(!tracker.candidates().empty(), is_wanted);
  }
}

TEST(FollowingTracker, GivesTheSameForTheSame) {
  const Film film(plain_ring());
  Tracker a;
  Tracker b;
  for (int frame = 0; frame < 30; ++frame) {
    const auto one = a.process(film.at(frame).view(), frame * kFrameNs);
    const auto other = b.process(film.at(frame).view(), frame * kFrameNs);
    ASSERT_TRUE(one && other);
    ASSERT_EQ(one->ellipse, other->ellipse) << frame;
  }
}

}  // namespace
}  // namespace ellipse
