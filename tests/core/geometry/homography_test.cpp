// SPDX-License-Identifier: MIT
#include "core/geometry/homography.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix3d tilted_view() {
  Matrix3d view = image_from_pad({310.0, 170.0, 80.0, 55.0, 0.4});
  view(2, 0) = 0.08;
  view(2, 1) = -0.05;
  return view;
}

Vector2d projected(const Matrix3d& view, const Vector2d& point) {
  return (view * point.homogeneous()).hnormalized();
}

TEST(Homography, MapsTheUnitCircleToTheEllipse) {
  const Ellipse e{310.0, 170.0, 80.0, 55.0, 0.4};
  const auto circle = project_circle(image_from_pad(e), 1.0);
  ASSERT_TRUE(circle);
  EXPECT_LT(max_difference_px(*circle, e), 1e-9);
}

TEST(Homography, KeepsTheOuterCircleWithoutPerspective) {
  HomographyChange tilt = HomographyChange::Zero();
  tilt.tail<2>() << 0.2, -0.1;
  const Eigen::Matrix3d view = moved(image_from_pad({300.0, 180.0, 60.0, 48.0, 0.4}), tilt);
  const Eigen::Matrix3d affine = without_perspective(view);
  EXPECT_GT(view.row(2).head<2>().norm(), 0.1);
  EXPECT_LT(affine.row(2).head<2>().norm(), 1e-12);
  const auto before = project_circle(view, 1.0);
  const auto after = project_circle(affine, 1.0);
  ASSERT_TRUE(before && after);
  EXPECT_LT(max_difference_px(*after, *before), 1e-6);
}

TEST(Homography, IsAlignedToAGivenOuterEdge) {
  const Matrix3d view = tilted_view();
  const Ellipse outer_edge = project_circle(view, 1.0).value();
  for (const Ellipse& e : {outer_edge,
                           translated(outer_edge, 3.0, -2.0),
                           Ellipse{312.0, 171.0, 90.0, 50.0, 0.7},
                           Ellipse{300.0, 165.0, 70.0, 70.0, 0.0}}) {
    const auto laid = with_circle(view, e);
    ASSERT_TRUE(laid);
    EXPECT_LT(max_difference_px(project_circle(*laid, 1.0).value(), e), 1e-8);
  }
  EXPECT_LT((with_circle(view, outer_edge).value() - view).norm(), 1e-8 * view.norm());
  const Ellipse moved_edge = translated(outer_edge, 3.0, -2.0);
  const Vector2d mark(0.4, 0.1);  // moves with the edge
  const Vector2d by =
      projected(with_circle(view, moved_edge).value(), mark) - projected(view, mark);
  EXPECT_LT((by - Vector2d(3.0, -2.0)).norm(), 0.2);
  EXPECT_FALSE(with_circle(Matrix3d::Zero(), outer_edge));
}

TEST(Homography, RowsAreTheDerivativesAlongTheNormal) {
  const Matrix3d view = tilted_view();
  constexpr double kStep = 1e-6;
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    const Vector2d normal(std::cos(angle), std::sin(angle));
    const Vector2d point = 0.8 * normal + Vector2d(0.1, -0.2);
    const auto edge = view_of(view, point, normal);
    ASSERT_TRUE(edge);
    EXPECT_LT((edge->point - projected(view, point)).norm(), 1e-9);
    for (int i = 0; i < 8; ++i) {
      const Matrix3d changed = moved(view, kStep * HomographyChange::Unit(i));
      const double moved_px = edge->normal.dot(projected(changed, point) - edge->point);
      EXPECT_NEAR(moved_px / kStep, edge->row(i), 1e-3) << i;
    }
    const double along = edge->normal.dot(projected(view, point + kStep * normal) - edge->point);
    EXPECT_NEAR(along / kStep, edge->px_per_unit, 1e-3);
  }
}

TEST(Homography, TurnAndTiltKeepTheOuterCircle) {
  const Matrix3d view = tilted_view();
  const auto circle = project_circle(view, 1.0);
  for (const int i : {5, 6, 7}) {
    const auto turned = project_circle(moved(view, 1e-4 * HomographyChange::Unit(i)), 1.0);
    ASSERT_TRUE(circle && turned);
    EXPECT_LT(max_difference_px(*circle, *turned), 1e-4) << i;
  }
}

