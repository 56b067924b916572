// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/detection/contours/contour_detector.hpp"
#include "core/detection/detectors.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/scene/catalog.hpp"
#include "tests/support/picture.hpp"
#include "tests/support/scripted_detector.hpp"

namespace ellipse {
namespace {

using support::detection_at;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;
using support::ScriptedDetector;

TrackerSettings redetecting() {
  TrackerSettings settings;
  settings.tracking = TrackingMode::kRedetect;
  return settings;
}

class ScriptedTracker : public testing::Test {
 protected:
  void SetUp() override {
    script_.region = [this] { return tracker_.search_region(); };
  }
  std::optional<Target> process() { return tracker_.process(picture_.view(), 0); }
  std::optional<Target> process(const SearchScope& scope) {
    return tracker_.process(picture_.view(), 0, scope);
  }

  TrackerSettings settings_ = redetecting();
  ScriptedDetector::Script script_;
  GrayPicture picture_{640, 360};
  Tracker tracker_{settings_, std::make_unique<ScriptedDetector>(script_)};
};

TEST_F(ScriptedTracker, ALossEndsTheId) {
  script_.answers = {
      {detection_at(100, 100, 30)}, {detection_at(100, 100, 30)}, {}, {detection_at(100, 100, 30)}};
  EXPECT_EQ(process()->id, 1U);
  EXPECT_EQ(process()->id, 1U);
  EXPECT_FALSE(process());
  EXPECT_EQ(process()->id, 2U);
}

TEST_F(ScriptedTracker, IsFollowingOrSearchingWithoutEdgeTracking) {
  for (const TrackingMode mode : {TrackingMode::kRedetect, TrackingMode::kNone}) {
    settings_.tracking = mode;
    tracker_.configure(settings_);
    script_.calls.clear();
    script_.answers = {{detection_at(100, 100, 30)}, {}};
    EXPECT_TRUE(process());
    EXPECT_EQ(tracker_.state(), TrackerState::kFollowing);
    EXPECT_FALSE(process());
    EXPECT_EQ(tracker_.state(), TrackerState::kSearching);
  }
}

TEST_F(ScriptedTracker, FramesAreIndependentWithoutTracking) {
  settings_.tracking = TrackingMode::kNone;
  tracker_.configure(settings_);
  script_.answers = {{detection_at(320, 180, 130)}};
  for (int i = 0; i < 3; ++i) {
    const auto target = process();
    EXPECT_EQ(target->scale, 1);
    EXPECT_EQ(target->state, TargetState::kDetected);
    EXPECT_EQ(target->id, 1U);
    EXPECT_EQ(script_.calls.back().width, 640);
  }
}

TEST_F(ScriptedTracker, AnotherFrameSizeStartsOver) {
  script_.answers = {{detection_at(100, 100, 30)}};
  process();
  const GrayPicture other(320, 240);
  const auto target = tracker_.process(other.view(), 5);
  EXPECT_EQ(target->state, TargetState::kDetected);
  EXPECT_EQ(target->pts_ns, 5);
  EXPECT_EQ(script_.calls.back().width, 320);
}

TEST_F(ScriptedTracker, AnEmptyScopeForgetsTheTarget) {
  script_.answers = {{detection_at(100, 100, 30)}};
  process();
  for (const Rect& nowhere : {Rect{}, Rect{640, 0, 9, 9}, Rect{10, 10, -5, 9}}) {
    EXPECT_FALSE(process({nowhere}));
    EXPECT_TRUE(tracker_.search_region().empty());
  }
  EXPECT_EQ(script_.calls.size(), 1U);
  EXPECT_EQ(process()->state, TargetState::kDetected);
  EXPECT_EQ(tracker_.search_region(), (Rect{0, 0, 640, 360}));
}

TEST_F(ScriptedTracker, FinestScaleIsLimitedByTheCoarsest) {
  settings_.max_scale = 3;
  tracker_.configure(settings_);
  script_.answers = {{detection_at(320, 180, 60)}};
  EXPECT_EQ(process({{0, 0, 640, 360}, 8})->scale, 2);
}

TEST(Tracker, RejectsInvalidSettingsAndKeepsTheOldOnes) {
  TrackerSettings bad;
  bad.roi_expansion = std::nan("");
  EXPECT_THROW(Tracker{bad}, std::invalid_argument);
  Tracker tracker;
  EXPECT_THROW(tracker.configure(bad), std::invalid_argument);
  const GrayPicture picture = rendered(plain_ring(), {160.0, 120.0, 50.0, 40.0, 0.0});
  EXPECT_TRUE(tracker.process(picture.view(), 0));
}

TEST(Tracker, RejectsFocalLengthsBelowAPixel) {
  TrackerSettings settings;
  for (double* focal_px : {&settings.fx_px, &settings.fy_px}) {
    *focal_px = 0.9;
    EXPECT_THROW(Tracker{settings}, std::invalid_argument);
    *focal_px = 1.0;
    EXPECT_NO_THROW(Tracker{settings});
  }
}

TEST(Tracker, RoundsTheFinestScaleToOneThatExists) {
  const GrayPicture picture = rendered(plain_ring(), {300.0, 200.0, 90.0, 70.0, 0.3}, 640, 360);
  for (const auto mode : {TrackingMode::kNone, TrackingMode::kRedetect, TrackingMode::kEdges}) {
    TrackerSettings settings;
    settings.tracking = mode;
    const auto at_scale = [&](int finest_scale) {
      Tracker tracker(settings);
      return tracker.process(picture.view(), 0, {picture.view().bounds(), finest_scale});
    };
    for (const auto& [given, rounded] : {std::pair{-5, 1}, {0, 1}, {3, 2}, {7, 4}}) {
      const auto target = at_scale(given);
      ASSERT_TRUE(target) << given;
      EXPECT_EQ(target->ellipse, at_scale(rounded)->ellipse) << given;
    }
    (void)at_scale(std::numeric_limits<int>::max());
  }
}

TEST(Tracker, FollowsALandingFromFarToNear) {
  SceneRenderer renderer(scene_by_name("approach"));
  Tracker tracker;
  GrayPicture picture(640, 360);
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
    const GrayPicture picture =
        rendered(plain_ring(), {100.0 + 3 * frame, 90.0, 40.0, 30.0, 0.2}, 320, 240, frame);
    EXPECT_EQ(first.process(picture.view(), 0)->ellipse,
              second.process(picture.view(), 0)->ellipse);
  }
}

constexpr std::int64_t kFrameNs = 33'333'333;

// The pixel-wise minimum of two pictures combines their paint on one bright ground.
GrayPicture both(const GrayPicture& a, const GrayPicture& b) {
  GrayPicture result = a;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    result.pixels[i] = std::min(a.pixels[i], b.pixels[i]);
  }
  return result;
}

