// SPDX-License-Identifier: MIT
#include "core/camera/lens_view.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/camera/lens_model.hpp"
#include "core/tracking/pad/edge_search.hpp"
#include "core/tracking/pad/pad_view.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

Camera barrel() {
  Camera camera = Camera::with_hfov(1.012, 640, 360);
  camera.fy = 1.01 * camera.fx;
  camera.distortion = {-0.22, 0.03, 0.001, -0.0007};
  return camera;
}

class EachLensView : public testing::TestWithParam<Camera> {
 protected:
  const Lens lens_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(LensView, EachLensView, testing::Values(barrel(), support::fisheye()));

TEST_P(EachLensView, TableApproximatesTheInverse) {
  const LensView view(lens_);
  for (double y = 0.0; y < 360.0; y += 8.3) {
    for (double x = 0.0; x < 640.0; x += 9.7) {
      const Vector2d pixel(x, y);
      const auto back = lens_.picture_from_ideal(view.approximate_ideal(pixel));
      ASSERT_TRUE(back);
      EXPECT_LT((back->picture_px - pixel).norm(), 0.01) << pixel.transpose();
    }
  }
  EXPECT_FALSE(view.approximate_ideal({9000.0, 0.0}).allFinite());
}

// Pixels and ideal pixels of a part of a reduced copy correspond to those of the frame.
TEST_P(EachLensView, PartsAndReducedCopiesMatchTheFrame) {
  const LensView frame(lens_);
  const LensView part = frame.part({40.0, 24.0}).reduced(4);
  const auto in_frame = [](const Vector2d& p) -> Vector2d {
    return 4.0 * p + Vector2d(41.5, 25.5);
  };
  for (const Vector2d& ideal : {Vector2d(3.0, 5.0), Vector2d(120.0, 60.0)}) {
    const auto here = part.picture_from_ideal(ideal);
    const auto there = frame.picture_from_ideal(in_frame(ideal));
    ASSERT_TRUE(here && there);
    EXPECT_LT((in_frame(here->picture_px) - there->picture_px).norm(), 1e-9);
    EXPECT_LT((here->slope - there->slope).norm(), 1e-12);
    EXPECT_LT((*part.ideal_from_picture(here->picture_px) - ideal).norm(), 1e-6);
  }
}

TEST_P(EachLensView, DistortsManyPointsLikeSinglePoints) {
  const LensView view = LensView(lens_).part({100.0, 50.0});
  const Vector2d origin(120.0, 90.0);
  constexpr std::size_t kCount = 90;
  std::array<float, kCount> x, y, nx, ny, across, along;
  std::array<Vector2d, kCount> ideal;
  std::array<Vector2d, kCount> normal;
  for (std::size_t k = 0; k < kCount; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / kCount;
    normal[k] = {std::cos(angle), std::sin(angle)};
    ideal[k] = 3.0 * static_cast<double>(k) * normal[k];
    x[k] = static_cast<float>(ideal[k].x());
    y[k] = static_cast<float>(ideal[k].y());
    nx[k] = static_cast<float>(normal[k].x());
    ny[k] = static_cast<float>(normal[k].y());
  }
  view.distort(origin,
               {kCount, x.data(), y.data(), nx.data(), ny.data(), across.data(), along.data()});
  for (std::size_t k = 0; k < kCount; ++k) {
    const auto expected = view.picture_from_ideal(origin + ideal[k]);
    ASSERT_TRUE(expected);
    EXPECT_LT((origin + Vector2d(x[k], y[k]) - expected->picture_px).norm(), 5e-4);
    // The tangent stays a tangent; a step across the curve scales by `across`.
    const Vector2d tangent = expected->slope * Vector2d(-normal[k].y(), normal[k].x());
    const Vector2d distorted_normal(nx[k], ny[k]);
    EXPECT_NEAR(distorted_normal.norm(), 1.0, 1e-5);
    EXPECT_NEAR(distorted_normal.dot(tangent.normalized()), 0.0, 1e-4);
    EXPECT_NEAR(along[k], tangent.norm(), 1e-4);
    EXPECT_NEAR(across[k], distorted_normal.dot(expected->slope * normal[k]), 1e-4);
  }
}

TEST_P(EachLensView, PlacesPointsBeyondItsRangeOutsideAnyPicture) {
  std::array<float, 2> x = {100.0F, 1e6F}, y = {100.0F, 0.0F}, nx = {1.0F, 1.0F}, ny = {};
  std::array<float, 2> across, along;
  LensView(lens_).distort(
      {0.0, 0.0}, {2, x.data(), y.data(), nx.data(), ny.data(), across.data(), along.data()});
  EXPECT_LT(std::abs(x[0]), 640.0F);
  EXPECT_EQ(x[1], static_cast<float>(kFarPx));
}

TEST_P(EachLensView, UndistortInvertsDistort) {
  const LensView view(lens_);
  const Ellipse small{
      250.0, 200.0, 9.0, 6.0, 0.4};  // so small that its distorted image is an ellipse
  const auto shown = distorted(view, small);
  ASSERT_TRUE(shown);
  const auto back = undistorted(view, *shown);
  ASSERT_TRUE(back);
  EXPECT_LT(max_difference_px(*back, small), 0.01);
  EXPECT_GT(max_difference_px(*shown, small), 0.2);
}

TEST_P(EachLensView, DoesNotDistortEllipsesPartlyOutOfRange) {
  const LensView view(lens_);
  EXPECT_FALSE(distorted(view, {320.0, 180.0, 5e4, 50.0, 0.0}));
}

TEST_P(EachLensView, VisibleFractionIsOfThePicture) {
  const LensView view(lens_);
  EXPECT_EQ(visible_fraction(view, {320.0, 180.0, 40.0, 30.0, 0.0}, 640, 360), 1.0);
  // The picture's left border halves `cut`; the ideal plane's rectangle contains less of it.
  const auto left = view.ideal_from_picture({-0.5, 180.0});
  ASSERT_TRUE(left);
  const Ellipse cut{left->x(), 180.0, 30.0, 30.0, 0.0};
  EXPECT_NEAR(visible_fraction(view, cut, 640, 360), 0.5, 0.05);
  EXPECT_LT(visible_fraction(Ellipse(cut), 640, 360), 0.45);
}

TEST_P(EachLensView, EdgesMoveAsTheirRowsPredict) {
  Matrix3d pose;
  pose << 70.0, 12.0, 210.0, -8.0, 60.0, 120.0, 0.05, -0.08, 1.0;
  PadModel model;
  model.circles.push_back({1.0, true, 100.0, false});
  model.lines.push_back({{-0.5, -0.4}, {0.5, 0.6}, Vector2d(1.0, -1.0).normalized(), 80.0});
  const support::GrayPicture picture(640, 360);
  EdgeSearch search;
  const LensView view(lens_);
  search.sample(model, {pose, view}, picture.view());
  ASSERT_GT(search.samples().size(), 40U);
  constexpr double kStep = 1e-5;
  for (const EdgeSample& sample : search.samples()) {
    // The point on the pad visible there.
    const auto ideal = view.ideal_from_picture(sample.view.point);
    ASSERT_TRUE(ideal);
    const Vector2d pad_point = (pose.inverse() * ideal->homogeneous()).hnormalized();
    for (int i = 0; i < 8; ++i) {
      const Matrix3d changed = moved(pose, kStep * HomographyChange::Unit(i));
      const auto there = PadView(changed, view).at(pad_point);
      ASSERT_TRUE(there);
      const double moved_px = sample.view.normal.dot(there->point - sample.view.point);
      EXPECT_NEAR(moved_px / kStep, sample.view.row(i), 0.3) << i;
    }
  }
}

TEST(LensView, IsUndistortedByDefault) {
  const Lens pinhole(Camera::with_hfov(1.012, 640, 360));
  for (const LensView& view : {LensView(), LensView(pinhole)}) {
    EXPECT_FALSE(view.is_distorted());
    const Vector2d pixel(17.0, 300.0);
    EXPECT_EQ(view.approximate_ideal(pixel), pixel);
    EXPECT_EQ(view.picture_from_ideal(pixel)->picture_px, pixel);
    EXPECT_EQ(*view.ideal_from_picture(pixel), pixel);
    EXPECT_FALSE(view.part({3.0, 4.0}).reduced(2).is_distorted());
    const Ellipse e{250.0, 200.0, 40.0, 20.0, 0.4};
    EXPECT_EQ(distorted(view, e), e);
    EXPECT_EQ(undistorted(view, e), e);
  }
}

TEST(LensModel, ArcTangentIsAccurateInSinglePrecision) {
  for (double x = 0.0; x < 30.0; x += 0.0137) {
    EXPECT_NEAR(arc_tangent(static_cast<float>(x)), std::atan(x), 3e-7) << x;
  }
}

}  // namespace
}  // namespace ellipse
