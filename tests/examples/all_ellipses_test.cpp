// SPDX-License-Identifier: MIT
//
// Frames with several true ellipses: correct answers, and the comparison of all ellipses.
#include "examples/evaluate/all_ellipses.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "examples/evaluate/matching.hpp"
#include "tests/examples/judged_frame.hpp"

namespace evaluate {
namespace {

const ellipse::Ellipse kLeft{80.0, 120.0, 40.0, 30.0, 0.3};
const ellipse::Ellipse kRight{240.0, 120.0, 40.0, 30.0, 0.3};
const ellipse::Ellipse kElsewhere{160.0, 30.0, 20.0, 20.0, 0.0};

Truth both() {
  Truth truth{kLeft, {}, true};
  truth.others.push_back({kRight, {}});
  return truth;
}

ellipse::Ellipse moved(ellipse::Ellipse e, double dx) {
  e.cx += dx;
  return e;
}

TEST(SeveralEllipses, AnswersThatMatchAnyEllipseAreRight) {
  EXPECT_EQ(judge(kLeft, both(), kFrame, Rule::kIou), Outcome::kTruePositive);
  EXPECT_EQ(judge(kRight, both(), kFrame, Rule::kIou), Outcome::kTruePositive);
  EXPECT_EQ(judge(kElsewhere, both(), kFrame, Rule::kIou), Outcome::kWrong);
  EXPECT_EQ(judge(std::nullopt, both(), kFrame, Rule::kIou), Outcome::kFalseNegative);
  EXPECT_EQ(matched_ellipse(moved(kRight, 2.0), both(), kFrame, Rule::kIou), kRight);
}

TEST(SeveralEllipses, CountAsMissedUnlessAllAreHardlyVisible) {
  Truth truth = both();
  truth.visible_fraction = 0.1;
  EXPECT_EQ(judge(std::nullopt, truth, kFrame, Rule::kIou), Outcome::kFalseNegative);
  truth.others[0].visible_fraction = 0.1;
  EXPECT_EQ(judge(std::nullopt, truth, kFrame, Rule::kIou), Outcome::kTrueNegative);
}

TEST(Matching, PrefersTwoLighterPairsToOneHeavyPair) {
  // Greedy matching takes 0-0 and leaves 1 without a partner.
  const auto matches = match_one_to_one(2, 2, {{0, 0, 0.95}, {0, 1, 0.81}, {1, 0, 0.82}});
  EXPECT_EQ(matches, (std::vector<std::optional<std::size_t>>{1, 0}));
}

TEST(Matching, MaximizesTheWeightAmongTheLargestMatchings) {
  const auto matches =
      match_one_to_one(2, 2, {{0, 0, 0.8}, {0, 1, 0.9}, {1, 0, 0.9}, {1, 1, 0.85}});
  EXPECT_EQ(matches, (std::vector<std::optional<std::size_t>>{1, 0}));
}

TEST(Matching, FollowsLongAlternatingPaths) {
  // Each left node first takes its own right node; the last left node has an edge to the first
  // only.
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < 20; ++i) edges.push_back({i, i, 1.0});
  for (std::size_t i = 0; i < 20; ++i) edges.push_back({i, i + 1, 0.8});
  edges.push_back({20, 0, 0.8});
  const auto matches = match_one_to_one(21, 21, edges);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(matches[i], i + 1);
  EXPECT_EQ(matches[20], 0U);
}

TEST(AllEllipses, AreMatchedOneToOne) {
  // The left ellipse twice, an ellipse that does not exist, and no right ellipse.
  const std::vector<ellipse::Ellipse> found = {moved(kLeft, 3.0), kLeft, kElsewhere};
  const AllResult result = compare_all(found, both(), kFrame);
  EXPECT_EQ(result.counts.right, 1);
  EXPECT_EQ(result.counts.mistaken, 2);
  EXPECT_EQ(result.counts.missed, 1);
  EXPECT_EQ(result.centre_errors_px, std::vector<double>{0.0});  // of the better match
}

TEST(AllEllipses, ErrorsAreOfCentreAndAxes) {
  ellipse::Ellipse off = moved(kRight, 1.5);
  off.semi_major += 0.5;
  off.semi_minor -= 2.0;
  const AllResult result = compare_all(std::vector{off}, both(), kFrame);
  EXPECT_DOUBLE_EQ(result.centre_errors_px.at(0), 1.5);
  EXPECT_DOUBLE_EQ(result.axis_errors_px.at(0), 2.0);
}

TEST(AllEllipses, HardlyVisibleOnesDoNotCount) {
  Truth truth = both();
  truth.others[0].visible_fraction = 0.2;
  EXPECT_EQ(compare_all({}, truth, kFrame).counts.missed, 1);
  const AllResult result = compare_all(std::vector{kLeft, kRight}, truth, kFrame);
  EXPECT_EQ(result.counts.right, 1);
  EXPECT_EQ(result.counts.mistaken, 0);
  truth.is_labelled = false;
  EXPECT_EQ(compare_all(std::vector{kElsewhere}, truth, kFrame).counts.mistaken, 0);
}

}  // namespace
}  // namespace evaluate