// Pictures of one moving pad.
class Film {
 public:
  explicit Film(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] static Ellipse truth_at(int frame) {
    return {120.0 + 2.0 * frame, 110.0 + 0.5 * frame, 40.0, 32.0, 0.3};
  }
  [[nodiscard]] GrayPicture at(int frame) const {
    return rendered(scene_, truth_at(frame), 320, 240, static_cast<std::uint64_t>(frame));
  }
  [[nodiscard]] GrayPicture empty() const {
    return rendered(scene_, {-900.0, -900.0, 9.0, 9.0, 0.0});
  }

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

// The pad moves by .9 of its radius in each frame: a search around the last ellipse finds it again,
// and its velocity is known from then on.
TEST(FollowingTracker, FollowsAFastPadAfterTwoDetections) {
  class RecordingDetector final : public Detector {
   public:
    explicit RecordingDetector(std::vector<int>& widths) : widths_(widths) {}
    [[nodiscard]] std::span<const Detection> detect(const ellipse::Picture& picture,
                                                    const Thresholds& thresholds) override {
      widths_.push_back(picture.luma.width);
      return detector_->detect(picture, thresholds);
    }
    [[nodiscard]] bool has_probability() const override { return detector_->has_probability(); }
    [[nodiscard]] Overlaps detecting_overlaps() const override { return {}; }
    [[nodiscard]] Overlaps tracking_overlaps() const override { return {}; }

   private:
    std::vector<int>& widths_;
    std::unique_ptr<Detector> detector_ = make_detector(DetectorKind::kArcs);
  };
  std::vector<int> widths;
  Tracker tracker({}, std::make_unique<RecordingDetector>(widths));
  for (int frame = 0; frame < 5; ++frame) {
    const Ellipse truth{80.0 + 30.0 * frame, 80.0 + 15.0 * frame, 40.0, 32.0, 0.3};
    const auto picture = rendered(plain_ring(), truth, 320, 240, static_cast<std::uint64_t>(frame));
    const auto target = tracker.process(picture.view(), frame * kFrameNs);
    ASSERT_TRUE(target) << frame;
    EXPECT_EQ(target->id, 1U) << frame;
    EXPECT_LT(max_difference_px(target->ellipse, truth), 0.3) << frame;
    EXPECT_EQ(widths.size(), frame == 0 ? 1U : 2U) << frame;
  }
  EXPECT_EQ(widths.front(), 320);
  EXPECT_LT(widths.back(), 320);
}

// The widths of the pictures searched in a stream without a target, frame by frame.
std::vector<std::vector<int>> searched_widths(const TrackerSettings& settings, int frames) {
  ScriptedDetector::Script script;
  script.answers = {{}};
  script.region = [] { return Rect{}; };
  Tracker tracker(settings, std::make_unique<ScriptedDetector>(script));
  const GrayPicture picture(640, 360);
  std::vector<std::vector<int>> widths;
  for (int frame = 0; frame < frames; ++frame) {
    script.calls.clear();
    EXPECT_FALSE(tracker.process(picture.view(), frame * kFrameNs));
    std::vector<int>& of_frame = widths.emplace_back();
    for (const ScriptedDetector::Call& call : script.calls) of_frame.push_back(call.width);
  }
  return widths;
}

TEST(FollowingTracker, SearchesTheFullSizeOnlyPeriodicallyAfterASecondWithoutATarget) {
  const std::vector<int> full = {640};
  const std::vector<int> half = {320};
  const auto widths = searched_widths({}, 90);
  EXPECT_EQ(std::count(widths.begin(), widths.begin() + 20, full), 20);
  EXPECT_EQ(std::count(widths.begin() + 30, widths.end(), half), 50);
  EXPECT_EQ(std::count(widths.begin() + 30, widths.end(), full), 10);
}

TEST(FollowingTracker, SearchesTheFullSizeInEveryFrameForCandidates) {
  TrackerSettings settings;
  settings.wants_candidates = true;
  const auto widths = searched_widths(settings, 60);
  EXPECT_EQ(std::count(widths.begin(), widths.end(), std::vector<int>{640}), 60);
}

// A target at half the size is searched at the full size in the same frame.
TEST(FollowingTracker, ConfirmsATargetAtHalfTheSizeAtOnce) {
  const Film film(plain_ring());
  Tracker tracker;
  for (int frame = 0; frame < 40; ++frame) {
    EXPECT_FALSE(tracker.process(film.empty().view(), frame * kFrameNs));
  }
  const auto target = tracker.process(film.at(0).view(), 40 * kFrameNs);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->scale, 1);
}

