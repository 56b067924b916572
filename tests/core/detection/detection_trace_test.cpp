// SPDX-License-Identifier: MIT
#include "core/detection/detection_trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/detection/detectors.hpp"
#include "core/detection/target_selection.hpp"
#include "core/detection/trace_image.hpp"
#include "core/image/scale.hpp"
#include "core/scene/catalog.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/finding.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::detecting;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;

const Ellipse kRing{160.2, 119.7, 60.0, 45.0, 0.4};

GrayPicture of_scene(const char* name, double time_s) {
  GrayPicture picture(640, 360);
  (void)SceneRenderer(scene_by_name(name)).render(time_s, 0, picture.writable());
  return picture;
}

using Change = std::function<void(Thresholds&)>;

struct Look {
  DetectionTrace trace;
  Thresholds thresholds;
  std::vector<Detection> detections;
  std::optional<Detection> target;
};

Look look_at(DetectorKind kind,
             const GrayPicture& picture,
             const Change& change = {},
             const std::optional<Ellipse>& last_target = {}) {
  Look look;
  const auto detector = make_detector(kind);
  detector->set_trace(&look.trace);
  look.thresholds = detecting(*detector);
  if (change) change(look.thresholds);
  const auto found = detector->detect(picture.view(), look.thresholds);
  look.detections.assign(found.begin(), found.end());
  look.target = select_target(look.detections, last_target, &look.trace);
  return look;
}

const TracedCandidate* first_with(const DetectionTrace& trace, Reason reason) {
  const auto it = std::find_if(trace.candidates().begin(),
                               trace.candidates().end(),
                               [&](const auto& c) { return c.verdict.reason == reason; });
  return it != trace.candidates().end() ? &*it : nullptr;
}

bool has(const Look& look, Reason reason) {
  return first_with(look.trace, reason) != nullptr;
}

class DetectionTraceOf : public testing::TestWithParam<DetectorKind> {
 protected:
  // The first verdict with this reason; accepted if there is none.
  static Verdict verdict_for(Reason reason,
                             const GrayPicture& picture,
                             const Change& change = {},
                             const std::optional<Ellipse>& last_target = {}) {
    const Look look = look_at(GetParam(), picture, change, last_target);
    const TracedCandidate* candidate = first_with(look.trace, reason);
    return candidate != nullptr ? candidate->verdict : Verdict{};
  }
};

INSTANTIATE_TEST_SUITE_P(Detectors,
                         DetectionTraceOf,
                         testing::Values(DetectorKind::kContours, DetectorKind::kArcs),
                         [](const auto& info) {
                           return std::string(detector_nicks()[std::size_t(info.param)]);
                         });

TEST_P(DetectionTraceOf, LeavesTheDetectionsUnchanged) {
  for (const NamedScene& scene : scene_catalog()) {
    const GrayPicture picture = of_scene(scene.name, 4.0);
    const auto plain = make_detector(GetParam());
    const auto expected = plain->detect(picture.view(), detecting(*plain));
    const Look look = look_at(GetParam(), picture);
    ASSERT_EQ(look.detections.size(), expected.size()) << scene.name;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(look.detections[i].ellipse, expected[i].ellipse) << scene.name;
      EXPECT_EQ(look.detections[i].contour_overlap, expected[i].contour_overlap);
      EXPECT_EQ(look.detections[i].ellipse_overlap, expected[i].ellipse_overlap);
      EXPECT_EQ(look.detections[i].score, expected[i].score);
    }
    const auto target = select_target(expected);
    ASSERT_EQ(look.target.has_value(), target.has_value()) << scene.name;
    if (!target) continue;
    EXPECT_EQ(look.target->ellipse, target->ellipse) << scene.name;
  }
}

TEST_P(DetectionTraceOf, ListsEachDetectionAndOneTarget) {
  const Look look = look_at(GetParam(), rendered(plain_ring(), kRing));
  ASSERT_TRUE(look.target);
  int targets = 0;
  for (const TracedCandidate& candidate : look.trace.candidates()) {
    targets += candidate.is_target ? 1 : 0;
    if (!candidate.is_target) continue;
    EXPECT_EQ(*candidate.ellipse, look.target->ellipse);
    EXPECT_EQ(candidate.score, look.target->score);
    EXPECT_TRUE(candidate.verdict.is_accepted());
  }
  EXPECT_EQ(targets, 1);
  for (const Detection& detection : look.detections) {
    const auto& candidate = look.trace.candidates()[std::size_t(detection.candidate)];
    EXPECT_EQ(*candidate.ellipse, detection.ellipse);
    EXPECT_FALSE(candidate.pieces.empty());
  }
}

