// SPDX-License-Identifier: MIT
#include "core/tracking/frame_clock.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace {

using ellipse::FrameClock;
using ellipse::kFrame_s;

constexpr std::int64_t kNone = -1;
constexpr std::int64_t kMs = 1'000'000;
constexpr double kMicrosecond = 1.01e-6;  // the clock's resolution

TEST(FrameClock, CountsSeconds) {
  FrameClock clock;
  EXPECT_NEAR(clock.advance_to(500 * kMs), kFrame_s, kMicrosecond)
      << "the first frame comes after none";
  EXPECT_NEAR(clock.advance_to(600 * kMs), 0.1, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(620 * kMs), 0.02, kMicrosecond);
}

TEST(FrameClock, ExtrapolatesMissingTimestampsAtTheLastInterval) {
  FrameClock clock;
  (void)clock.advance_to(0);
  EXPECT_NEAR(clock.advance_to(100 * kMs), 0.1, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(kNone), 0.1, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(kNone), 0.1, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(400 * kMs), 0.1, kMicrosecond);
}

TEST(FrameClock, AssumesAConstantRateWithoutTimestamps) {
  FrameClock clock;
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(clock.advance_to(kNone), kFrame_s, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(700 * kMs), kFrame_s, kMicrosecond);
}

TEST(FrameClock, LimitsIntervalsAcrossJumps) {
  FrameClock clock;
  (void)clock.advance_to(900 * kMs);
  EXPECT_NEAR(clock.advance_to(100 * kMs), kFrame_s, kMicrosecond) << "back";
  EXPECT_NEAR(clock.advance_to(100 * kMs), kFrame_s, kMicrosecond) << "the same again";
  EXPECT_NEAR(clock.advance_to(60'000 * kMs), 1.0, kMicrosecond) << "a minute";
  EXPECT_NEAR(clock.advance_to(std::numeric_limits<std::int64_t>::max()), 1.0, kMicrosecond);
  EXPECT_NEAR(clock.advance_to(kNone), kFrame_s, kMicrosecond) << "a pause is not repeated";
  EXPECT_NEAR(clock.advance_to(0), kFrame_s, kMicrosecond);
}

// A rate of 30/1 gives intervals of 33,333,333 and 33,333,334 ns.
TEST(FrameClock, MissingTimestampsChangeNothingAtAConstantRate) {
  FrameClock whole;
  FrameClock partial;
  for (std::int64_t i = 0; i < 100; ++i) {
    const std::int64_t pts = i * 1000 * kMs / 30;
    EXPECT_EQ(partial.advance_to(i % 7 == 3 ? kNone : pts), whole.advance_to(pts)) << i;
  }
}

}  // namespace