TEST(FollowingTracker, ReportsItsState) {
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

// Detects one edge of a ring in the first frame, by default the inner one, and the other from then
// on.
class OneEdgeFirst : public testing::Test {
 protected:
  static constexpr double kRingWidth = 0.1;

  class TwoEdges final : public Detector {
   public:
    std::span<const Detection> detect(const ellipse::Picture& picture, const Thresholds&) override {
      Detection& detection = answer_.front();
      const bool is_inner = is_first_ == is_inner_first;
      detection = {is_inner ? inner_edge() : Film::truth_at(0), 1.0, 1.0, 100.0};
      detection.probability = is_first_ ? first_probability : 0.99;
      is_first_ = false;
      const int scale = picture.luma.empty() ? 1 : 320 / picture.luma.width;
      detection.ellipse = to_region(detection.ellipse, {}, scale);
      return answer_;
    }
    std::optional<double> log_odds_of(const ellipse::Picture&,
                                      const Ellipse&,
                                      const Thresholds&) override {
      return judged;
    }
    Overlaps detecting_overlaps() const override { return {0.95, 0.94}; }
    Overlaps tracking_overlaps() const override { return {0.7, 0.3}; }

    std::optional<double> judged;
    bool is_inner_first = true;
    double first_probability = 0.9;

   private:
    bool is_first_ = true;
    std::vector<Detection> answer_{1};
  };

  void SetUp() override {
    Scene scene = plain_ring();
    scene.pad.ring_width = kRingWidth;
    picture_ = rendered(scene, Film::truth_at(0));
  }
  static Ellipse inner_edge() {
    Ellipse inner = Film::truth_at(0);
    inner.semi_major *= 1.0 - kRingWidth;
    inner.semi_minor *= 1.0 - kRingWidth;
    return inner;
  }
  // The first frame in which the outer edge replaces the inner one; 60 = none.
  int corrected_at(std::optional<double> judged) {
    auto detector = std::make_unique<TwoEdges>();
    detector->judged = judged;
    return followed_at(Film::truth_at(0), std::move(detector));
  }
  // The first frame in which this edge is the target; 60 = none.
  int followed_at(const Ellipse& edge, std::unique_ptr<TwoEdges> detector) {
    Tracker tracker({}, std::move(detector));
    for (int frame = 0; frame < 60; ++frame) {
      const auto target = tracker.process(picture_.view(), frame * kFrameNs);
      if (target && max_difference_px(target->ellipse, edge) < 1.0) return frame;
    }
    return 60;
  }

  support::GrayPicture picture_{320, 240};
};

TEST_F(OneEdgeFirst, IsCorrectedByTheNextDetection) {
  const int frame = corrected_at(std::nullopt);
  EXPECT_GT(frame, 1);
  EXPECT_LE(frame, 7);  // kCheckPeriod_s, and a frame in which an evaluation goes first
}

TEST_F(OneEdgeFirst, IsCorrectedAtOnceIfItLooksWrong) {
  EXPECT_EQ(corrected_at(-1.0), 1);
}

// For example, a pupil inside an iris.
TEST_F(OneEdgeFirst, CertainInsideAnUncertainOutlineReplacesIt) {
  const auto replaced_at = [&](double judged) {
    auto detector = std::make_unique<TwoEdges>();
    detector->judged = judged;
    detector->is_inner_first = false;
    detector->first_probability = 0.7;
    return followed_at(inner_edge(), std::move(detector));
  };
  EXPECT_LE(replaced_at(0.3), 7);
  EXPECT_EQ(replaced_at(6.0), 60);  // a certain outline keeps its inner edges
}

// After the ring, a disc of the size of its inner circle: an inner edge while the ring is
// predicted, another target once the ring is lost.
TEST(FollowingTracker, TakesNoInnerEdgeOfAPredictedPad) {
  const Film ring(plain_ring());
  Scene disc_scene = plain_ring();
  disc_scene.pad.pattern = Pattern::kDisc;
  const Ellipse outer = Film::truth_at(0);
  Ellipse inner = outer;
  inner.semi_major *= 0.8;
  inner.semi_minor *= 0.8;
  const GrayPicture disc = rendered(disc_scene, inner, 320, 240);
  Tracker tracker;
  for (int frame = 0; frame < 20; ++frame) {
    ASSERT_TRUE(tracker.process(ring.at(0).view(), frame * kFrameNs)) << frame;
  }
  for (int frame = 20; frame < 60; ++frame) {
    const auto target = tracker.process(disc.view(), frame * kFrameNs);
    if (frame < 28 && target) {
      EXPECT_GT(target->ellipse.semi_major, 0.9 * outer.semi_major) << frame;
    }
    if (frame < 40) continue;
    ASSERT_TRUE(target) << frame;
    EXPECT_LT(max_difference_px(target->ellipse, inner), 0.5) << frame;
  }
}

// Half a disc alone is ambiguous; the probability grows as more of it becomes visible.
TEST(FollowingTracker, ConfirmsOverSeveralFrames) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  TrackerSettings settings;
  settings.limits.min_probability = 0.98;
  Tracker tracker(settings);
  int confirming = 0;
  int frame = 0;
  std::optional<Target> target;
  for (; frame < 300 && !target; ++frame) {
    const Ellipse disc{-10.0 + 0.2 * frame, 110.0, 40.0, 32.0, 0.3};
    target = tracker.process(rendered(scene, disc).view(), frame * kFrameNs);
    confirming += tracker.state() == TrackerState::kConfirming ? 1 : 0;
  }
  ASSERT_TRUE(target);
  EXPECT_GT(confirming, 0);
  EXPECT_EQ(target->id, 1U);
  EXPECT_GE(target->probability, 0.98);
}

