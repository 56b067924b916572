// SPDX-License-Identifier: MIT
//
// Processing of the answers: measures, tables, report, sweeps.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "examples/evaluate/box_peers.hpp"
#include "examples/evaluate/breakdown.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/method.hpp"
#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/report.hpp"
#include "examples/evaluate/sweep.hpp"
#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/twin.hpp"
#include "tests/examples/judged_frame.hpp"
#include "tests/support/temporary_folder.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

Truth truth_of(const std::optional<ellipse::Ellipse>& target, double visible = 1.0) {
  return {target, visible, true};
}

TEST(Measures, JudgesEachOutcome) {
  const ellipse::Ellipse other{60.0, 60.0, 30.0, 30.0, 0.0};
  const auto of = [](const auto& answer, const Truth& truth) {
    return judge(answer, truth, kFrame, Rule::kIou);
  };
  EXPECT_EQ(of(std::optional(kTarget), truth_of(kTarget)), Outcome::kTruePositive);
  EXPECT_EQ(of(std::optional(other), truth_of(kTarget)), Outcome::kWrong);
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), truth_of(kTarget)), Outcome::kFalseNegative);
  EXPECT_EQ(of(std::optional(other), Truth{}), Outcome::kFalsePositive);
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), Truth{}), Outcome::kTrueNegative);
  // Hardly visible: a hit counts, a miss is a true negative, a wrong answer is not judged.
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), truth_of(kTarget, 0.2)), Outcome::kTrueNegative);
  EXPECT_EQ(of(std::optional(other), truth_of(kTarget, 0.2)), Outcome::kNotJudged);
  EXPECT_EQ(of(std::optional(kTarget), Truth{{}, {}, false}), Outcome::kNotJudged);
}

TEST(Measures, TargetsLargerThanTheFrameAreNotJudged) {
  const ellipse::Ellipse around{160.0, 120.0, 400.0, 350.0, 0.3};
  const Truth inside = truth_of(around, 0.0);
  EXPECT_TRUE(is_in_view(inside, kFrame));
  EXPECT_EQ(judge(around, inside, kFrame, Rule::kIou), Outcome::kNotJudged);
  EXPECT_EQ(judge(kTarget, inside, kFrame, Rule::kIou), Outcome::kNotJudged);
  EXPECT_EQ(judge(std::nullopt, inside, kFrame, Rule::kIou), Outcome::kTrueNegative);
  ellipse::Ellipse aside = around;
  aside.cx += 1000.0;
  EXPECT_FALSE(is_in_view(truth_of(aside, 0.0), kFrame));
  EXPECT_EQ(judge(aside, truth_of(aside, 0.0), kFrame, Rule::kIou), Outcome::kFalsePositive);
}

TEST(Measures, RulesApplyTheirOwnLimits) {
  ellipse::Ellipse shifted = kTarget;
  shifted.cx += 7.9;  // 10 % of the smaller full axis is 8 px
  EXPECT_TRUE(is_right(shifted, kTarget, kFrame, Rule::kPublished));
  shifted.cx += 0.2;
  EXPECT_FALSE(is_right(shifted, kTarget, kFrame, Rule::kPublished));
  ellipse::Ellipse grown = kTarget;
  grown.semi_major *= 1.12;  // overlap 1 / 1.12
  EXPECT_TRUE(is_right(grown, kTarget, kFrame, Rule::kIou));
  EXPECT_FALSE(is_right(grown, kTarget, kFrame, Rule::kPublished));
}