TEST(Homography, ChangeBetweenInvertsMoved) {
  HomographyChange change;
  change << 0.01, -0.02, 0.005, 0.003, -0.004, 0.02, 0.001, -0.002;
  const Matrix3d view = tilted_view();
  EXPECT_LT((change_between(view, moved(view, change)) - change).norm(), 1e-3);
  HomographyChange shift = HomographyChange::Zero();
  shift.head<2>() << 1.5, -0.7;
  EXPECT_LT((change_between(view, moved(view, shift)) - shift).norm(), 1e-9);
}

TEST(Homography, ChangesAsPredictedByTheCameraMotion) {
  // A camera above the pad makes small motions; the view must change by the predicted amounts.
  constexpr double kFocal = 500.0;
  const Vector2d middle(319.5, 179.5);
  Matrix3d k;
  k << kFocal, 0.0, middle.x(), 0.0, kFocal, middle.y(), 0.0, 0.0, 1.0;
  Matrix3d pose;
  pose.leftCols<2>() =
      Eigen::AngleAxisd(0.3, Vector3d(1.0, 0.5, 0.2).normalized()).toRotationMatrix().leftCols<2>();
  pose.col(2) = Vector3d(0.4, -0.3, 6.0);
  const Matrix3d view = k * pose;
  const auto changes = change_by_camera(view / view(2, 2), k);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 6; ++i) {
    Matrix3d after = pose;
    if (i < 3) {
      after = Eigen::AngleAxisd(kStep, Vector3d::Unit(i)).toRotationMatrix() * pose;
    } else {
      after.col(2) += kStep * Vector3d::Unit(i - 3);
    }
    const Matrix3d expected = k * after;
    const Matrix3d predicted = moved(view, kStep * HomographyChange(changes.col(i)));
    for (const Vector2d& point : {Vector2d(0.9, 0.1), Vector2d(-0.5, 0.7), Vector2d(0.0, 0.0)}) {
      const Vector2d motion = projected(expected, point) - projected(view, point);
      EXPECT_LT((projected(predicted, point) - projected(expected, point)).norm(),
                1e-3 * motion.norm() + 1e-9);
    }
  }
}

TEST(ParameterCovariance, MatchesTheScatterOfSmallViewChanges) {
  const Matrix3d view = tilted_view();
  const Ellipse e = project_circle(view, 1.0).value();
  const RingMatrix root = RingMatrix::NullaryExpr([](Eigen::Index i, Eigen::Index k) {
    const double any = std::sin(1.0 + 3.0 * static_cast<double>(i) + 5.0 * static_cast<double>(k));
    return 1e-4 * (i == k ? 1.0 : 0.3 * any);
  });
  RingMatrix expected = RingMatrix::Zero();
  for (int i = 0; i < 5; ++i) {
    HomographyChange change = HomographyChange::Zero();
    change.head<5>() = root.col(i);
    const Ellipse after = project_circle(moved(view, change), 1.0).value();
    const Eigen::Matrix<double, 5, 1> difference{after.cx - e.cx,
                                                 after.cy - e.cy,
                                                 after.semi_major - e.semi_major,
                                                 after.semi_minor - e.semi_minor,
                                                 after.angle_rad - e.angle_rad};
    expected += difference * difference.transpose();
  }
  const RingMatrix information = (root * root.transpose()).inverse();
  const RingMatrix covariance = parameter_covariance(e, {view, information});
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      const double scale = std::sqrt(expected(i, i) * expected(k, k));
      EXPECT_NEAR(covariance(i, k), expected(i, k), 0.01 * scale) << i << ' ' << k;
    }
  }
}

TEST(ParameterCovariance, AngleOfACircleIsUnknown) {
  const Ellipse circle{100.0, 80.0, 30.0, 30.0, 0.0};
  const RingMatrix covariance =
      parameter_covariance(circle, {image_from_pad(circle), 1e6 * RingMatrix::Identity()});
  EXPECT_NEAR(covariance(4, 4), std::numbers::pi * std::numbers::pi / 12.0, 1e-9);
  EXPECT_NEAR(covariance(0, 0), 9e-4, 1e-9);  // (30 px / 1000)^2
}

TEST(Homography, SeesNothingBehindTheCamera) {
  Matrix3d view = tilted_view();
  view(2, 0) = 2.0;
  EXPECT_FALSE(view_of(view, {-1.0, 0.0}, {-1.0, 0.0}));
  EXPECT_FALSE(project_circle(view, 1.0));
}

}  // namespace
}  // namespace ellipse