// Finds one given ellipse, in pictures without edges.
class OneEllipseDetector final : public Detector {
 public:
  /// @param required  Probability below which it finds nothing; default: as the limits say.
  explicit OneEllipseDetector(const Detection& ellipse, std::optional<double> required = {})
      : ellipse_(ellipse), required_(required) {}

  std::span<const Detection> detect(const ellipse::Picture&, const Thresholds& limits) override {
    const double required = required_.value_or(limits.min_probability);
    return {&ellipse_, ellipse_.probability >= required ? 1U : 0U};
  }
  [[nodiscard]] bool has_probability() const override { return true; }
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {}; }

 private:
  const Detection& ellipse_;
  std::optional<double> required_;
};

// A probability below min-probability: the hypothesis is confirmed over several frames.
TEST(FollowingTracker, DropsAnUnreportedHypothesisThatNewLimitsExclude) {
  Detection found = support::detection_at(160.0, 120.0, 40.0);
  found.probability = 0.7;
  TrackerSettings settings;
  settings.limits.min_probability = 0.99;
  Tracker tracker(settings, std::make_unique<OneEllipseDetector>(found, 0.0));
  EXPECT_FALSE(tracker.process(GrayPicture(320, 240, 90).view(), 0));
  ASSERT_EQ(tracker.state(), TrackerState::kConfirming);
  settings.limits.max_axis_px = 70.0;
  tracker.configure(settings);
  EXPECT_EQ(tracker.state(), TrackerState::kSearching);
}

