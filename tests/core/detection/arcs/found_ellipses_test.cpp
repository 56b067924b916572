// SPDX-License-Identifier: MIT
#include "core/detection/arcs/found_ellipses.hpp"

#include <gtest/gtest.h>

#include "core/detection/detection_trace.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

constexpr double kCertain = 0.99;
constexpr double kUncertain = 0.7;

FoundEllipse found_at(int scale,
                      double probability,
                      double cx = 100.0,
                      Polarity polarity = Polarity::kDarkInside) {
  FoundEllipse found;
  found.measured.ellipse = {cx, 80.0, 40.0, 30.0, 0.3};
  found.measured.polarity = polarity;
  found.measured.probability = probability;
  found.scale = scale;
  return found;
}

TEST(FoundEllipses, KeepTheMoreProbableDuplicateOfOneScale) {
  for (const bool better_first : {false, true}) {
    FoundEllipses ellipses;
    ellipses.begin(nullptr);
    ellipses.add(found_at(1, better_first ? 0.8 : 0.7, 100.0));
    ellipses.add(found_at(1, better_first ? 0.7 : 0.8, 102.0));
    ASSERT_EQ(ellipses.size(), 1U);
    EXPECT_EQ(ellipses.all().front().measured.probability, 0.8);
  }
}

// The tolerance is a pixel and .05 of the semi-major axis: 3 px.
TEST(FoundEllipses, KeepDifferentEllipses) {
  FoundEllipses ellipses;
  ellipses.begin(nullptr);
  ellipses.add(found_at(1, kCertain, 100.0));
  ellipses.add(found_at(1, kCertain, 103.5));
  ellipses.add(found_at(1, kCertain, 100.0, Polarity::kBrightInside));
  EXPECT_EQ(ellipses.size(), 3U);
  ellipses.merge_duplicates();
  EXPECT_EQ(ellipses.size(), 3U);
}

TEST(FoundEllipses, OfBothPolaritiesAreDuplicatesOfEither) {
  FoundEllipses ellipses;
  ellipses.begin(nullptr);
  ellipses.add(found_at(1, kUncertain, 100.0, Polarity::kBrightInside));
  ellipses.add(found_at(1, kCertain, 100.0, Polarity::kMixed));
  ASSERT_EQ(ellipses.size(), 1U);
  EXPECT_EQ(ellipses.all().front().measured.polarity, Polarity::kMixed);
}

TEST(FoundEllipses, CompareUncertainDuplicatesOfTwoScalesOnlyAtTheEnd) {
  FoundEllipses ellipses;
  ellipses.begin(nullptr);
  ellipses.add(found_at(4, 0.6));
  ellipses.add(found_at(1, 0.7));
  EXPECT_EQ(ellipses.size(), 2U);
  ellipses.merge_duplicates();
  ASSERT_EQ(ellipses.size(), 1U);
  EXPECT_EQ(ellipses.all().front().scale, 1);

  ellipses.begin(nullptr);
  ellipses.add(found_at(4, 0.6));
  ellipses.add(found_at(1, kCertain));
  EXPECT_EQ(ellipses.size(), 1U);
}

TEST(FoundEllipses, OnlyACertainOneOfTheScaleExcludesAGuess) {
  FoundEllipses ellipses;
  ellipses.begin(nullptr);
  ellipses.add(found_at(2, kUncertain));
  const Ellipse guess = found_at(2, 0.0).measured.ellipse;
  EXPECT_FALSE(ellipses.has_certain(guess, Polarity::kDarkInside, 2));
  ellipses.add(found_at(2, kCertain));
  EXPECT_TRUE(ellipses.has_certain(guess, Polarity::kDarkInside, 2));
  EXPECT_TRUE(ellipses.has_certain(guess, Polarity::kMixed, 2));
  EXPECT_FALSE(ellipses.has_certain(guess, Polarity::kBrightInside, 2));
  EXPECT_FALSE(ellipses.has_certain(guess, Polarity::kDarkInside, 1));
  EXPECT_FALSE(ellipses.has_certain(translated(guess, 10.0, 0.0), Polarity::kDarkInside, 2));
}

TEST(FoundEllipses, ReportVerdictsToTheTrace) {
  const support::GrayPicture picture(8, 8);
  DetectionTrace trace;
  trace.begin_pass(picture.view(), 1);
  FoundEllipses ellipses;
  ellipses.begin(&trace);
  FoundEllipse weaker = found_at(1, kUncertain);
  FoundEllipse better = found_at(1, kCertain);
  FoundEllipse other = found_at(1, kUncertain, 200.0);
  for (FoundEllipse* found : {&weaker, &better, &other}) {
    found->measured.candidate = trace.add({}, found->measured.ellipse, {});
    ellipses.add(*found);
  }
  ellipses.drop_rejected([](const FoundEllipse& found) {
    return at_least(Reason::kUnlikely, found.measured.probability, 0.9);
  });
  ASSERT_EQ(ellipses.size(), 1U);
  const auto reason_of = [&](const FoundEllipse& found) {
    return trace.candidates()[static_cast<std::size_t>(found.measured.candidate)].verdict.reason;
  };
  EXPECT_EQ(reason_of(weaker), Reason::kKnown);
  EXPECT_EQ(reason_of(better), Reason::kAccepted);
  EXPECT_EQ(reason_of(other), Reason::kUnlikely);
}

}  // namespace
}  // namespace ellipse
