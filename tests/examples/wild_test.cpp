// SPDX-License-Identifier: MIT
//
// Random scenes as a data set.
#include "examples/evaluate/wild.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "core/scene/true_ellipses.hpp"
#include "core/scene/wild.hpp"

namespace evaluate {
namespace {

TEST(WildDataset, KeepsSizeAndRateOfEachSeed) {
  const auto sequences = wild_by_name("wild:9-11", 1.0);
  ASSERT_TRUE(sequences);
  ASSERT_EQ(sequences->size(), 3U);
  for (std::size_t i = 0; i < sequences->size(); ++i) {
    const Sequence& sequence = (*sequences)[i];
    const ellipse::Wild wild = ellipse::make_wild(9 + i);
    EXPECT_EQ(sequence.dataset, "wild");
    ASSERT_EQ(sequence.frames.size(), std::round(wild.frames_per_second)) << sequence.name;
    EXPECT_NEAR(sequence.frames[1].pts_ns, 1e9 / wild.frames_per_second, 1.0);
    const cv::Mat picture = sequence.pictures->picture(sequence.frames[1]);
    EXPECT_EQ(picture.cols, wild.width);
    EXPECT_EQ(picture.rows, wild.height);
    EXPECT_EQ(cv::norm(picture, sequence.pictures->picture(sequence.frames[1]), cv::NORM_INF), 0.0);
  }
}

TEST(WildDataset, FramesHaveAllTrueEllipses) {
  const auto sequences = wild_by_name("wild-frames:40,8", 1.0);
  ASSERT_TRUE(sequences);
  ASSERT_EQ(sequences->size(), 2U);
  ASSERT_EQ(sequences->front().frames.size(), 1U);
  EXPECT_EQ(sequences->front().name, "board-40");
  const ellipse::Wild board = ellipse::make_wild(40);
  const auto shown = true_ellipses(board.scene, 0.0, board.width, board.height);
  const auto truths = ellipses_of(sequences->front().frames[0].truth);
  ASSERT_EQ(truths.size(), shown.size());
  ASSERT_GT(truths.size(), 20U);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    EXPECT_EQ(truths[i].ellipse, shown[i].ellipse);
    EXPECT_EQ(truths[i].visible_fraction, shown[i].visible_fraction);
  }
  EXPECT_TRUE(ellipses_of(sequences->back().frames[0].truth).empty());
}

TEST(WildDataset, IgnoresOtherNamesAndRejectsMalformedOnes) {
  EXPECT_FALSE(wild_by_name("scenes:1", 1.0));
  EXPECT_FALSE(wild_by_name("wilderness", 1.0));
  for (const char* bad : {"wild:", "wild:x", "wild:5-3", "wild-frames:1-200000"}) {
    EXPECT_THROW((void)wild_by_name(bad, 1.0), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace evaluate
