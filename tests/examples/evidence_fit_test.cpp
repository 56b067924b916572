// SPDX-License-Identifier: MIT
//
// The detector's evidence table, fitted to labelled frames.
#include "examples/evaluate/evidence_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/catalog.hpp"
#include "core/tracking/tracker.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/rendered.hpp"
#include "examples/evaluate/scenes.hpp"
#include "examples/evaluate/wild.hpp"

namespace evaluate {
namespace {

bool go_on(const Frame& /*frame*/) {
  return true;
}

std::vector<Sequence> wild_frames(const char* name) {
  std::optional<std::vector<Sequence>> sequences = wild_by_name(name, 0.0);
  return sequences ? std::move(*sequences) : std::vector<Sequence>{};
}

std::vector<Sequence> frames_to_fit() {
  std::vector<Sequence> sequences = wild_frames("wild-frames:1-40");
  for (const Sequence& sequence : make_clutter({1, 2}, {2.0, 1.0})) sequences.push_back(sequence);
  return sequences;
}

struct Answers {
  int targets = 0;
  int right = 0;  // of the targets
};

Answers answers_on(const std::vector<Sequence>& sequences,
                   const ellipse::TrackerSettings& settings) {
  Answers answers;
  for (const Sequence& sequence : sequences) {
    for (const Frame& frame : sequence.frames) {
      const cv::Mat picture = sequence.pictures->picture(frame);
      const ellipse::ImageView view{
          picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)};
      ellipse::Tracker tracker(settings);
      const auto target = tracker.process(view, 0);
      if (!target) continue;
      ++answers.targets;
      for (const TrueEllipse& truth : ellipses_of(frame.truth)) {
        const FrameSize size{picture.cols, picture.rows, nullptr};
        if (iou_of(target->ellipse, truth.ellipse, size) < 0.8) continue;
        ++answers.right;
        break;
      }
    }
  }
  return answers;
}

TEST(EvidenceFit, SeparatesEllipsesFromUnseenClutter) {
  EvidenceFitter fitter({}, frames_to_fit(), go_on);
  const ellipse::EvidenceTable table = fitter.fit_all();
  EXPECT_TRUE(fitter.problems().empty());
  EXPECT_EQ(fitter.fit_all(), table);
  ellipse::TrackerSettings settings;
  settings.tracking = ellipse::TrackingMode::kNone;
  settings.evidence = table;
  EXPECT_GE(answers_on(make_scenes({7}, {1.0, 1.0}), settings).right, 12);     // of 18
  EXPECT_LE(answers_on(make_clutter({7}, {4.0, 1.0}), settings).targets, 10);  // of 24
}

TEST(EvidenceFit, UsesOnlyTheGivenSources) {
  EvidenceFitter both({}, frames_to_fit(), go_on);
  std::vector<Sequence> with_more = frames_to_fit();
  for (Sequence sequence : wild_frames("wild-frames:50-60")) {
    sequence.dataset = "more";
    with_more.push_back(sequence);
  }
  EvidenceFitter all({}, with_more, go_on);
  EXPECT_EQ(all.choose({"wild", "clutter"}).settings.evidence, both.fit_all());
  EXPECT_NE(all.fit_all(), both.fit_all());
}

TEST(EvidenceFit, CountsNoUnlistedEllipseAsWrong) {
  const std::vector<Sequence> distractors = {
      make_rendered("mine", "distractors", ellipse::scene_by_name("distractors", 1), {0.0, 1, 1})};
  ASSERT_FALSE(distractors.front().frames.front().truth.is_complete);
  try {
    (void)EvidenceFitter({}, distractors, go_on).fit_all();
    FAIL() << "was fitted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "--fit-evidence: every candidate in the frames is an ellipse");
  }
}

// The scene "occluded" behind bars eight times as wide.
std::vector<Sequence> behind_wide_bars(std::uint64_t seed) {
  ellipse::Scene scene = ellipse::scene_by_name("occluded", seed);
  for (ellipse::Bar& bar : scene.bars) bar.width *= 8.0;
  return {make_rendered("mine", "bars", scene, {0.0, 40, 1, 2.0})};
}

TEST(EvidenceFit, ImprovesOnFootageThatIsHardForTheBuiltInTable) {
  std::vector<Sequence> sequences = frames_to_fit();
  sequences.push_back(behind_wide_bars(1).front());
  ellipse::TrackerSettings settings;
  settings.tracking = ellipse::TrackingMode::kNone;
  const int before = answers_on(behind_wide_bars(2), settings).right;
  settings.evidence = EvidenceFitter({}, sequences, go_on).fit_all();
  const int after = answers_on(behind_wide_bars(2), settings).right;
  RecordProperty("before", before);
  RecordProperty("after", after);
  EXPECT_GE(after, before + 5);
}

TEST(EvidenceFit, MeasuresTheCalibrationOnLeftOutSources) {
  std::vector<Sequence> sequences = frames_to_fit();
  for (Sequence sequence : wild_frames("wild-frames:50-70")) {
    sequence.dataset = "eyes and pads";
    sequences.push_back(sequence);
  }
  const EvidenceFitter fitter({}, sequences, go_on);
  const Calibration calibration = fitter.left_out_calibration(SourceGroups());
  const CalibrationBin& low = calibration.bins.front();
  const CalibrationBin& high = calibration.bins.back();
  EXPECT_GT(low.candidates, 100);
  EXPECT_GT(high.candidates, 20);
  EXPECT_LT(low.right, 0.1);
  EXPECT_GT(high.right, low.right + 0.4);
  EXPECT_LT(low.probability, 0.1);
  EXPECT_GT(high.probability, 0.9);
  for (const CalibrationBin& bin : calibration.bins) {
    const double right = bin.right * bin.candidates;  // a count: each candidate weighs 1
    EXPECT_NEAR(right, std::round(right), 1e-6);
  }
  EXPECT_GT(calibration.log_loss, 0.0);
  EXPECT_LT(calibration.log_loss, 0.3);
  EXPECT_EQ(calibration_table(calibration).rows.size(), 10U);
}

TEST(EvidenceFit, RequiresFramesWithAndWithoutEllipses) {
  const EvidenceFitter none({}, make_clutter({1}, {1.0, 1.0}), go_on);
  EXPECT_THROW((void)none.fit_all(), std::invalid_argument);
}

}  // namespace
}  // namespace evaluate
