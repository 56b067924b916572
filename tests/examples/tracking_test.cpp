// SPDX-License-Identifier: MIT
//
// Tracking measures by the visible part, on hand-made answers.
#include "examples/evaluate/tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "examples/evaluate/tracking_tables.hpp"
#include "tests/examples/judged_frame.hpp"

namespace evaluate {
namespace {

const ellipse::Ellipse kAround{160.0, 120.0, 400.0, 350.0, 0.3};  // larger than the frame
const ellipse::Ellipse kOther{60.0, 60.0, 30.0, 30.0, 0.0};
constexpr double kOut = -1.0;  // nothing of the target is in view
constexpr double kNever = std::numeric_limits<double>::infinity();

enum class Says { kRight, kNear, kWrong, kNone, kGiven };

struct Step {
  double visible;
  Says says;
};

Truth truth_of(double visible) {
  if (visible == kOut) return {};
  return {visible > 0.0 ? kTarget : kAround, visible, true};
}

Result result_of(const Step& step) {
  ellipse::Ellipse half = step.visible > 0.0 ? kTarget : kAround;
  Result result;
  result.processing_ms = 2.0;
  if (step.says == Says::kRight || step.says == Says::kGiven) result.answer = half;
  result.is_given = step.says == Says::kGiven;
  if (result.is_given) result.processing_ms = std::nan("");
  half.cx += 0.03 * half.semi_major;
  half.semi_major *= 0.5;
  half.semi_minor *= 0.5;
  if (step.says == Says::kNear) result.answer = half;
  if (step.says == Says::kWrong) result.answer = kOther;
  return result;
}

// One method's prepared answers to some sequences.
class PreparedAnswers {
 public:
  explicit PreparedAnswers(const std::vector<std::vector<Step>>& steps) {
    evaluation_.methods.push_back({"told", {}, {}});
    for (const auto& list : steps) sequences_.push_back({"hand", "made", frames_of(list), {}});
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (std::size_t k = 0; k < steps[i].size(); ++k) {
        evaluation_.frames.push_back({&sequences_[i], &sequences_[i].frames[k], kFrame});
        evaluation_.methods[0].results.push_back(result_of(steps[i][k]));
      }
    }
  }
  [[nodiscard]] const Evaluation& evaluation() const { return evaluation_; }
  [[nodiscard]] TrackingMeasures measures() const {
    return tracking_measures_of(evaluation_, 0, "hand");
  }

 private:
  static std::vector<Frame> frames_of(const std::vector<Step>& list) {
    std::vector<Frame> frames;
    for (const Step& step : list) frames.push_back({"f", {}, 0, 0, truth_of(step.visible), {}});
    return frames;
  }

