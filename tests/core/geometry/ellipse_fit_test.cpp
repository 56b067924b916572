// SPDX-License-Identifier: MIT
#include "core/geometry/ellipse_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace ellipse {
namespace {

std::vector<Eigen::Vector2d> arc(
    const Ellipse& e, double from_rad, double to_rad, int count, double noise_px = 0.0) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, noise_px > 0.0 ? noise_px : 1.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector2d p = e.point_at(from_rad + (to_rad - from_rad) * i / count);
    if (noise_px > 0.0) p += Eigen::Vector2d(noise(random), noise(random));
    points.push_back(p);
  }
  return points;
}

constexpr double kTurn = 2.0 * std::numbers::pi;

TEST(EllipseFit, RecoversTiltedEllipseFromHalfArc) {
  const Ellipse truth{412.3, 201.7, 83.0, 37.0, 0.8};
  const auto fit = fit_ellipse(arc(truth, 0.3, 0.3 + kTurn / 2, 60));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->cx, truth.cx, 1e-4);
  EXPECT_NEAR(fit->cy, truth.cy, 1e-4);
  EXPECT_NEAR(fit->semi_major, truth.semi_major, 1e-4);
  EXPECT_NEAR(fit->semi_minor, truth.semi_minor, 1e-4);
  EXPECT_NEAR(fit->angle_rad, truth.angle_rad, 1e-5);
}

TEST(EllipseFit, IsStableOnCirclesFarFromTheOrigin) {
  for (const double radius : {2.0, 30.0, 2000.0}) {
    const Ellipse truth{6000.25, 3999.5, radius, radius, 0.0};
    const auto fit = fit_ellipse(arc(truth, 0.0, kTurn, 100));
    ASSERT_TRUE(fit) << radius;
    EXPECT_NEAR(fit->cx, truth.cx, 1e-6 * radius);
    EXPECT_NEAR(fit->semi_major, radius, 1e-6 * radius);
    EXPECT_NEAR(fit->semi_minor, radius, 1e-6 * radius);
  }
}

TEST(EllipseFit, FivePointsDetermineIt) {
  const Ellipse truth{10.0, 20.0, 9.0, 5.0, -0.4};
  const auto fit = fit_ellipse(arc(truth, 0.0, kTurn, 5));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->semi_major, 9.0, 1e-3);
  EXPECT_FALSE(fit_ellipse(arc(truth, 0.0, kTurn, 4)));
  EXPECT_FALSE(fit_ellipse(std::vector<Eigen::Vector2d>{}));
}

TEST(EllipseFit, RejectsPointsOnALineOrAtOnePlace) {
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(3.0 * i + 100.0, 2.0 * i - 7.0);
  EXPECT_FALSE(fit_ellipse(line));
  EXPECT_FALSE(fit_ellipse(std::vector<Eigen::Vector2d>(20, {5.0, 5.0})));
  EXPECT_FALSE(fit_ellipse(std::vector<Eigen::Vector2d>(20, {NAN, 5.0})));
}

TEST(EllipseFit, AveragesNoise) {
  const Ellipse truth{100.0, 90.0, 60.0, 40.0, 0.5};
  const auto fit = fit_ellipse(arc(truth, 0.0, kTurn, 400, 0.5));
  ASSERT_TRUE(fit);
  // sigma of a centre from N points all around is about sigma sqrt(2 / N) = 0.035 px.
  EXPECT_NEAR(fit->cx, truth.cx, 0.12);
  EXPECT_NEAR(fit->cy, truth.cy, 0.12);
}

TEST(EllipseFit, MomentsOfAnyOrderGiveTheSame) {
  const Ellipse truth{50.0, 60.0, 20.0, 10.0, 1.0};
  auto points = arc(truth, 0.0, 4.0, 80);
  const auto forward = fit_ellipse(points);
  std::reverse(points.begin(), points.end());
  const auto backward = fit_ellipse(points);
  ASSERT_TRUE(forward && backward);
  EXPECT_NEAR(forward->cx, backward->cx, 1e-6);
  EXPECT_NEAR(forward->semi_minor, backward->semi_minor, 1e-6);
}

TEST(GeometricFit, IsLessBiasedThanDirectLeastSquaresOnShortArcs) {
  const Ellipse truth{100.0, 100.0, 60.0, 60.0, 0.0};
  const auto points = arc(truth, 0.0, kTurn / 3, 300, 0.3);
  const auto direct = fit_ellipse(points);
  ASSERT_TRUE(direct);
  Ellipse e = *direct;
  for (int i = 0; i < 6; ++i) {
    GeometricFit step(e);
    for (const auto& p : points) step.add(p);
    e = step.solve().value_or(e);
  }
  const double bias = std::abs(direct->semi_major - 60.0) + std::abs(direct->semi_minor - 60.0);
  EXPECT_LT(std::abs(e.semi_major - 60.0) + std::abs(e.semi_minor - 60.0), 0.5 * bias);
}

TEST(GeometricFit, KeepsTheExactEllipse) {
  const Ellipse truth{33.0, 44.0, 25.0, 12.0, -0.9};
  GeometricFit step(truth);
  for (const auto& p : arc(truth, 0.0, kTurn, 50)) {
    EXPECT_NEAR(step.offset_of(p).distance_px, 0.0, 1e-9);
    step.add(p);
  }
  const auto fit = step.solve();
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->cx, truth.cx, 1e-9);
  EXPECT_NEAR(fit->semi_major, truth.semi_major, 1e-9);
}

TEST(GeometricFit, FailsForTooFewPoints) {
  GeometricFit step({0.0, 0.0, 10.0, 8.0, 0.0});
  for (int i = 0; i < 4; ++i) step.add({10.0, 1.0 * i});
  EXPECT_FALSE(step.solve());
}

}  // namespace
}  // namespace ellipse