// The pad, of which less than half is in view, disappears, but the detector still sees it.
TEST(FollowingTracker, ADetectionHasItsOwnUncertainty) {
  const Ellipse whole{100.0, 110.0, 40.0, 36.0, 0.0};
  Detection found{whole, 1.0, 1.0, 6.0, 0.99};
  Tracker tracker({}, std::make_unique<OneEllipseDetector>(found));
  std::int64_t frame = 0;
  for (; found.ellipse.cx > -4.0; ++frame) {
    found.ellipse.cx = 100.0 - 4.0 * static_cast<double>(frame);
    const auto target =
        tracker.process(rendered(plain_ring(), found.ellipse, 320, 240).view(), frame * kFrameNs);
    ASSERT_TRUE(target) << frame;
  }
  ASSERT_EQ(tracker.state(), TrackerState::kFollowing);
  const auto target = tracker.process(GrayPicture(320, 240, 90).view(), frame * kFrameNs);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->ellipse, found.ellipse);
  const RingUncertainty expected = expected_uncertainty(found.ellipse, 320, 240, kPixelError);
  EXPECT_TRUE(target->uncertainty.information.isApprox(expected.information));
}

// Whether the tracker reports an ellipse of this probability after it has lost a certain target.
bool is_found_again(double probability, double shift_px, int lost_frames) {
  Detection found = support::detection_at(160.0, 120.0, 40.0);
  Tracker tracker({}, std::make_unique<OneEllipseDetector>(found));
  const GrayPicture picture(320, 240, 90);
  int frame = 0;
  const auto process = [&] { return tracker.process(picture.view(), frame++ * kFrameNs); };
  found.probability = 0.99;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(process()) << i;
  found.probability = 0.0;
  for (int i = 0; i < lost_frames; ++i) EXPECT_FALSE(process()) << i;
  found.probability = probability;
  found.ellipse.cx += shift_px;
  const bool is_found = process().has_value();
  EXPECT_TRUE(tracker.candidates().empty());  // below min-probability
  return is_found;
}