  std::vector<Sequence> sequences_;
  Evaluation evaluation_;
};

TrackingMeasures measured(const std::vector<Step>& steps) {
  return PreparedAnswers({steps}).measures();
}

TEST(Tracking, SortsFramesByTheVisiblePart) {
  std::vector<Step> steps;
  for (const double visible : {1.0, 0.6, 0.59, 0.3, 0.29, 0.15, 0.14, 0.05, 0.04, 0.001, 0.0}) {
    steps.push_back({visible, Says::kRight});
  }
  const TrackingMeasures m = measured(steps);
  std::vector<int> frames;
  for (const RangeCounts& counts : m.ranges) frames.push_back(counts.frames);
  EXPECT_EQ(frames, (std::vector<int>{2, 2, 2, 2, 2, 1}));
  EXPECT_EQ(m.empty_frames, 0);
}

TEST(Tracking, CountsAnswersByTheirError) {
  const TrackingMeasures m = measured({{1.0, Says::kRight},
                                       {1.0, Says::kRight},
                                       {0.9, Says::kNear},
                                       {0.7, Says::kWrong},
                                       {0.6, Says::kNone}});
  const RangeCounts& counts = m.ranges[0];
  EXPECT_EQ(counts.frames, 5);
  EXPECT_EQ(counts.right, 2);
  EXPECT_EQ(counts.centre_5, 3);
  EXPECT_EQ(counts.centre_2, 2);  // the near one is off by 3 %
  EXPECT_EQ(counts.wrong, 1);
  EXPECT_EQ(counts.none, 1);
  EXPECT_EQ(m.wrong(), 1);
  EXPECT_EQ(m.centre_errors_px, std::vector<double>(2, 0.0));  // of the right answers
}

TEST(Tracking, CountsFromTheFirstFrameWithHalfOfThePerimeterInView) {
  const TrackingMeasures m =
      measured({{0.4, Says::kWrong}, {0.49, Says::kNone}, {0.5, Says::kRight}, {0.4, Says::kNone}});
  EXPECT_EQ(m.ranges[1].frames, 2);
  EXPECT_EQ(m.ranges[1].right, 1);
  EXPECT_EQ(m.ranges[1].none, 1);
  EXPECT_EQ(m.wrong(), 1);         // a wrong answer counts from the first frame on
  EXPECT_TRUE(m.returns.empty());  // the first detection is not a return
}

TEST(Tracking, CountingRestartsAfterTheTargetWasOutOfView) {
  const TrackingMeasures m = measured({{1.0, Says::kRight},
                                       {0.2, Says::kRight},
                                       {kOut, Says::kNone},
                                       {0.2, Says::kNone},
                                       {0.2, Says::kWrong},
                                       {0.5, Says::kRight},
                                       {0.2, Says::kNone}});
  EXPECT_EQ(m.ranges[2].frames, 2);
  EXPECT_EQ(m.ranges[2].none, 1);
  EXPECT_EQ(m.wrong(), 1);
  EXPECT_EQ(m.returns, std::vector<double>{1.0});
}

TEST(Tracking, FalseLocksCountFromTheFirstFrame) {
  const TrackingMeasures m = measured({{kOut, Says::kWrong},
                                       {kOut, Says::kNone},
                                       {1.0, Says::kRight},
                                       {kOut, Says::kRight},
                                       {0.0, Says::kRight}});  // the frame is inside the target
  EXPECT_EQ(m.empty_frames, 3);
  EXPECT_EQ(m.locks_on_nothing, 2);
}

TEST(Tracking, CountsFramesUntilALostTargetIsFoundAgain) {
  const auto returns = [](const std::vector<Step>& after) {
    std::vector<Step> steps = {{1.0, Says::kRight}};
    steps.insert(steps.end(), after.begin(), after.end());
    return measured(steps).returns;
  };
  const Step lost{0.2, Says::kNone};
  const Step gone{kOut, Says::kNone};
  const Step found{0.8, Says::kRight};
  const Step missed{0.8, Says::kNone};
  using List = std::vector<double>;
  EXPECT_EQ(returns({lost, missed, missed, found}), List{3.0});
  EXPECT_EQ(returns({{0.2, Says::kWrong}, {0.8, Says::kNear}, found}), List{2.0});
  EXPECT_EQ(returns({gone, found}), List{1.0});
  EXPECT_EQ(returns({gone, {0.2, Says::kRight}, found, missed, found}), List{1.0});
  EXPECT_EQ(returns({gone, missed, gone, found, lost, missed}), (List{kNever, 1.0, kNever}));
  EXPECT_EQ(returns({lost, missed, lost, found}), (List{kNever, 1.0}));
  // Never lost; lost in full view; target given.
  EXPECT_EQ(returns({{0.2, Says::kRight}, {0.1, Says::kNear}, missed, found}), List{});
  EXPECT_EQ(returns({missed, found}), List{});
  EXPECT_EQ(returns({gone, missed, {0.8, Says::kGiven}, found}), List{});
}

TEST(Tracking, GivenTargetsCountOnlyAsGiven) {
  const TrackingMeasures m = measured({{1.0, Says::kGiven}, {1.0, Says::kRight}});
  EXPECT_EQ(m.given, 1);
  EXPECT_EQ(m.ranges[0].frames, 1);
  EXPECT_EQ(m.times_ms, std::vector<double>{2.0});
}

TEST(Tracking, StateIsResetForEachSequence) {
  const PreparedAnswers two({{{1.0, Says::kRight}, {kOut, Says::kNone}},
                             {{0.2, Says::kWrong}, {0.8, Says::kNone}, {0.8, Says::kRight}}});
  const TrackingMeasures m = two.measures();
  EXPECT_TRUE(m.returns.empty());
  EXPECT_EQ(m.wrong(), 1);  // before the second sequence begins
  EXPECT_EQ(m.ranges[0].frames, 3);
  EXPECT_EQ(m.times_ms.size(), 5U);
  EXPECT_EQ(tracking_measures_of(two.evaluation(), 0, "another").times_ms.size(), 0U);
}

TEST(Tracking, TablesShowSharesAndFrameCounts) {
  const PreparedAnswers answers({{{1.0, Says::kRight},
                                  {0.2, Says::kWrong},
                                  {0.8, Says::kNone},
                                  {0.8, Says::kRight},
                                  {kOut, Says::kWrong},
                                  {kOut, Says::kNone},
                                  {0.7, Says::kNone}}});
  using Rows = std::vector<std::vector<std::string>>;
  EXPECT_EQ(visibility_table(answers.evaluation(), "hand").rows,
            (Rows{{"60 % and more", "told", "4", "0.5000", "0.5000", "0.5000", "0.0000", "0.5000"},
                  {"15 to 30 %", "told", "1", "0.0000", "0.0000", "0.0000", "1.0000", "0.0000"}}));
  const Rows following = following_table(answers.evaluation(), "hand").rows;
  EXPECT_EQ(following,
            (Rows{{"told",
                   "2",
                   "0.5000",
                   "1",
                   "0",
                   "2",
                   "never",
                   "never",
                   "0.5000",
                   "2.000",
                   "2.000",
                   "2.000",
                   "0.000"}}));
  std::ostringstream json;
  write_json_tracking(json, answers.measures());
  EXPECT_NE(json.str().find("\"15 to 30 %\":{\"frames\":1,\"right\":0"), std::string::npos);
  EXPECT_NE(json.str().find("\"frames_to_return_max\":null"), std::string::npos) << json.str();
}

}  // namespace
}  // namespace evaluate