TEST(Measures, AgreeWithThePapersDefinitions) {
  Measures m;
  const auto add = [&](Outcome outcome, int times) {
    for (int i = 0; i < times; ++i) m.add({outcome, 1.0, 1.0, 0.5, 2, {}});
  };
  add(Outcome::kTruePositive, 6);
  add(Outcome::kTrueNegative, 2);
  add(Outcome::kFalsePositive, 1);
  add(Outcome::kFalseNegative, 2);
  add(Outcome::kWrong, 1);
  add(Outcome::kNotJudged, 5);
  EXPECT_EQ(m.judged(), 12);
  EXPECT_DOUBLE_EQ(m.accuracy(), 8.0 / 12.0);
  EXPECT_DOUBLE_EQ(m.precision(), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(m.recall(), 6.0 / 9.0);
  EXPECT_DOUBLE_EQ(m.f1(), 2.0 * 0.75 * (2.0 / 3.0) / (0.75 + 2.0 / 3.0));
  EXPECT_EQ(m.centre_errors_px(1).size(), 6U);
  EXPECT_TRUE(std::isnan(Measures().accuracy()));
}

// Frames of one grey level each, so that a method can identify the frame.
class GreyPictures : public PictureSource {
 public:
  cv::Mat picture(const Frame& frame) override {
    if (frame.name == "bad") throw std::runtime_error("bad: is no picture");
    return {kFrame.height, kFrame.width, CV_8U, cv::Scalar(double(frame.number))};
  }
};

// Returns prepared answers.
class Scripted : public Method {
 public:
  explicit Scripted(std::vector<std::optional<ellipse::Ellipse>> answers)
      : Method("scripted"), answers_(std::move(answers)) {}
  void start(const DistortedFrame* /*distortion*/) override { ++starts; }
  Answer find(const Frame& frame, const cv::Mat& picture, std::int64_t /*pts_ns*/) override {
    EXPECT_EQ(picture.at<std::uint8_t>(0, 0), frame.number);
    return {answers_[frame.number], 1, 2.0 + double(frame.number)};
  }
  int starts = 0;

 private:
  std::vector<std::optional<ellipse::Ellipse>> answers_;
};

class HandMade : public testing::Test {
 protected:
  static constexpr std::size_t kFrames = 6;

  HandMade() {
    ellipse::Ellipse grown = kTarget;  // right by overlap, not by the published rule
    grown.semi_major *= 1.12;
    ellipse::Ellipse shifted = kTarget;  // right by the published rule, not by overlap
    shifted.cx += 7.0;
    shifted.cy -= 3.5;
    shifted.semi_major *= 0.92;
    shifted.semi_minor *= 0.92;
    const ellipse::Ellipse other{60.0, 60.0, 30.0, 30.0, 0.0};
    const std::vector<std::optional<ellipse::Ellipse>> answers = {
        kTarget, grown, shifted, other, std::nullopt, std::nullopt};
    for (std::size_t i = 0; i < kFrames; ++i) {
      const Truth truth = i == 5 ? Truth{} : truth_of(kTarget);
      sequence_.frames.push_back({"f" + std::to_string(i), {}, i, 0, truth, {}});
    }
    methods_.push_back(std::make_unique<Scripted>(answers));
  }

  Evaluation run(Rule rule, int max_frames = 100) {
    return evaluate(sequences(), methods_, rule, [max_frames](const Frame&) mutable {
      return --max_frames > 0;
    });
  }
  std::vector<Sequence>& sequences() {
    all_ = {sequence_};
    return all_;
  }
  static Measures measures(const Evaluation& evaluation) {
    return measures_of(evaluation, 0, [](const SeenFrame&) { return true; });
  }

  Sequence sequence_{"hand", "made", {}, std::make_shared<GreyPictures>()};
  std::vector<Sequence> all_;
  std::vector<std::unique_ptr<Method>> methods_;
};

TEST_F(HandMade, CountsMatchByTheOverlapRule) {
  const Measures m = measures(run(Rule::kIou));
  EXPECT_EQ(m.count(Outcome::kTruePositive), 2);  // the target, the grown one
  EXPECT_EQ(m.count(Outcome::kWrong), 2);         // the shifted one, another one
  EXPECT_EQ(m.count(Outcome::kFalseNegative), 1);
  EXPECT_EQ(m.count(Outcome::kTrueNegative), 1);
  EXPECT_DOUBLE_EQ(m.f1(), 2.0 * 2.0 / (2.0 * 2.0 + 1.0 + 2.0 * 2.0));
}

TEST_F(HandMade, CountsMatchByThePublishedRule) {
  const Measures m = measures(run(Rule::kPublished));
  EXPECT_EQ(m.count(Outcome::kTruePositive), 2);  // the target, the shifted one
  EXPECT_EQ(m.count(Outcome::kWrong), 2);         // the grown one, another one
}

TEST_F(HandMade, InterruptionKeepsTheResultsSoFar) {
  const Evaluation evaluation = run(Rule::kIou, 3);
  EXPECT_TRUE(evaluation.is_interrupted);
  EXPECT_EQ(evaluation.frames.size(), 3U);
  EXPECT_EQ(evaluation.planned_frames, kFrames);
  EXPECT_EQ(measures(evaluation).judged(), 3);
}

TEST_F(HandMade, UnreadableFramesAreCountedAndReported) {
  sequence_.frames[2].name = "bad";
  const Evaluation evaluation = run(Rule::kIou);
  EXPECT_EQ(evaluation.missing_frames, 1U);
  EXPECT_EQ(evaluation.frames.size(), kFrames - 1);
  ASSERT_EQ(evaluation.problems.size(), 1U);
  EXPECT_NE(evaluation.problems[0].find("bad"), std::string::npos);
}

TEST_F(HandMade, MethodsAreRestartedForEachSequence) {
  std::vector<Sequence> twice = {sequence_, sequence_};
  (void)evaluate(twice, methods_, Rule::kIou, [](const Frame&) { return true; });
  EXPECT_EQ(static_cast<const Scripted&>(*methods_[0]).starts, 2);
}

TEST_F(HandMade, TablesShowTheCountsAndTimes) {
  const Evaluation evaluation = run(Rule::kIou);
  const Table measures = measures_table(evaluation, "hand");
  EXPECT_EQ(measures.rows,
            (std::vector<std::vector<std::string>>{
                {"scripted", "0.5000", "0.5000", "0.4000", "0.4444", "2", "1", "0", "1", "2"}}));
  const Table times = times_table(evaluation, "hand");
  // TP: frames 0 and 1, of 2 and 3 ms.
  const std::vector<std::string> right = {
      "scripted", "TP", "2", "2.500", "3.000", "2.000", "3.000", "3.000"};
  EXPECT_EQ(times.rows[0], right);
  EXPECT_EQ(times.rows.back()[0], "cv::Canny + cv::findContours");
}

TEST_F(HandMade, ReportHoldsTablesPlotsAndPictures) {
  const support::TemporaryFolder temporary;
  const fs::path folder = temporary.file("report");
  const Evaluation evaluation = run(Rule::kIou, 5);
  write_report(evaluation, "the <command>", {"a & b is missing"}, folder);
  std::ifstream in(folder / "index.html");
  const std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const char* part : {"the &lt;command&gt;",
                           "a &amp; b is missing",
                           "Interrupted after 5 of 6",
                           "<td>0.4444</td>",
                           "<svg",
                           "WD  f3",
                           "data:image/jpeg;base64,"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org"));  // loads nothing remote
}

TEST_F(HandMade, UnansweredFramesHaveNoTime) {
  class Silent : public Method {
   public:
    Silent() : Method("silent") {}
    Answer find(const Frame&, const cv::Mat&, std::int64_t) override {
      return {std::nullopt, 1, std::nan("")};
    }
  };
  methods_[0] = std::make_unique<Silent>();
  const Measures m = measures(run(Rule::kIou));
  EXPECT_EQ(m.frames(), static_cast<int>(kFrames));
  EXPECT_EQ(m.count(Outcome::kFalseNegative), 5);
  EXPECT_TRUE(m.all_times_ms().empty());
}

TEST_F(HandMade, GivenTargetsAreNotJudged) {
  class GivenTruth : public Method {
   public:
    GivenTruth() : Method("told") {}
    Answer find(const Frame&, const cv::Mat&, std::int64_t) override {
      return {kTarget, 1, std::nan(""), true};
    }
  };
  methods_[0] = std::make_unique<GivenTruth>();
  const Evaluation evaluation = run(Rule::kIou);
  EXPECT_EQ(measures(evaluation).count(Outcome::kNotJudged), static_cast<int>(kFrames));
  std::ostringstream lines;
  write_frames(lines, evaluation, 0);
  EXPECT_NE(lines.str().find("\"visible\":1,\"ms\":[null]"), std::string::npos) << lines.str();
}

TEST_F(HandMade, BreakdownOmitsHardlyVisibleTargets) {
  for (Frame& frame : sequence_.frames) frame.truth = truth_of(kTarget, 0.2);
  sequence_.frames[1].truth = truth_of(kTarget, 0.4);
  sequence_.frames[3].truth = truth_of(kTarget, 0.8);
  const auto panels = breakdown(run(Rule::kIou), "hand");
  const auto by_visible = std::find_if(panels.begin(), panels.end(), [](const Panel& panel) {
    return panel.title == "Recall by visible part";
  });
  ASSERT_NE(by_visible, panels.end());
  EXPECT_EQ(by_visible->curves[0].y[0], 1.0);  // frame 1 alone
  EXPECT_EQ(by_visible->curves[0].y[2], 0.0);  // frame 3 alone
}

TEST(Sweep, ParsesRangesAndLists) {
  const Sweep range = parse_sweep("detect-contour-overlap=0.3:0.5:0.05");
  EXPECT_EQ(range.property, "detect-contour-overlap");
  EXPECT_EQ(range.values, (std::vector<std::string>{"0.3", "0.35", "0.4", "0.45", "0.5"}));
  EXPECT_EQ(parse_sweep("max-scale=1,2,8").values, (std::vector<std::string>{"1", "2", "8"}));
  for (const char* bad : {"x", "=1", "x=1:2", "x=a:2:1", "x=2:1:1", "x=1:2:0", "x=0:1:1e-9"}) {
    EXPECT_THROW((void)parse_sweep(bad), std::invalid_argument) << bad;
  }
}

TEST(Sweep, ErrorNamesInvalidProperties) {
  for (const char* bad :
       {"no-such=1:2:1", "detect-contour-overlap=0.5,7", "max-axis=", "tracking=none,best"}) {
    try {
      (void)methods_of(parse_sweep(bad), {});
      ADD_FAILURE() << bad;
    } catch (const std::invalid_argument& error) {
      const std::string property = std::string(bad).substr(0, std::string(bad).find('='));
      EXPECT_NE(std::string(error.what()).find(property), std::string::npos) << error.what();
    }
  }
}

TEST(Methods, AreMadeByNameAndListedDefaultFirst) {
  EXPECT_EQ(method_names().front(), "arcs+edges");
  for (const std::string& name : method_names()) EXPECT_EQ(make_method(name, {})->name(), name);
  EXPECT_THROW((void)make_method("magic", {}), std::invalid_argument);
  // unaided_method_names() excludes the box trackers, which are given the truth.
  EXPECT_EQ(method_names().size(), unaided_method_names().size() + box_peer_names().size());
}

TEST(Quantile, ReturnsOneOfTheValues) {
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 1.0), 3.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.0), 1.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace evaluate