TEST_P(DetectionTraceOf, ReportsTooSmallInFramePixels) {
  const Verdict verdict = verdict_for(
      Reason::kTooSmall, rendered(plain_ring(), kRing), [](auto& t) { t.min_axis_px = 110.0; });
  EXPECT_EQ(verdict.limit, 110.0);
  EXPECT_NEAR(verdict.measured, 2.0 * kRing.semi_minor, 25.0);  // of the outer or inner edge
}

TEST_P(DetectionTraceOf, ReportsTooLarge) {
  const Verdict verdict = verdict_for(
      Reason::kTooLarge, rendered(plain_ring(), kRing), [](auto& t) { t.max_axis_px = 80.0; });
  EXPECT_EQ(verdict.limit, 80.0);
  EXPECT_NEAR(verdict.measured, 2.0 * kRing.semi_major, 35.0);
}

TEST_P(DetectionTraceOf, ReportsTooFlat) {
  const Verdict verdict = verdict_for(
      Reason::kTooFlat, rendered(plain_ring(), kRing), [](auto& t) { t.max_axis_ratio = 1.2; });
  EXPECT_EQ(verdict.limit, 1.2);
  EXPECT_NEAR(verdict.measured, kRing.aspect_ratio(), 0.05);
}

TEST_P(DetectionTraceOf, ReportsContourTooShort) {
  const Verdict verdict = verdict_for(Reason::kContourTooShort,
                                      rendered(plain_ring(), kRing),
                                      [](auto& t) { t.min_contour_size = 1000; });
  EXPECT_EQ(verdict.limit, 1000.0);
  EXPECT_GT(verdict.measured, 5.0);
}

TEST_P(DetectionTraceOf, ReportsContourOverlap) {
  const Verdict verdict = verdict_for(
      Reason::kContourOverlap, of_scene("glare", 0.5), [](auto& t) { t.contour_overlap = 1.0; });
  EXPECT_EQ(verdict.limit, 1.0);
  EXPECT_GT(verdict.measured, 0.0);
}

TEST_P(DetectionTraceOf, ReportsEllipseOverlap) {
  Scene scene = plain_ring();
  scene.pad.gaps_rad = {1.0, 3.1, 5.2};
  scene.pad.gap_width_rad = 1.2;
  const Verdict verdict = verdict_for(Reason::kEllipseOverlap, rendered(scene, kRing), [](auto& t) {
    t.contour_overlap = 0.4;
    t.ellipse_overlap = 1.0;
    t.min_contour_size = 20;
  });
  EXPECT_EQ(verdict.limit, 1.0);
  EXPECT_LT(verdict.measured, verdict.limit);
  EXPECT_GT(verdict.measured, 0.1);
}

TEST_P(DetectionTraceOf, ReportsDuplicates) {
  const auto wanting_all = [](Thresholds& t) { t.wants_all = true; };  // at all scales
  EXPECT_EQ(verdict_for(Reason::kKnown, rendered(plain_ring(), kRing), wanting_all).reason,
            Reason::kKnown);
}

TEST_P(DetectionTraceOf, ReportsInnerEdge) {
  const Verdict verdict = verdict_for(Reason::kInnerEdge, rendered(plain_ring(), kRing));
  EXPECT_NEAR(verdict.limit, 2.0 * kRing.semi_major, 1.0);
  EXPECT_LT(verdict.measured, verdict.limit - 5.0);
}

TEST_P(DetectionTraceOf, ReportsDistanceFromAndSizeOfTheLastTarget) {
  Ellipse last = kRing;
  last.cx -= 100.0;
  const Verdict distance =
      verdict_for(Reason::kTooFarFromLast, rendered(plain_ring(), kRing), {}, last);
  EXPECT_NEAR(distance.measured, 100.0, 0.5);
  EXPECT_EQ(distance.limit, last.semi_major);
  last = scaled(kRing, 3.0);
  last.cx = kRing.cx;
  last.cy = kRing.cy;
  const Verdict size = verdict_for(Reason::kOtherSize, rendered(plain_ring(), kRing), {}, last);
  EXPECT_LT(size.measured, size.limit);
  EXPECT_NEAR(size.limit, last.semi_major, 1e-9);
}

