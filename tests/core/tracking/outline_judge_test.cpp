// SPDX-License-Identifier: MIT
#include "core/tracking/outline_judge.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <span>

#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

// Returns the same odds for every outline.
class CountingDetector final : public Detector {
 public:
  std::span<const Detection> detect(const Picture&, const Thresholds&) override { return {}; }
  std::optional<double> log_odds_of(const Picture& picture,
                                    const Ellipse& e,
                                    const Thresholds&) override {
    ++calls;
    size = {0, 0, picture.luma.width, picture.luma.height};
    outline = e;
    return answer;
  }
  Overlaps detecting_overlaps() const override { return {}; }
  Overlaps tracking_overlaps() const override { return {}; }

  std::optional<double> answer = 5.0;
  int calls = 0;
  Rect size;
  Ellipse outline;
};

class OutlineJudgeTest : public testing::Test {
 protected:
  void SetUp() override {
    target_.ellipse = {120.0, 100.0, 20.0, 15.0, 0.0};
    target_.ellipse_overlap = 1.0;
    target_.visible_fraction = 1.0;
  }
  // Calls of the detector during one second of frames.
  int calls_in_a_second() {
    const int before = detector_.calls;
    for (int frame = 0; frame < 30; ++frame) {
      judge_.advance(1.0 / 30.0);
      judge_.judge(detector_, part_, target_, {});
    }
    return detector_.calls - before;
  }

  support::GrayPicture frame_{640, 360};
  Picture part_ = Picture(frame_.view()).part({40, 20, 200, 160});
  Target target_;
  CountingDetector detector_;
  OutlineJudge judge_;
};

TEST_F(OutlineJudgeTest, JudgesEveryFrameUntilItIsCertain) {
  detector_.answer = 0.0;
  judge_.start(0.0, -0.4);
  EXPECT_EQ(calls_in_a_second(), 30);
  detector_.answer = 5.0;
  judge_.start(5.0, -0.4);
  EXPECT_LT(calls_in_a_second(), 8);
}

TEST_F(OutlineJudgeTest, EvaluatesOnRequestAtMostOncePerFrame) {
  judge_.start(5.0, -0.4);
  judge_.judge(detector_, part_, target_, {});
  judge_.advance(1.0 / 30.0);
  detector_.answer = -2.0;
  EXPECT_EQ(judge_.evaluate(detector_, part_, target_, {}), -2.0);
  EXPECT_LT(judge_.log_odds(), 4.6);
  const int before = detector_.calls;
  EXPECT_EQ(judge_.evaluate(detector_, part_, target_, {}), -2.0);
  EXPECT_EQ(detector_.calls, before);
}

// The detector finds no edges along an outline that is outside the picture.
TEST_F(OutlineJudgeTest, DoesNotEvaluateAShortArc) {
  detector_.answer = -std::numeric_limits<double>::infinity();
  target_.visible_fraction = 0.4;
  for (const double log_odds : {0.5, 5.0}) {
    judge_.start(log_odds, 0.0);
    EXPECT_EQ(calls_in_a_second(), 0);
    EXPECT_FALSE(judge_.evaluate(detector_, part_, target_, {}));
    EXPECT_EQ(judge_.log_odds(), log_odds);
  }
}

TEST_F(OutlineJudgeTest, HasNoEvidenceIfTheDetectorGivesNone) {
  judge_.start(5.0, -0.4);
  judge_.advance(1.0 / 30.0);
  detector_.answer = {};
  EXPECT_FALSE(judge_.evaluate(detector_, part_, target_, {}));
  EXPECT_EQ(judge_.log_odds(), 4.6);
}

TEST_F(OutlineJudgeTest, JudgesAtOnceIfLessIsMatched) {
  judge_.start(5.0, -0.4);
  judge_.judge(detector_, part_, target_, {});
  judge_.advance(1.0);
  judge_.judge(detector_, part_, target_, {});
  const int before = detector_.calls;
  judge_.judge(detector_, part_, target_, {});
  EXPECT_EQ(detector_.calls, before);
  judge_.advance(1.0 / 30.0);
  target_.ellipse_overlap = 0.8;
  judge_.judge(detector_, part_, target_, {});
  EXPECT_EQ(detector_.calls, before + 1);
}

TEST_F(OutlineJudgeTest, PassesOnlyTheSurroundingsOfTheOutline) {
  judge_.start(0.0, -0.4);
  judge_.advance(1.0 / 30.0);
  judge_.judge(detector_, part_, target_, {});
  // 120 px +- 2 x 20 px, and the last pixel, on a grid of 4 px: [80, 164).
  EXPECT_EQ(detector_.size.width, 84);
  EXPECT_DOUBLE_EQ(detector_.outline.cx, 40.0);
}

TEST_F(OutlineJudgeTest, OddsFallWithTheEvidence) {
  judge_.start(5.0, -0.4);
  detector_.answer = -5.0;
  (void)calls_in_a_second();
  EXPECT_LT(judge_.log_odds(), -kCertainLogOdds);
  (void)calls_in_a_second();
  EXPECT_EQ(judge_.log_odds(), -TargetOdds::kMax);
}

}  // namespace
}  // namespace ellipse