TEST(FollowingTracker, FindsALessClearTargetWhereACertainOneWasLost) {
  EXPECT_TRUE(is_found_again(0.3, 15.0, 5));
  EXPECT_FALSE(is_found_again(0.05, 15.0, 5));
  EXPECT_FALSE(is_found_again(0.3, 25.0, 5));   // more than half of the semi-major axis
  EXPECT_FALSE(is_found_again(0.3, 15.0, 12));  // for more than .3 s
}

// A hexagon in place of a disc has most of its edges within reach of the disc's outline.
TEST(FollowingTracker, DropsTargetsThatAreNoLongerEllipses) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  const Film film(scene);
  const Ellipse disc = Film::truth_at(0);
  Tracker tracker;
  for (int frame = 0; frame < 30; ++frame) {
    ASSERT_TRUE(tracker.process(film.at(0).view(), frame * kFrameNs)) << frame;
  }
  GrayPicture hexagon = film.empty();
  const GrayPicture paint = film.at(0);
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

// The ball is detected in each frame: the pad tracker locks on outlines of one polarity only.
// In 58 of 60 frames the error is below .1 px. A frame in which the first fit follows the shading
// inside may be off by .41 px.
TEST(FollowingTracker, FollowsABallBrighterThanTheGroundAboveAndDarkerBelow) {
  Tracker tracker;
  std::vector<double> errors_px;
  for (int frame = 0; frame < 60; ++frame) {
    const Ellipse truth{130.3 + frame, 120.6, 50.0, 50.0, 0.0};
    const auto target =
        tracker.process(support::lit_ball(truth, 320, 240).view(), frame * kFrameNs);
    ASSERT_TRUE(target) << frame;
    EXPECT_EQ(target->id, 1U) << frame;
    errors_px.push_back(max_difference_px(target->ellipse, truth));
    EXPECT_LT(errors_px.back(), 0.5) << frame;
  }
  std::sort(errors_px.begin(), errors_px.end());
  EXPECT_LT(errors_px[57], 0.1);
}

TEST(FollowingTracker, KeepsTheIdThroughFramesWithoutTheTarget) {
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
  // After a long absence the target is lost; the next one gets a new id.
  for (int frame = 26; frame < 60; ++frame) {
    EXPECT_FALSE(tracker.process(film.empty().view(), frame * kFrameNs)) << frame;
  }
  const auto other = tracker.process(film.at(0).view(), 60 * kFrameNs);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->id, 2U);
}