TEST_P(DetectionTraceOf, ReportsWeakerSet) {
  GrayPicture picture = rendered(plain_ring(), kRing, 640, 240);
  const Ellipse small{480.0, 120.0, 30.0, 26.0, 0.1};
  const GrayPicture second = rendered(plain_ring(), small, 640, 240);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    picture.pixels[i] = std::min(picture.pixels[i], second.pixels[i]);
  }
  const Verdict verdict = verdict_for(Reason::kWeakerSet, picture);
  EXPECT_GT(verdict.measured, 0.0);
  EXPECT_LT(verdict.measured, verdict.limit);
}

// Only contours: a detector with probabilities selects by them.
TEST(DetectionTrace, OfContoursReportsSingleEllipses) {
  bool is_reported = false;
  for (double at_s = 4.0; at_s < 8.0; at_s += 0.25) {
    const Look look = look_at(DetectorKind::kContours, of_scene("approach", at_s));
    is_reported = is_reported || has(look, Reason::kSingle);
  }
  EXPECT_TRUE(is_reported);
}

TEST(DetectionTrace, OfContoursReportsWeakInSet) {
  const Look look = look_at(DetectorKind::kContours, of_scene("bullseye", 4.0));
  const TracedCandidate* weak = first_with(look.trace, Reason::kWeakInSet);
  ASSERT_NE(weak, nullptr);
  EXPECT_GT(weak->verdict.measured, 0.0);
  EXPECT_LT(weak->verdict.measured, weak->verdict.limit);
}

TEST_P(DetectionTraceOf, MeasuredValuesMatchTheEllipses) {
  for (const char* name : {"approach", "glare", "oblique"}) {
    const Look look = look_at(GetParam(), of_scene(name, 4.0));
    for (const TracedCandidate& candidate : look.trace.candidates()) {
      if (!candidate.ellipse) continue;
      const Ellipse& e = *candidate.ellipse;
      const Verdict& verdict = candidate.verdict;
      if (verdict.reason == Reason::kTooFlat && GetParam() == DetectorKind::kContours) {
        EXPECT_EQ(verdict.measured, e.aspect_ratio());
        EXPECT_EQ(verdict.limit, look.thresholds.max_axis_ratio);
      }
      if (verdict.reason == Reason::kTooSmall) {
        EXPECT_LT(verdict.measured, look.thresholds.min_axis_px);
        EXPECT_EQ(verdict.limit, look.thresholds.min_axis_px);
      }
    }
  }
}

TEST_P(DetectionTraceOf, PassesHoldEdgesChainsAndPoints) {
  const Look look = look_at(GetParam(), rendered(plain_ring(), kRing));
  for (const TracedPass& pass : look.trace.passes()) {
    EXPECT_EQ(pass.region, (Rect{0, 0, 320, 240}));
    ASSERT_EQ(pass.edges.size(), std::size_t(pass.width) * std::size_t(pass.height));
    EXPECT_EQ(pass.edges.size(), pass.luma.size());
    const auto edges = std::count(pass.edges.begin(), pass.edges.end(), 255);
    // Two edges of the ring, one pixel wide.
    const double length = 2.0 * perimeter_px(kRing) / pass.scale;
    EXPECT_GT(edges, 0.5 * length);
    EXPECT_LT(edges, 1.5 * length);
    EXPECT_GE(pass.chains.size(), 2U);
    EXPECT_GT(pass.edge_high, 0.0);
    for (const TracedPoint& point : pass.points) {
      EXPECT_TRUE(point.x >= 0 && point.x < pass.width && point.y >= 0 && point.y < pass.height);
    }
  }
}

TEST_P(DetectionTraceOf, IsEmptyForAnEmptyPicture) {
  Look look = look_at(GetParam(), rendered(plain_ring(), kRing));
  const auto detector = make_detector(GetParam());
  detector->set_trace(&look.trace);
  EXPECT_TRUE(detector->detect(ImageView{}, look.thresholds).empty());
  EXPECT_TRUE(look.trace.candidates().empty());
}

TEST(DetectionTrace, OfContoursReportsFailedFits) {
  const Look look = look_at(
      DetectorKind::kContours, of_scene("glare", 0.5), [](auto& t) { t.min_contour_size = 20; });
  EXPECT_TRUE(has(look, Reason::kNoEllipse));
}

