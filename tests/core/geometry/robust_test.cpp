// SPDX-License-Identifier: MIT
#include "core/geometry/robust.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/geometry/least_squares.hpp"
#include "tests/support/chi_square.hpp"

namespace ellipse {
namespace {

constexpr std::size_t kSamples = 48;
constexpr double kReachOfSigma = 3.0;

TEST(Median, IsTheUpperOneInTheMiddle) {
  std::vector<int> odd{5, 1, 3};
  EXPECT_EQ(median(std::span(odd)), 3);
  std::vector<float> even{4.0F, 1.0F, 3.0F, 2.0F};
  EXPECT_EQ(median(std::span(even)), 3.0F);
  std::vector<double> one{-2.0};
  EXPECT_EQ(median(std::span(one)), -2.0);
}

TEST(RobustSigma, OfNormalErrorsWithOutliers) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.5);
  std::vector<WeightedDistance> errors(4000);
  for (WeightedDistance& error : errors) error.distance = normal(random);
  std::vector<WeightedDistance> copy = errors;
  EXPECT_NEAR(robust_sigma(copy), 0.5, 0.02);
  for (std::size_t i = 0; i < errors.size(); i += 10) errors[i].distance = 50.0;
  copy = errors;
  EXPECT_NEAR(robust_sigma(copy), 0.5, 0.1);
  for (std::size_t i = 0; i < errors.size(); ++i) {  // most, but of little weight
    if (i % 3 != 0) errors[i] = {50.0, 0.01};
  }
  EXPECT_NEAR(robust_sigma(errors), 0.5, 0.1);
}

// The residuals of one outline: an autoregressive process of first order, and outliers.
struct ErrorModel {
  double rho = 0.0;
  double sigma = 1.0;
  double outliers = 0.0;  // share
};

using Vector = LeastSquares<5>::Vector;

Vector row_at(std::size_t i) {
  const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / kSamples;
  return Vector{1.0, std::cos(t), std::sin(t), std::cos(2.0 * t), std::sin(2.0 * t)};
}

std::array<double, kSamples> errors_of(const ErrorModel& model, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::array<double, kSamples> errors;
  double state = normal(random);
  for (double& error : errors) {
    error = model.sigma * state;
    if (uniform(random) < model.outliers) error += 30.0 * model.sigma;
    state = model.rho * state + std::sqrt(1.0 - model.rho * model.rho) * normal(random);
  }
  return errors;
}

// Normalised squared error of five parameters whose true values are 0.
double squared_error(const std::array<double, kSamples>& values, double min_sigma) {
  Vector solution = Vector::Zero();
  double factor = 0.0;
  LeastSquares<5>::Matrix information;
  for (int step = 0; step < 10; ++step) {
    std::array<double, kSamples> distances;
    for (std::size_t i = 0; i < kSamples; ++i) distances[i] = values[i] - row_at(i).dot(solution);
    std::array<WeightedDistance, kSamples> copy;
    for (std::size_t i = 0; i < kSamples; ++i) copy[i] = {distances[i], 1.0};
    const double reach = kReachOfSigma * std::max(min_sigma, robust_sigma(copy));
    LeastSquares<5> equations;
    ResidualSums residuals;
    for (std::size_t i = 0; i < kSamples; ++i) {
      equations.add(row_at(i), values[i], tukey_weight(distances[i], reach));
      residuals.add(static_cast<int>(i), distances[i], reach, 1.0);
    }
    solution = equations.solve().value();
    information = equations.information();
    factor = residuals.information_factor(5, min_sigma);
  }
  return factor * solution.dot(information * solution);
}

struct Coverage {
  double mean = 0.0;
  double inside = 0.0;  // share of the 95 % region
};

Coverage coverage_of(const ErrorModel& model) {
  constexpr int kTrials = 1500;
  std::mt19937 random(7);
  Coverage result;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double error = squared_error(errors_of(model, random), 1e-6);
    result.mean += std::min(error, 100.0) / kTrials;
    result.inside += (error <= support::kChiSquare5 ? 1.0 : 0.0) / kTrials;
  }
  return result;
}

TEST(ResidualSums, GiveTheCovarianceOfIndependentErrors) {
  for (const double sigma : {0.01, 1.0}) {
    const Coverage coverage = coverage_of({.sigma = sigma});
    EXPECT_NEAR(coverage.mean, 5.0, 1.0) << sigma;
    EXPECT_NEAR(coverage.inside, 0.95, 0.03) << sigma;
  }
}

TEST(ResidualSums, GiveThatOfErrorsWithOutliers) {
  const Coverage coverage = coverage_of({.outliers = 0.1});
  EXPECT_NEAR(coverage.mean, 5.0, 1.0);
  EXPECT_NEAR(coverage.inside, 0.95, 0.03);
}

// A region for independent errors would contain 64 and 22 %.
TEST(ResidualSums, WidenThatOfCorrelatedErrors) {
  EXPECT_GT(coverage_of({.rho = 0.3}).inside, 0.84);
  EXPECT_GT(coverage_of({.rho = 0.6}).inside, 0.75);
}

TEST(ResidualSums, HaveAMinimumOfTheSigma) {
  ResidualSums exact;
  ResidualSums noisy;
  for (int i = 0; i < 48; ++i) {
    exact.add(i, 0.0, 1.0, 2.0);
    noisy.add(i, i % 2 == 0 ? 0.1 : -0.1, 1.0, 2.0);
  }
  // Precisions of 2 and a variance of .01: an information of 1 / .02 per unit.
  EXPECT_NEAR(exact.information_factor(5, 0.1), (48.0 - 7.0) / 48.0 / 0.02, 3.0);
  EXPECT_NEAR(noisy.information_factor(5, 0.0), (48.0 - 7.0) / 48.0 / 0.02, 3.0);
  EXPECT_EQ(ResidualSums().information_factor(5, 0.1), 0.0);
}

TEST(ResidualSums, GiveManySamplesThePrecisionOfTheirScatter) {
  ResidualSums close;
  ResidualSums uniform;
  for (int i = 0; i < 48; ++i) {
    const double share = (i + 0.5) / 24.0 - 1.0;
    close.add(i, 0.1 * share, 1.0, 1.0);
    uniform.add(i, share, 1.0, 1.0);
  }
  EXPECT_NEAR(close.independent_precision(1e-6), 300.0, 10.0);  // 1 / (.1^2 / 3)
  EXPECT_NEAR(close.independent_precision(1.0), 1.0, 0.05);
  EXPECT_NEAR(uniform.independent_precision(1e-6), 0.0, 1e-3);
  EXPECT_EQ(ResidualSums().independent_precision(0.1), 0.0);
}

}  // namespace
}  // namespace ellipse
