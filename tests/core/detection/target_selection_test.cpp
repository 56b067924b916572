// SPDX-License-Identifier: MIT
#include "core/detection/target_selection.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/detection/evidence.hpp"

namespace ellipse {
namespace {

TEST(TargetSelection, PrefersConcentricSetsAndTheirOutermost) {
  const std::vector<Detection> found = {
      {{300.0, 200.0, 90.0, 80.0, 0.0}, 1.0, 1.0, 900.0},  // single, best score
      {{100.0, 100.0, 40.0, 35.0, 0.1}, 1.0, 1.0, 300.0},
      {{100.5, 99.5, 32.0, 28.0, 0.1}, 1.0, 1.0, 250.0},
  };
  EXPECT_EQ(select_target(found)->ellipse.semi_major, 40.0);
}

TEST(TargetSelection, TwoFitsToOneEdgeFormNoSet) {
  const std::vector<Detection> found = {
      {{100.0, 100.0, 40.0, 35.0, 0.1}, 1.0, 1.0, 100.0},
      {{100.1, 100.0, 40.4, 35.2, 0.1}, 1.0, 1.0, 90.0},
      {{300.0, 200.0, 90.0, 80.0, 0.0}, 1.0, 1.0, 900.0},
  };
  EXPECT_EQ(select_target(found)->ellipse.cx, 300.0);
  EXPECT_FALSE(select_target({}));
}

TEST(TargetSelection, SkipsWeakOutermostEllipses) {
  const std::vector<Detection> found = {
      {{100.0, 100.0, 60.0, 55.0, 0.1}, 0.7, 0.3, 20.0},
      {{100.0, 100.0, 40.0, 35.0, 0.1}, 1.0, 1.0, 300.0},
      {{100.0, 100.0, 32.0, 28.0, 0.1}, 1.0, 1.0, 250.0},
  };
  EXPECT_EQ(select_target(found)->ellipse.semi_major, 40.0);
}

// Log odds are negative below a probability of one half.
TEST(TargetSelection, ComparesNegativeScores) {
  const Ellipse outer{100.0, 100.0, 60.0, 55.0, 0.1};
  const Ellipse inner{100.0, 100.0, 40.0, 35.0, 0.1};
  const std::vector<Detection> alike = {{inner, 1.0, 1.0, -1.0, 0.27},
                                        {outer, 1.0, 1.0, -1.5, 0.18}};
  EXPECT_EQ(select_target(alike)->ellipse, outer);
  const std::vector<Detection> weak = {{inner, 1.0, 1.0, -1.0, 0.27},
                                       {outer, 1.0, 1.0, -2.0, 0.12}};
  EXPECT_EQ(select_target(weak)->ellipse, inner);
  const Ellipse elsewhere{300.0, 100.0, 60.0, 55.0, 0.1};
  const auto is_better = [&](double score) {
    return is_better_target(
        elsewhere,
        {.ellipse = outer},
        std::vector<Detection>{{outer, 1.0, 1.0, -1.0, 0.27}, {elsewhere, 1.0, 1.0, score, 0.28}});
  };
  EXPECT_FALSE(is_better(-0.9));
  EXPECT_TRUE(is_better(-0.4));
}

// A search that ends at a reduced size may miss edges of the followed target.
TEST(TargetSelection, KeepsAFollowedTargetThatTheSearchMissed) {
  const Ellipse followed{100.0, 100.0, 20.0, 18.0, 0.1};
  const Ellipse disc{300.0, 100.0, 60.0, 55.0, 0.1};
  const std::vector<Detection> found = {{disc, 1.0, 1.0, 6.0, 0.998}};
  EXPECT_TRUE(is_better_target(disc, {.ellipse = followed}, found));
  EXPECT_TRUE(is_better_target(disc, {.ellipse = followed, .score = 3.0}, found));
  EXPECT_FALSE(is_better_target(disc, {.ellipse = followed, .score = 5.0}, found));
  const Ellipse hole{300.0, 100.0, 40.0, 36.0, 0.1};
  const std::vector<Detection> ring = {found[0], {hole, 1.0, 1.0, 1.0, 0.73}};
  EXPECT_TRUE(is_better_target(disc, {.ellipse = followed, .score = 5.0}, ring));
  EXPECT_FALSE(
      is_better_target(disc, {.ellipse = followed, .has_two_edges = true, .score = 5.0}, ring));
  // A ring that is less probable than the followed edge does not replace it.
  const std::vector<Detection> faint = {{disc, 1.0, 1.0, 0.4, 0.6}, {hole, 1.0, 1.0, 0.4, 0.6}};
  EXPECT_TRUE(is_better_target(disc, {.ellipse = followed}, faint));
  EXPECT_FALSE(is_better_target(disc, {.ellipse = followed, .score = 5.0}, faint));
}

// The followed target may be a detail of the better one: a reflection inside a pupil.
TEST(TargetSelection, AnEnclosingTargetNeedsOnlyBeBetter) {
  const Ellipse followed{100.0, 100.0, 20.0, 18.0, 0.1};
  const KnownTarget known{.ellipse = followed, .score = 4.0};
  const Ellipse around{130.0, 100.0, 60.0, 55.0, 0.1};
  const Ellipse across{145.0, 100.0, 60.0, 55.0, 0.1};
  const auto is_better = [&](const Ellipse& chosen, double score) {
    return is_better_target(
        chosen, known, std::vector<Detection>{{chosen, 1.0, 1.0, score, probability_of(score)}});
  };
  EXPECT_TRUE(is_better(around, 4.5));
  EXPECT_FALSE(is_better(around, 3.5));
  EXPECT_FALSE(is_better(across, 4.5));
  EXPECT_TRUE(is_better(across, 6.5));
}

TEST(TargetSelection, AcceptsOnlySimilarEllipsesWhileTracking) {
  const std::vector<Detection> found = {{{100.0, 100.0, 40.0, 35.0, 0.1}, 1.0, 1.0, 100.0}};
  EXPECT_TRUE(select_target(found, Ellipse{120.0, 100.0, 38.0, 30.0, 0.0}));
  EXPECT_FALSE(select_target(found, Ellipse{160.0, 100.0, 38.0, 30.0, 0.0}));
  EXPECT_FALSE(select_target(found, Ellipse{100.0, 100.0, 90.0, 80.0, 0.0}));
  EXPECT_FALSE(select_target(found, Ellipse{100.0, 100.0, 15.0, 12.0, 0.0}));
  // It accepts no larger ellipse as a member of a smaller one's set either.
  const std::vector<Detection> set = {{{100.0, 100.0, 25.0, 24.0, 0.0}, 1.0, 1.0, 100.0},
                                      {{100.0, 100.0, 19.0, 18.0, 0.0}, 1.0, 1.0, 100.0}};
  EXPECT_EQ(select_target(set, Ellipse{100.0, 100.0, 10.0, 9.0, 0.0})->ellipse.semi_major, 19.0);
}

}  // namespace
}  // namespace ellipse
