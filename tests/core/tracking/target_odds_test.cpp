// SPDX-License-Identifier: MIT
#include "core/tracking/target_odds.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

namespace ellipse {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(TargetOdds, StartWithTheirPrior) {
  for (const double prior : {-0.4, 0.0, 2.0}) {
    TargetOdds odds;
    odds.start(1.0, prior);
    EXPECT_EQ(odds.value(), 1.0 + prior);
    EXPECT_EQ(odds.last(), 1.0);
  }
}

// Reference: the log likelihood ratio of all samples under multivariate normal distributions with
// the process's covariance. With means of +-m and a variance of 2 m, a sample equals its own log
// likelihood ratio.
TEST(TargetOdds, EqualTheLogLikelihoodRatioOfCorrelatedSamples) {
  constexpr double kMean = 1.0;
  const std::array<double, 5> samples = {1.2, 0.4, -0.8, 0.9, 1.7};
  const std::array<double, 5> times_s = {0.0, 0.05, 0.08, 0.4, 0.45};
  TargetOdds odds;
  odds.start(samples[0], 0.0);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    odds.add(samples[i], times_s[i] - times_s[i - 1]);
  }
  Eigen::Matrix<double, 5, 5> covariance;
  for (Eigen::Index i = 0; i < 5; ++i) {
    for (Eigen::Index k = 0; k < 5; ++k) {
      const double apart = times_s[std::size_t(i)] - times_s[std::size_t(k)];
      covariance(i, k) = 2.0 * kMean * std::exp(-std::abs(apart) / TargetOdds::kCorrelation_s);
    }
  }
  const auto x = Eigen::Map<const Eigen::Matrix<double, 5, 1>>(samples.data());
  const Eigen::Matrix<double, 5, 1> mean = Eigen::Matrix<double, 5, 1>::Constant(kMean);
  EXPECT_NEAR(odds.value(), 2.0 * mean.dot(covariance.ldlt().solve(x)), 1e-9);
}

TEST(TargetOdds, GrowEquallyAtAnyFrameRate) {
  const auto after_a_second = [](int frames) {
    TargetOdds odds;
    odds.start(1.0, -0.4);
    for (int i = 0; i < frames; ++i) odds.add(1.0, 1.0 / frames);
    return odds.value();
  };
  EXPECT_NEAR(after_a_second(10), after_a_second(60), 0.03);
  EXPECT_GT(after_a_second(30), 1.0);
}

TEST(TargetOdds, AreAtLeastThoseOfANewHypothesis) {
  for (const double prior : {-0.4, 0.0, 2.0}) {
    TargetOdds fresh;
    fresh.start(0.5, prior);
    TargetOdds odds;
    odds.start(-2.0, 0.0);
    odds.add(0.5, 1.0 / 30.0);
    ASSERT_LT(odds.value(), fresh.value());
    odds.raise(0.5, prior);
    EXPECT_EQ(odds.value(), fresh.value());
    odds.raise(0.1, prior);
    EXPECT_EQ(odds.value(), fresh.value());
  }
  TargetOdds certain;
  certain.start(0.0, 0.0);
  certain.raise(kInfinity, 0.0);
  EXPECT_EQ(certain.value(), TargetOdds::kMax);
}

TEST(TargetOdds, FallToZeroAfterOneContraryFrame) {
  TargetOdds odds;
  odds.start(kInfinity, -0.4);
  for (int i = 0; i < 300; ++i) odds.add(kInfinity, 1.0 / 30.0);
  EXPECT_EQ(odds.value(), TargetOdds::kMax);
  odds.add(-kInfinity, 1.0 / 30.0);
  EXPECT_NEAR(odds.value(), 0.0, 1e-9);
  odds.add(-kInfinity, 1.0 / 30.0);
  EXPECT_LT(odds.value(), 0.0);
  for (int i = 0; i < 30; ++i) odds.add(-kInfinity, 1.0 / 30.0);
  EXPECT_EQ(odds.value(), -TargetOdds::kMax);
}

}  // namespace
}  // namespace ellipse