TEST(DetectionTrace, OfArcsReportsReasonsOfArcsOnly) {
  const struct {
    Reason reason;
    const char* scene;
    double time_s;
    int min_contour_size;
  } kCases[] = {
      {Reason::kPoorFit, "glare", 4.0, 50},
      {Reason::kDuplicateOfRejected, "negative", 0.5, 20},
      {Reason::kTooFewEdges, "negative", 2.0, 50},
      {Reason::kUnlikely, "oblique", 2.0, 50},
  };
  for (const auto& one : kCases) {
    const Look look = look_at(DetectorKind::kArcs, of_scene(one.scene, one.time_s), [&](auto& t) {
      t.min_contour_size = one.min_contour_size;
    });
    EXPECT_TRUE(has(look, one.reason)) << reason_info(one.reason).nick;
  }
}

TEST_P(DetectionTraceOf, LimitsEqualTheSettings) {
  int rejected = 0;
  for (const char* name : {"approach", "glare", "occluded"}) {
    const Look look = look_at(GetParam(), of_scene(name, 6.0), [](auto& t) {
      t.ellipse_overlap = 0.97;
      t.min_contour_size = 20;
    });
    for (const TracedCandidate& candidate : look.trace.candidates()) {
      const Verdict& verdict = candidate.verdict;
      if (reason_info(verdict.reason).setting != std::string_view("ellipse-overlap")) continue;
      EXPECT_EQ(verdict.limit, 0.97) << to_text(verdict);
      EXPECT_LT(verdict.measured, 0.97) << to_text(verdict);
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 0);
}

TEST(DetectionTrace, OfArcsMeasuresTheProbabilityThatWouldAcceptIt) {
  const auto look_with = [](double probability) {
    return look_at(DetectorKind::kArcs, of_scene("glare", 6.0), [&](auto& t) {
      t.min_contour_size = 20;
      t.min_probability = probability;
    });
  };
  const Look look = look_with(0.5);
  const TracedCandidate* found = nullptr;
  for (const TracedCandidate& candidate : look.trace.candidates()) {
    if (candidate.verdict.is_accepted()) found = &candidate;
  }
  ASSERT_NE(found, nullptr);
  ASSERT_GT(found->probability, 0.5);
  EXPECT_EQ(built_in_evidence().probability(found->features), found->probability);
  const auto finds_it = [&](const Look& other) {
    return std::any_of(other.detections.begin(), other.detections.end(), [&](const auto& one) {
      return max_difference_px(one.ellipse, *found->ellipse) < 1.0;
    });
  };
  EXPECT_TRUE(finds_it(look_with(found->probability - 1e-9)));
  const Look stricter = look_with(found->probability + 1e-9);
  for (const Detection& one : stricter.detections) {
    EXPECT_GT(one.probability, found->probability);
  }
}

TEST(DetectionTrace, OfArcsHasThreeScalesIfUncertain) {
  const Look look = look_at(DetectorKind::kArcs, of_scene("negative", 0.5));
  ASSERT_EQ(look.trace.passes().size(), 3U);
  EXPECT_EQ(look.trace.passes()[0].scale, 4);
  EXPECT_EQ(look.trace.passes()[1].scale, 2);
  EXPECT_EQ(look.trace.passes()[2].scale, 1);
}

// A square in the other half of the picture has edges, too.
TEST(DetectionTrace, OfArcsLooksAroundUncertainEllipsesFirst) {
  const Ellipse ring{100.3, 90.7, 28.0, 21.0, 0.4};
  GrayPicture picture = rendered(plain_ring(), ring);
  for (int y = 150; y < 210; ++y) {
    for (int x = 230; x < 290; ++x) picture.pixels[std::size_t(y * picture.width + x)] = 60;
  }
  const auto edges_at_right = [](const TracedPass& pass) {
    int count = 0;
    for (std::size_t i = 0; i < pass.edges.size(); ++i) {
      const bool is_right = static_cast<int>(i) % pass.width > pass.width / 2;
      if (is_right && pass.edges[i] != 0) ++count;
    }
    return count;
  };
  const Look look = look_at(DetectorKind::kArcs, picture);
  const auto passes = look.trace.passes();
  ASSERT_EQ(passes.size(), 2U);
  EXPECT_EQ(passes[0].scale, 4);
  EXPECT_EQ(passes[1].scale, 2);
  EXPECT_GT(edges_at_right(passes[0]), 0);
  EXPECT_EQ(edges_at_right(passes[1]), 0);
  ASSERT_TRUE(look.target);
  EXPECT_NEAR(look.target->ellipse.cx, ring.cx, 0.1);
  EXPECT_NEAR(look.target->ellipse.cy, ring.cy, 0.1);
  ASSERT_FALSE(passes[1].points.empty());
  for (const TracedPoint& point : passes[1].points) {
    const Eigen::Vector2d at(passes[1].scale * point.x, passes[1].scale * point.y);
    EXPECT_LT((at - ring.center()).norm(), ring.semi_major + 5.0);
  }
}

// The ring is found in the reduced picture, the disc around it reaches beyond the ring's
// surroundings.
TEST(DetectionTrace, OfArcsReportsEllipsesThatTheSearchedRegionCuts) {
  GrayPicture picture = rendered(plain_ring(), {100.3, 90.7, 28.0, 21.0, 0.4});
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double inside_px = 44.0 - std::hypot(x - 96.8, y - 130.8);
      const double covered = std::clamp(inside_px + 0.5, 0.0, 1.0);
      picture.at(x, y) =
          static_cast<std::uint8_t>(std::max(0.0, picture.at(x, y) - 31.0 * covered));
    }
  }
  const Look look = look_at(DetectorKind::kArcs, picture);
  const TracedCandidate* cut = first_with(look.trace, Reason::kCut);
  ASSERT_NE(cut, nullptr);
  EXPECT_FALSE(cut->is_detection);
  EXPECT_EQ(first_with(look.trace, Reason::kCrowdedOut), nullptr);
}

