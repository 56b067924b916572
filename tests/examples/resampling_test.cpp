// SPDX-License-Identifier: MIT
//
// Intervals of measures, and significant differences.
#include "examples/evaluate/resampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/scene/random.hpp"

namespace evaluate {
namespace {

constexpr FrameCounts kOneRight{1, 1, 0, 0};
constexpr FrameCounts kMissed{1, 0, 0, 1};

const SourceFrames kVideo{{600}, 30.0};

// Misses every n-th frame.
std::vector<FrameCounts> missing_each(std::size_t nth, std::size_t frames = 600) {
  std::vector<FrameCounts> counts(frames, kOneRight);
  for (std::size_t i = 0; i < frames; i += nth) counts[i] = kMissed;
  return counts;
}

// Misses the first frames of a video.
std::vector<FrameCounts> missing_first(std::size_t missed, std::size_t frames = 600) {
  std::vector<FrameCounts> counts(frames, kOneRight);
  std::fill_n(counts.begin(), missed, kMissed);
  return counts;
}

TEST(Resampling, GradesByF1OrByTheShareWithoutFalseTargets) {
  EXPECT_DOUBLE_EQ(f1_of({10, 6, 2, 1}), 12.0 / 15.0);
  EXPECT_TRUE(std::isnan(f1_of({10, 0, 2, 0})));
  EXPECT_DOUBLE_EQ(grade_of({10, 0, 2, 0}), 0.8);
}

TEST(Resampling, ResamplesSequencesIfThereAreEnough) {
  const SourceFrames five{{10, 10, 10, 10, 10}, 30.0};
  EXPECT_TRUE(scheme_for(five, missing_each(3, 50)).draws_sequences);
  EXPECT_FALSE(scheme_for(kVideo, missing_each(3)).draws_sequences);
}

TEST(Resampling, BlocksAreAsLongAsRunsOfErrors) {
  EXPECT_EQ(scheme_for(kVideo, missing_each(7)).block_frames, 30U);      // a second
  EXPECT_GT(scheme_for(kVideo, missing_first(150)).block_frames, 60U);   // a run of errors
  EXPECT_EQ(scheme_for(kVideo, missing_first(300)).block_frames, 120U);  // a fifth at most
  EXPECT_EQ(scheme_for({{20}, 30.0}, missing_each(3, 20)).block_frames, 4U);
}

TEST(Resampling, IntervalsAreWiderForClusteredErrors) {
  const auto spread = missing_each(11);  // 55 misses
  const auto together = missing_first(55);
  const Interval narrow = grade_interval(kVideo, scheme_for(kVideo, spread), spread);
  const Interval wide = grade_interval(kVideo, scheme_for(kVideo, together), together);
  const double f1 = f1_of(total(spread));
  for (const Interval& interval : {narrow, wide}) {
    EXPECT_LT(interval.low, f1);
    EXPECT_GT(interval.high, f1);
  }
  EXPECT_GT(wide.high - wide.low, 5.0 * (narrow.high - narrow.low));
}

TEST(Resampling, ThereIsNoIntervalWithoutErrors) {
  const std::vector<FrameCounts> perfect(600, kOneRight);
  EXPECT_TRUE(std::isnan(grade_interval(kVideo, scheme_for(kVideo, perfect), perfect).low));
}

TEST(Resampling, IntervalsContainTheTruthInNinetyFivePercent) {
  // Sequences with different miss rates, whose frames are not independent draws.
  ellipse::Random random(3);
  constexpr int kSources = 200;
  int held = 0;
  for (int k = 0; k < kSources; ++k) {
    SourceFrames source{{}, 30.0};
    std::vector<FrameCounts> counts;
    for (int s = 0; s < 30; ++s) {
      const double share = 0.4 * random.unit();
      source.sequence_lengths.push_back(20);
      for (int i = 0; i < 20; ++i) counts.push_back(random.unit() < share ? kMissed : kOneRight);
    }
    const double truth = 2.0 * 0.8 / (2.0 * 0.8 + 0.2);
    const Interval interval = grade_interval(source, scheme_for(source, counts), counts);
    held += interval.low <= truth && truth <= interval.high ? 1 : 0;
  }
  EXPECT_GE(held, 0.90 * kSources);
  EXPECT_LE(held, 0.99 * kSources);
}

TEST(Resampling, FindsLastingDifferencesOnly) {
  const std::vector<FrameCounts> perfect(600, kOneRight);
  const auto claims = [&](const std::vector<FrameCounts>& other) {
    const Scheme scheme = scheme_for(kVideo, other);
    return is_difference(difference_interval(kVideo, scheme, perfect, other));
  };
  EXPECT_FALSE(claims(perfect));
  EXPECT_FALSE(claims(missing_first(20)));
  EXPECT_TRUE(claims(missing_each(20)));
}

TEST(Resampling, ComparesPairedByFrame) {
  // Both fail in the hard half, one in a few more frames. Unpaired, the intervals overlap.
  auto a = missing_first(300);
  auto b = a;
  for (std::size_t i = 300; i < 600; i += 15) b[i] = kMissed;
  const Scheme scheme = longer(scheme_for(kVideo, a), scheme_for(kVideo, b));
  const Interval of_a = grade_interval(kVideo, scheme, a);
  const Interval of_b = grade_interval(kVideo, scheme, b);
  EXPECT_GT(of_b.high, of_a.low);
  EXPECT_TRUE(is_difference(difference_interval(kVideo, scheme, a, b)));
}

}  // namespace
}  // namespace evaluate
