// SPDX-License-Identifier: MIT
#include "core/tracking/frame_clock.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace {

using ellipse::FrameClock;

constexpr std::int64_t kNone = -1;
constexpr std::int64_t kMs = 1'000'000;

TEST(FrameClock, CountsInThirtiethsOfASecond) {
  FrameClock clock;
  EXPECT_EQ(clock.advance_to(500 * kMs), 1.0) << "the first frame comes after none";
  EXPECT_DOUBLE_EQ(clock.advance_to(600 * kMs), 3.0);
  EXPECT_DOUBLE_EQ(clock.advance_to(620 * kMs), 0.6);
}

TEST(FrameClock, TakesAFrameWithoutATimeStampForTheNextOfAnEvenStream) {
  FrameClock clock;
  (void)clock.advance_to(0);
  EXPECT_DOUBLE_EQ(clock.advance_to(100 * kMs), 3.0);
  EXPECT_DOUBLE_EQ(clock.advance_to(kNone), 3.0);
  EXPECT_DOUBLE_EQ(clock.advance_to(kNone), 3.0);
  EXPECT_DOUBLE_EQ(clock.advance_to(400 * kMs), 3.0);
}

TEST(FrameClock, TakesAStreamWithoutTimeStampsForAnEvenOne) {
  FrameClock clock;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(clock.advance_to(kNone), 1.0);
  EXPECT_EQ(clock.advance_to(700 * kMs), 1.0);
}

TEST(FrameClock, KnowsNothingAcrossJumps) {
  FrameClock clock;
  (void)clock.advance_to(900 * kMs);
  EXPECT_EQ(clock.advance_to(100 * kMs), 1.0) << "back";
  EXPECT_EQ(clock.advance_to(100 * kMs), 1.0) << "the same again";
  EXPECT_EQ(clock.advance_to(60'000 * kMs), 30.0) << "a minute";
  EXPECT_EQ(clock.advance_to(std::numeric_limits<std::int64_t>::max()), 30.0);
  EXPECT_EQ(clock.advance_to(kNone), 30.0);
  EXPECT_EQ(clock.advance_to(0), 1.0);
}

}  // namespace
