// SPDX-License-Identifier: MIT
#include "core/camera/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <vector>

#include "tests/support/cameras.hpp"

namespace ellipse {
namespace {

using Eigen::Vector2d;

std::vector<cv::Point2d> opencv_picture(const Camera& camera, const std::vector<Vector2d>& ideal) {
  const cv::Matx33d k(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  std::vector<cv::Point3d> rays;
  for (const Vector2d& p : ideal) {
    rays.emplace_back((p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy, 1.0);
  }
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  std::vector<cv::Point2d> picture;
  if (camera.lens == LensModel::kFisheye) {
    const auto& d = camera.distortion;
    cv::fisheye::projectPoints(rays, picture, zero, zero, k, cv::Vec4d(d[0], d[1], d[2], d[3]));
  } else {
    const cv::Mat d(1, 8, CV_64F, const_cast<double*>(camera.distortion.data()));
    cv::projectPoints(rays, zero, zero, k, d, picture);
  }
  return picture;
}

std::vector<Vector2d> grid(double margin_px) {
  std::vector<Vector2d> points;
  for (double y = -margin_px; y <= 360.0 + margin_px; y += 23.7) {
    for (double x = -margin_px; x <= 640.0 + margin_px; x += 31.1) points.emplace_back(x, y);
  }
  return points;
}

class EachLens : public testing::TestWithParam<Camera> {};
INSTANTIATE_TEST_SUITE_P(Lens, EachLens, testing::Values(support::wide(), support::fisheye()));

TEST_P(EachLens, DistortsLikeOpenCv) {
  const Lens lens(GetParam());
  const std::vector<Vector2d> ideal = grid(40.0);
  const std::vector<cv::Point2d> expected = opencv_picture(GetParam(), ideal);
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const auto point = lens.picture_from_ideal(ideal[i]);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->picture_px.x(), expected[i].x, 1e-8);
    EXPECT_NEAR(point->picture_px.y(), expected[i].y, 1e-8);
  }
}

TEST_P(EachLens, UndistortInvertsDistort) {
  const Lens lens(GetParam());
  for (const Vector2d& ideal : grid(100.0)) {
    const auto point = lens.picture_from_ideal(ideal);
    ASSERT_TRUE(point);
    const auto back = lens.ideal_from_picture(point->picture_px);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - ideal).norm(), 1e-6) << ideal.transpose();
  }
}

TEST_P(EachLens, DerivativeMatchesDifferences) {
  const Lens lens(GetParam());
  constexpr double kStep = 1e-4;
  for (const Vector2d& ideal : grid(0.0)) {
    const auto here = lens.picture_from_ideal(ideal);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = kStep * Vector2d::Unit(axis);
      const Vector2d change = lens.picture_from_ideal(ideal + step)->picture_px -
                              lens.picture_from_ideal(ideal - step)->picture_px;
      EXPECT_LT((change / (2.0 * kStep) - here->slope.col(axis)).norm(), 1e-6);
    }
  }
}

TEST(Lens, RangeEndsWhereThePolynomialTurnsBack) {
  Camera camera = Camera::with_hfov(1.012, 640, 360);
  camera.distortion = {-0.3};  // r (1 - .3 r^2) is highest at r = 1.054
  const Lens lens(camera);
  const Vector2d middle(camera.cx, camera.cy);
  EXPECT_TRUE(lens.picture_from_ideal(middle + Vector2d(1.0 * camera.fx, 0.0)));
  EXPECT_FALSE(lens.picture_from_ideal(middle + Vector2d(1.06 * camera.fx, 0.0)));
  EXPECT_FALSE(lens.ideal_from_picture(middle + Vector2d(0.75 * camera.fx, 0.0)));
}

TEST(Lens, EqualsTheIdealPlaneWithoutDistortion) {
  const Camera camera = Camera::with_hfov(1.012, 640, 360);
  EXPECT_FALSE(camera.is_distorted());
  const Lens lens(camera);
  EXPECT_LT((lens.picture_from_ideal({17.0, 300.0})->picture_px - Vector2d(17.0, 300.0)).norm(),
            1e-12);
}

TEST(Camera, ResizedSeesTheSameDirections) {
  const Camera camera = support::wide();
  const Camera half = camera.resized(320, 180);
  const Vector2d ideal(500.0, 90.0);
  const Vector2d ideal_of_half = 0.5 * (ideal.array() + 0.5).matrix() - Vector2d(0.5, 0.5);
  const Vector2d whole = Lens(camera).picture_from_ideal(ideal)->picture_px;
  const Vector2d small = Lens(half).picture_from_ideal(ideal_of_half)->picture_px;
  EXPECT_LT((2.0 * (small.array() + 0.5) - 0.5 - whole.array()).matrix().norm(), 1e-9);
}

}  // namespace
}  // namespace ellipse