TEST(DetectionTrace, OfATrackerIsInFramePixels) {
  const GrayPicture picture = rendered(plain_ring(), kRing);
  TrackerSettings settings;
  settings.tracking = TrackingMode::kNone;
  Tracker tracker(settings);
  DetectionTrace trace;
  tracker.set_trace(&trace);
  const auto target = tracker.process(picture.view(), 0, {{60, 40, 200, 160}, 2});
  ASSERT_TRUE(target);
  const auto it = std::find_if(trace.candidates().begin(),
                               trace.candidates().end(),
                               [](const auto& c) { return c.is_target; });
  ASSERT_NE(it, trace.candidates().end());
  EXPECT_EQ(*it->ellipse, target->ellipse);
  EXPECT_EQ(trace.passes().back().region, (Rect{60, 40, 200, 160}));
  EXPECT_EQ(trace.passes().front().scale % 2, 0);
  tracker.set_trace(nullptr);
  (void)tracker.process(GrayPicture(320, 240).view(), 1);
  EXPECT_FALSE(trace.candidates().empty());
}

TEST(Verdict, ReadsAsASentence) {
  EXPECT_EQ(to_text({Reason::kTooFlat, 6.1, 5.0}), "too flat: axis ratio 6.1, at most 5");
  EXPECT_EQ(to_text({Reason::kTooSmall, 3.25, 5.0}), "too small: minor axis 3.25 px, at least 5");
  EXPECT_EQ(to_text({Reason::kKnown}), "duplicate of another ellipse");
  EXPECT_EQ(to_text({}), "accepted");
}

// The colour of the pixel at the right end of the major axis of kRing.
std::array<int, 3> at_edge(const RgbPicture& picture) {
  const Eigen::Vector2d point = kRing.point_at(0.0) * picture.width / 320.0;
  const auto at = 3 * (std::size_t(std::lround(point.y())) * std::size_t(picture.width) +
                       std::size_t(std::lround(point.x())));
  return {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]};
}

TEST(StagePicture, DrawsEachStage) {
  const Look look = look_at(DetectorKind::kContours, rendered(plain_ring(), kRing));
  for (std::size_t i = 0; i < stage_nicks().size(); ++i) {
    const RgbPicture picture = draw_stage(look.trace, 0, static_cast<Stage>(i));
    ASSERT_EQ(picture.pixels.size(), 3U * 320U * 240U);
    EXPECT_GT(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 80)
        << stage_nicks()[i];
  }
  const auto [red, green, blue] = at_edge(draw_stage(look.trace, 0, Stage::kCandidates));
  EXPECT_GT(green, 200);  // the target
  EXPECT_LT(red, 120);
  EXPECT_LT(blue, 180);
  EXPECT_TRUE(draw_stage(look.trace, 1, Stage::kEdges).pixels.empty());
}

TEST(StagePicture, DrawsContoursThatAreTooShortInGrey) {
  const Look look = look_at(DetectorKind::kContours, rendered(plain_ring(), kRing), [](auto& t) {
    t.min_contour_size = 1000;
  });
  const RgbPicture picture = draw_stage(look.trace, 0, Stage::kChains);
  EXPECT_EQ(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 98);
}

}  // namespace
}  // namespace ellipse