// At the end, its outer edge is a short arc, which hardly determines the centre.
TEST(FollowingTracker, KnowsTheCentreOfATargetThatLeavesThePicture) {
  SceneRenderer renderer(scene_by_name("reenter", 962));
  GrayPicture picture(640, 360);
  Tracker tracker;
  int short_arcs = 0;
  for (int frame = 0; frame < 155; ++frame) {
    const Truth truth =
        renderer.render(frame / 30.0, static_cast<std::uint64_t>(frame), picture.writable());
    const auto target = tracker.process(picture.view(), frame * kFrameNs);
    if (frame < 130) continue;
    ASSERT_TRUE(target) << frame;
    const Ellipse& edge = truth.outer_edge.value();
    EXPECT_LT((target->ellipse.center() - edge.center()).norm(), 0.045 * edge.semi_major) << frame;
    short_arcs += truth.visible_fraction < 0.15 ? 1 : 0;
  }
  EXPECT_EQ(short_arcs, 6);
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

TEST(FollowingTracker, TracksSmallTargetsBelowTheDetectorsScale) {
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

TEST(FollowingTracker, RefinesTargetsFoundAtACoarseScale) {
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

TEST(FollowingTracker, SwitchesFromADiscOrASmallerRingToThePad) {
  Scene disc = plain_ring();
  disc.pad.pattern = Pattern::kDisc;
  const Ellipse lone{60.0, 60.0, 34.0, 30.0, 0.0};
  const Ellipse pad{220.0, 150.0, 44.0, 38.0, 0.2};
  const Ellipse small_ring{60.0, 60.0, 20.0, 17.0, 0.0};
  const GrayPicture with_disc = rendered(disc, lone);
  const GrayPicture with_ring = rendered(plain_ring(), small_ring);
  for (const auto& [before, wrong] : {std::pair{with_disc, lone}, {with_ring, small_ring}}) {
    const GrayPicture after = both(before, rendered(plain_ring(), pad));
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

// As an eye that opens: the reflection inside the pupil comes into view first.
TEST(FollowingTracker, SwitchesFromAReflectionToThePupilAroundIt) {
  Scene lit = plain_ring();
  lit.pad.pattern = Pattern::kDisc;
  lit.pad.paint_level = 240.0;
  lit.ground.level = 90.0;
  Scene dark = lit;
  dark.pad.paint_level = 30.0;
  const Ellipse reflection{140.0, 110.0, 16.0, 15.0, 0.0};
  const Ellipse pupil{165.0, 118.0, 60.0, 56.0, 0.2};
  const GrayPicture closed = rendered(lit, reflection);
  GrayPicture open = rendered(dark, pupil);
  for (int y = 0; y < open.height; ++y) {
    for (int x = 0; x < open.width; ++x) {
      if (sampson_distance(reflection, {x, y}) < 0.0) open.at(x, y) = 240;
    }
  }
  Tracker tracker;
  std::optional<Target> target = tracker.process(closed.view(), 0);
  ASSERT_TRUE(target);
  EXPECT_GT(iou_inside(target->ellipse, reflection, 320, 240), 0.9);
  for (int frame = 1; frame < 10; ++frame) {
    target = tracker.process(open.view(), frame * kFrameNs);
  }
  ASSERT_TRUE(target);
  EXPECT_GT(iou_inside(target->ellipse, pupil, 320, 240), 0.9) << target->ellipse.semi_major;
}

// The search may end at a reduced size, with the larger disc alone.
TEST(FollowingTracker, StaysOnASmallTargetBesideALargerDisc) {
  Scene disc = plain_ring();
  disc.pad.pattern = Pattern::kDisc;
  for (const Scene& small : {plain_ring(), disc}) {
    for (const double radius : {14.0, 18.0, 22.0, 26.0}) {
      for (const double other : {26.0, 40.0, 60.0}) {
        const Ellipse truth{70.0, 60.0, radius, 0.85 * radius, 0.2};
        const GrayPicture before = rendered(small, truth);
        const GrayPicture after =
            both(before, rendered(disc, {220.0, 150.0, other, 0.85 * other, 0.1}));
        Tracker tracker;
        for (int frame = 0; frame < 40; ++frame) {
          const GrayPicture& picture = frame < 20 ? before : after;
          const auto target = tracker.process(picture.view(), frame * kFrameNs);
          ASSERT_TRUE(target);
          EXPECT_GT(iou_inside(target->ellipse, truth, 320, 240), 0.9)
              << radius << " beside " << other << ", frame " << frame;
        }
      }
    }
  }
}

TEST(FollowingTracker, ReportsCandidatesInEveryFrameOnRequest) {
  const GrayPicture picture = rendered(plain_ring(), {160.0, 120.0, 60.0, 50.0, 0.2});
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

TEST(FollowingTracker, IsDeterministic) {
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
