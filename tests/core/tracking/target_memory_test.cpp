// SPDX-License-Identifier: MIT
#include "core/tracking/target_memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace ellipse {
namespace {

constexpr double kShortly_s = 0.9 * kMemory_s;
constexpr double kLonger_s = 1.1 * kMemory_s;
constexpr Ellipse kTarget{100.0, 80.0, 30.0, 20.0, 0.2};

Target target_with(double probability, std::uint64_t id = 7) {
  Target target;
  target.ellipse = kTarget;
  target.probability = probability;
  target.id = id;
  return target;
}

Ellipse moved_target(double by_px) {
  Ellipse e = kTarget;
  e.cx += by_px;
  return e;
}

TEST(TargetMemory, HasNoTargetAtFirst) {
  const TargetMemory memory;
  EXPECT_EQ(memory.id(), 0U);
  EXPECT_FALSE(memory.was_certain());
  EXPECT_GE(memory.absence_s(), kMemory_s);
  constexpr Ellipse kAtOrigin{0.0, 0.0, 30.0, 20.0, 0.2};
  EXPECT_FALSE(memory.was_near(kAtOrigin));
  EXPECT_LT(memory.prior_of(kAtOrigin), 0.0);
}

TEST(TargetMemory, KnowsTheLastTarget) {
  TargetMemory memory;
  memory.remember(target_with(0.6, 3));
  EXPECT_EQ(memory.id(), 3U);
  EXPECT_EQ(memory.ellipse().cx, kTarget.cx);
  EXPECT_EQ(memory.absence_s(), 0.0);
}

TEST(TargetMemory, APlaceCountsForAShortTime) {
  TargetMemory memory;
  memory.remember(target_with(0.6));
  memory.advance(kShortly_s);
  EXPECT_TRUE(memory.was_near(moved_target(29.0)));
  EXPECT_FALSE(memory.was_near(moved_target(31.0)));
  memory.advance(kLonger_s - kShortly_s);
  EXPECT_FALSE(memory.was_near(kTarget));
}

TEST(TargetMemory, ACertainTargetIsLikelyToBeFoundAgain) {
  TargetMemory certain;
  TargetMemory uncertain;
  certain.remember(target_with(0.99));
  uncertain.remember(target_with(0.9));
  for (TargetMemory* memory : {&certain, &uncertain}) memory->advance(kShortly_s);
  EXPECT_EQ(certain.prior_of(kTarget), TargetMemory::kLostPrior);
  EXPECT_EQ(uncertain.prior_of(kTarget), 0.0);
  EXPECT_LT(uncertain.prior_of(moved_target(40.0)), 0.0);
}

TEST(TargetMemory, AnEllipseOfAnotherSizeIsNotTheCertainTarget) {
  TargetMemory memory;
  memory.remember(target_with(0.99));
  EXPECT_TRUE(memory.was_certain_as(moved_target(14.0)));
  EXPECT_FALSE(memory.was_certain_as({kTarget.cx, kTarget.cy, 60.0, 40.0, kTarget.angle_rad}));
  EXPECT_FALSE(memory.was_certain_as({kTarget.cx, kTarget.cy, 12.0, 8.0, kTarget.angle_rad}));
}

TEST(TargetMemory, CertaintyIsForgottenThoughTheTargetIsStillReported) {
  TargetMemory memory;
  memory.remember(target_with(0.99));
  memory.advance(kShortly_s);
  memory.remember(target_with(0.9));
  EXPECT_TRUE(memory.was_certain());
  memory.advance(kLonger_s - kShortly_s);
  EXPECT_FALSE(memory.was_certain());
  EXPECT_TRUE(memory.was_near(kTarget));
}

TEST(TargetMemory, ForgetsWhenButNotWhatItSaw) {
  TargetMemory memory;
  memory.remember(target_with(0.99));
  memory.forget();
  EXPECT_EQ(memory.id(), 7U);
  EXPECT_EQ(memory.ellipse().cx, kTarget.cx);
  EXPECT_FALSE(memory.was_certain());
  EXPECT_FALSE(memory.was_near(kTarget));
}

}  // namespace
}  // namespace ellipse
