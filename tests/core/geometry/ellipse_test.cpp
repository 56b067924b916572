// SPDX-License-Identifier: MIT
#include "core/geometry/ellipse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace ellipse {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_same(const Ellipse& a, const Ellipse& b, double tolerance) {
  EXPECT_NEAR(a.cx, b.cx, tolerance);
  EXPECT_NEAR(a.cy, b.cy, tolerance);
  EXPECT_NEAR(a.semi_major, b.semi_major, tolerance);
  EXPECT_NEAR(a.semi_minor, b.semi_minor, tolerance);
  EXPECT_NEAR(std::remainder(a.angle_rad - b.angle_rad, kPi), 0.0, tolerance);
}

TEST(Ellipse, ConvertsToItsConicAndBack) {
  const Ellipse e{320.5, 181.25, 97.0, 31.0, -1.1};
  const auto back = from_conic(-3.0 * conic_matrix(e));
  ASSERT_TRUE(back);
  expect_same(*back, e, 1e-8);
}

TEST(Ellipse, PointsLieOnItsConic) {
  const Ellipse e{12.0, -7.0, 40.0, 15.0, 0.4};
  const Eigen::Matrix3d conic = conic_matrix(e);
  for (int i = 0; i < 16; ++i) {
    const Eigen::Vector3d p = e.point_at(0.4 * i).homogeneous();
    EXPECT_NEAR(p.dot(conic * p), 0.0, 1e-12);
  }
}

TEST(Ellipse, RejectsOtherConics) {
  EXPECT_FALSE(from_conic(Eigen::Vector3d(1, -1, -1).asDiagonal()));  // hyperbola
  EXPECT_FALSE(from_conic(Eigen::Vector3d(1, 1, 1).asDiagonal()));    // no real point
  EXPECT_FALSE(from_conic(Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(from_conic(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Ellipse, AngleIsInHalfOpenInterval) {
  const auto upright = from_shape({0, 0}, Eigen::Vector2d(1.0, 9.0).asDiagonal());
  ASSERT_TRUE(upright);
  EXPECT_DOUBLE_EQ(upright->angle_rad, kPi / 2);
  EXPECT_DOUBLE_EQ(upright->semi_major, 3.0);
}

TEST(Ellipse, ScalingKeepsTheAreaThatPixelsCover) {
  // The centre of a 2 x 2 block of pixels is the centre of the one pixel it becomes.
  const Ellipse half = scaled({0.5, 2.5, 10.0, 6.0, 0.3}, 0.5);
  expect_same(half, {0.0, 1.0, 5.0, 3.0, 0.3}, 1e-12);
  expect_same(scaled(half, 2.0), {0.5, 2.5, 10.0, 6.0, 0.3}, 1e-12);
}

TEST(Ellipse, NonUniformScaleRotatesIt) {
  const Ellipse e{100.0, 50.0, 40.0, 20.0, 0.7};
  const Eigen::Matrix2d stretch = Eigen::Vector2d(2.0, 0.5).asDiagonal();
  const auto moved = transformed(e, stretch, {1.0, -2.0});
  ASSERT_TRUE(moved);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d p = stretch * e.point_at(0.5 * i) + Eigen::Vector2d(1.0, -2.0);
    EXPECT_NEAR(sampson_distance(*moved, p), 0.0, 1e-9);
  }
  EXPECT_FALSE(transformed(e, Eigen::Matrix2d::Zero(), {0, 0}));
}

TEST(Ellipse, DistanceToCircleIsExact) {
  const Ellipse circle{3.0, 4.0, 10.0, 10.0, 0.0};
  EXPECT_NEAR(sampson_distance(circle, {15.0, 4.0}), 2.0, 1e-12);
  EXPECT_NEAR(sampson_distance(circle, {3.0, -5.0}), -1.0, 1e-12);
  EXPECT_NEAR(sampson_distance(circle, circle.center()), -10.0, 1e-12);
}

TEST(Ellipse, PerimeterWalkHasTheLengthOfThePerimeter) {
  for (const double minor : {100.0, 60.0, 20.0}) {
    const Ellipse e{0.0, 0.0, 100.0, minor, 0.9};
    double length = 0.0;
    walk_perimeter(e, [&](const PerimeterStep& step) {
      length += step.length_px;
      EXPECT_LE(step.length_px, 1.0 + 1e-9);
      EXPECT_GT(step.normal().dot(step.point - e.center()), 0.0);
    });
    EXPECT_NEAR(length / perimeter_px(e), 1.0, 1e-4);
  }
}

TEST(Ellipse, OverlapOfConcentricCirclesIsRatioOfAreas) {
  const Ellipse large{160.0, 120.0, 50.0, 50.0, 0.0};
  const Ellipse small{160.0, 120.0, 40.0, 40.0, 0.0};
  EXPECT_NEAR(iou_inside(large, small, 320, 240), 0.64, 1e-3);
  EXPECT_NEAR(iou_inside(large, large, 320, 240), 1.0, 1e-12);
}

TEST(Ellipse, OverlapCountsInsideTheFrameOnly) {
  const Ellipse a{-0.5, 50.0, 20.0, 20.0, 0.0};
  const Ellipse far_left{-100.0, 50.0, 20.0, 20.0, 0.0};
  const Ellipse half{-0.5, 50.0, 20.0, 20.0 / 2, 0.0};
  EXPECT_NEAR(iou_inside(a, half, 100, 100), 0.5, 1e-3);
  EXPECT_EQ(iou_inside(a, far_left, 100, 100), 0.0);
  EXPECT_EQ(iou_inside(far_left, far_left, 100, 100), 0.0);
}

TEST(Ellipse, VisibleFractionIsHalfAtTheBorder) {
  EXPECT_NEAR(visible_fraction({-0.5, 50.0, 30.0, 20.0, 0.0}, 200, 100), 0.5, 0.01);
  EXPECT_NEAR(visible_fraction({100.0, 50.0, 30.0, 20.0, 0.5}, 200, 100), 1.0, 1e-12);
  EXPECT_EQ(visible_fraction({100.0, 500.0, 30.0, 20.0, 0.5}, 200, 100), 0.0);
}

TEST(Ellipse, HalfExtentIsTight) {
  const Ellipse e{10.0, 20.0, 30.0, 10.0, 0.6};
  double right = 0.0;
  for (int i = 0; i < 3600; ++i) right = std::max(right, e.point_at(i * kPi / 1800).x());
  EXPECT_NEAR(half_extent(e).x(), right - e.cx, 1e-4);
}

}  // namespace
}  // namespace ellipse
