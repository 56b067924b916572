// SPDX-License-Identifier: MIT
#include "core/camera/circle_pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/geometry/ellipse_fit.hpp"
#include "core/tracking/frame_clock.hpp"
#include "tests/support/chi_square.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Camera camera_640() {
  return Camera::with_hfov(1.012, 640, 360);
}

// A circle with its centre at a given image point and its normal tilted from the line of sight.
CirclePose circle_at(const Vector2d& place_px, double distance, double tilt_rad, double turn_rad) {
  const Camera camera = camera_640();
  const Vector3d bearing = (camera.matrix().inverse() * place_px.homogeneous()).normalized();
  const Vector3d first = bearing.unitOrthogonal();
  const Vector3d aside = std::cos(turn_rad) * first + std::sin(turn_rad) * bearing.cross(first);
  return {distance * bearing, -std::cos(tilt_rad) * bearing + std::sin(tilt_rad) * aside};
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The solution closer to the truth.
const CirclePose& nearer(const std::array<CirclePose, 2>& poses, const CirclePose& truth) {
  return angle(poses[0].normal, truth.normal) < angle(poses[1].normal, truth.normal) ? poses[0]
                                                                                     : poses[1];
}

RingUncertainty uncertainty_of(const Ellipse& e, double sigma) {
  return {image_from_pad(e), RingMatrix::Identity() / (sigma * sigma)};
}

TEST(CirclePoses, ContainTheTruePose) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const CirclePose truth = circle_at({640.0 * uniform(random), 360.0 * uniform(random)},
                                       2.0 + 30.0 * uniform(random),
                                       1.2 * uniform(random),
                                       6.28 * uniform(random));
    const auto ideal = project_circle(image_from_pad(camera_640(), truth), 1.0);
    ASSERT_TRUE(ideal);
    const auto poses = circle_poses(camera_640(), *ideal);
    ASSERT_TRUE(poses);
    const CirclePose& found = nearer(*poses, truth);
    EXPECT_LT((found.position - truth.position).norm(), 1e-6 * truth.position.norm());
    EXPECT_LT(angle(found.normal, truth.normal), 2e-5);
    for (const CirclePose& each : *poses) {
      const auto again = project_circle(image_from_pad(camera_640(), each), 1.0);
      ASSERT_TRUE(again);
      EXPECT_LT(max_difference_px(*again, *ideal), 1e-6);
    }
  }
}

TEST(CirclePoses, CoincideInTheFrontalView) {
  const CirclePose truth = circle_at({319.5, 179.5}, 8.0, 0.0, 0.0);
  const auto ideal = project_circle(image_from_pad(camera_640(), truth), 1.0);
  const auto poses = circle_poses(camera_640(), *ideal);
  ASSERT_TRUE(poses);
  EXPECT_LT(angle((*poses)[0].normal, (*poses)[1].normal), 1e-5);
  EXPECT_NEAR((*poses)[0].position.z(), 8.0, 1e-9);
}

TEST(CirclePoses, CentreDiffersFromTheEllipseCentre) {
  const CirclePose truth = circle_at({400.0, 120.0}, 4.0, 1.0, 0.7);
  const auto ideal = project_circle(image_from_pad(camera_640(), truth), 1.0);
  EXPECT_GT((ideal->center() - Vector2d(400.0, 120.0)).norm(), 5.0);
  const auto poses = circle_poses(camera_640(), *ideal);
  EXPECT_LT((projected_centre(camera_640(), nearer(*poses, truth)) - Vector2d(400.0, 120.0)).norm(),
            1e-5);
}

TEST(NearerPose, TiltsTheViewAndKeepsTheOutline) {
  const CirclePose truth = circle_at({400.0, 120.0}, 4.0, 0.5, 0.7);
  const Matrix3d view = image_from_pad(camera_640(), truth);
  for (const double drift : {-0.3, -0.15, 0.0, 0.05}) {
    HomographyChange tilt = HomographyChange::Zero();
    tilt.tail<2>() = Vector2d(drift, 0.5 * drift);
    const Matrix3d drifted = moved(view, tilt);
    const Matrix3d corrected = with_nearer_pose(camera_640(), drifted);
    const Ellipse outline = project_circle(drifted, 1.0).value();
    EXPECT_LT(max_difference_px(project_circle(corrected, 1.0).value(), outline), 1e-6) << drift;
    // No rotation: all points of the pad are where they were.
    for (const Vector2d& point : {Vector2d(0.0, 0.0), Vector2d(0.5, 0.0), Vector2d(0.0, -0.8)}) {
      const Vector2d moved_px = (corrected * point.homogeneous()).hnormalized();
      EXPECT_LT((moved_px - (view * point.homogeneous()).hnormalized()).norm(), 0.05) << drift;
    }
  }
}

TEST(NearerPose, TakesTheNearerOne) {
  const CirclePose truth = circle_at({320.0, 180.0}, 3.0, 0.8, 0.0);
  const Matrix3d view = image_from_pad(camera_640(), truth);
  const auto poses = circle_poses(camera_640(), project_circle(view, 1.0).value()).value();
  for (const CirclePose& pose : poses) {
    const Vector2d centre = projected_centre(camera_640(), pose);
    const Vector2d on_pad = (view.inverse() * centre.homogeneous()).hnormalized();
    HomographyChange tilt = HomographyChange::Zero();
    tilt.tail<2>() = 0.9 * on_pad;
    const Vector2d found = with_nearer_pose(camera_640(), moved(view, tilt)).col(2).hnormalized();
    EXPECT_LT((found - centre).norm(), 0.01);
  }
}

TEST(NearerPose, KeepsAViewWithoutPose) {
  const Matrix3d view = Vector3d(1.0, 0.0, 1.0).asDiagonal();  // the pad edge-on
  EXPECT_EQ(with_nearer_pose(camera_640(), view), view);
}

TEST(CirclePoses, AreFiniteForTheThinnestEllipses) {
  for (const double minor : {1e-3, 1e-8, 1e-200}) {
    const auto poses = circle_poses(camera_640(), {320.0, 180.0, 100.0, minor, 0.3});
    if (!poses) continue;
    for (const CirclePose& pose : *poses) {
      EXPECT_TRUE(pose.position.allFinite());
      EXPECT_TRUE(pose.normal.allFinite());
    }
  }
}

// The five parameters predict the displacement of an edge point in any view.
TEST(RingJacobian, ConvertsTheSameChangeBetweenViews) {
  const CirclePose pose = circle_at({400.0, 120.0}, 4.0, 0.8, 0.7);
  const Matrix3d view = image_from_pad(camera_640(), pose);
  const auto ellipse = project_circle(view, 1.0);
  const Matrix3d affine = image_from_pad(*ellipse);
  Eigen::Matrix<double, 5, 1> change;
  change << 1e-5, -2e-5, 1.5e-5, 0.7e-5, -1.1e-5;
  const auto same = (ring_jacobian(affine, view) * change).eval();
  HomographyChange in_affine = HomographyChange::Zero();
  HomographyChange in_view = HomographyChange::Zero();
  in_affine.head<5>() = change;
  in_view.head<5>() = same;
  const auto first = project_circle(moved(affine, in_affine), 1.0);
  const auto second = project_circle(moved(view, in_view), 1.0);
  ASSERT_TRUE(first && second);
  EXPECT_GT(max_difference_px(*first, *ellipse), 1e-3);
  EXPECT_LT(max_difference_px(*first, *second), 1e-6);
}

// The mean normalised squared error of 10,000 positions is 3, within 1.96 sqrt(6 / 10,000). Its
// tail is slightly longer than chi-square's, because the error is not normal near the view straight
// on: of 250,000 positions .9484 are within the 95 % quantile.
TEST(PositionCovariance, MatchesTheScatterOfThePositions) {
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  const Camera camera = camera_640();
  constexpr int kPoses = 10000;
  constexpr int kPoints = 96;
  constexpr double kSigmaPx = 0.1;
  double sum = 0.0;
  int inside = 0;
  for (int n = 0; n < kPoses; ++n) {
    // Separate statements: the evaluation order of arguments differs among compilers.
    const double x = 160.0 + 320.0 * uniform(random);
    const double y = 90.0 + 180.0 * uniform(random);
    const double distance = std::exp(std::lerp(std::log(2.0), std::log(20.0), uniform(random)));
    const double tilt = std::numbers::pi / 3.0 * uniform(random);
    const double turn = 2.0 * std::numbers::pi * uniform(random);
    const CirclePose truth = circle_at({x, y}, distance, tilt, turn);
    const auto exact = project_circle(image_from_pad(camera, truth), 1.0);
    ASSERT_TRUE(exact);
    Ellipse fitted = *exact;
    RingUncertainty picture{};
    std::array<Vector2d, kPoints> points;
    for (int i = 0; i < kPoints; ++i) {
      const Vector2d point = exact->point_at(2.0 * std::numbers::pi * i / kPoints);
      const double noise_x = normal(random);
      const double noise_y = normal(random);
      points[static_cast<std::size_t>(i)] = point + kSigmaPx * Vector2d(noise_x, noise_y);
    }
    for (int step = 0; step < 3; ++step) {
      GeometricFit fit(fitted);
      for (const Vector2d& point : points) fit.add(point);
      picture = {image_from_pad(fitted), fit.information() / (kSigmaPx * kSigmaPx)};
      const auto better = fit.solve();
      ASSERT_TRUE(better);
      fitted = *better;
    }
    const auto poses = circle_poses(camera, fitted);
    ASSERT_TRUE(poses);
    const CirclePose& found = nearer(*poses, truth);
    const Vector3d error = found.position - truth.position;
    const Matrix3d covariance = position_covariance(camera, found, picture);
    const double nees = error.dot(covariance.inverse() * error);
    sum += nees;
    inside += nees < support::kChiSquare3 ? 1 : 0;
  }
  const double mean = sum / kPoses;
  EXPECT_NEAR(mean, 3.0, 1.96 * std::sqrt(6.0 / kPoses));
  EXPECT_NEAR(static_cast<double>(inside) / kPoses, 0.95, 0.0043 + 0.0016);
}

// -- PoseEstimator

TEST(PositionCovariance, IsPositiveForAnyPartOfTheOutline) {
  const Camera camera = camera_640();
  for (double out_px = 0.0; out_px < 1500.0; out_px += 1.7) {
    const Ellipse e{-out_px, 256.1, 766.0, 614.3, 0.4};
    const auto poses = circle_poses(camera, e);
    if (!poses) continue;
    const RingUncertainty picture = expected_uncertainty(e, 640, 360, 0.3);
    const RingMatrix parameters = parameter_covariance(e, picture);
    ASSERT_TRUE(parameters.allFinite()) << out_px;
    EXPECT_GT(parameters.diagonal().minCoeff(), 0.0) << out_px;
    for (const CirclePose& pose : *poses) {
      const Matrix3d covariance = position_covariance(camera, pose, picture);
      ASSERT_TRUE(covariance.allFinite()) << out_px;
      EXPECT_GT(covariance.diagonal().minCoeff(), 0.0) << out_px;
    }
  }
}

struct CircleView {
  CirclePose truth;
  Ellipse ideal;
};

CircleView view_at(double tilt_rad, double turn_rad = 0.7) {
  CircleView view{circle_at({400.0, 120.0}, 6.0, tilt_rad, turn_rad), {}};
  view.ideal = *project_circle(image_from_pad(camera_640(), view.truth), 1.0);
  return view;
}

// The image of a circle inside the target's, measured with this uncertainty [radii].
FittedEllipse inner_edge(const CirclePose& pose, double radius = 0.8, double sigma = 1e-3) {
  const auto image = project_circle(image_from_pad(camera_640(), pose), radius);
  return {*image, uncertainty_of(*image, sigma)};
}

std::optional<TargetPose> pose_of(PoseEstimator& estimator,
                                  const CircleView& view,
                                  const std::vector<FittedEllipse>& inner_edges,
                                  const Vector3d& gravity = Vector3d::Zero()) {
  estimator.advance(kFrame_s);
  return estimator.estimate(Lens(camera_640()),
                            view.ideal,
                            uncertainty_of(view.ideal, 1e-3),
                            {.inner_edges = inner_edges, .gravity = gravity},
                            0.75);
}

TEST(PoseEstimator, ResolvesTheAmbiguityByOneInnerCircle) {
  for (double turn = 0.0; turn < 6.28; turn += 0.3) {
    const CircleView view = view_at(0.5, turn);
    PoseEstimator estimator;
    const auto pose = pose_of(estimator, view, {inner_edge(view.truth)});
    ASSERT_TRUE(pose);
    EXPECT_LT(angle(pose->normal, view.truth.normal), 1e-5);
    EXPECT_GT(angle(pose->other_normal, view.truth.normal), 0.5);
    EXPECT_LT((pose->position_m - 0.75 * view.truth.position).norm(), 1e-6);
    EXPECT_GT(pose->certainty, 0.99);
  }
}

TEST(PoseEstimator, ResolvesTheAmbiguityByGravity) {
  for (double turn = 0.0; turn < 6.28; turn += 0.3) {
    const CircleView view = view_at(0.5, turn);
    PoseEstimator estimator;
    const auto pose = pose_of(estimator, view, {}, -9.81 * view.truth.normal);
    ASSERT_TRUE(pose);
    EXPECT_LT(angle(pose->normal, view.truth.normal), 1e-5);
    EXPECT_GT(pose->certainty, 0.99);
  }
}

TEST(PoseEstimator, KeepsTheResolvedSolution) {
  PoseEstimator estimator;
  (void)pose_of(estimator, view_at(0.5), {inner_edge(view_at(0.5).truth)});
  for (int i = 1; i < 100; ++i) {
    const CircleView view = view_at(0.5 + 0.2 * std::sin(0.1 * i), 0.7 + 0.05 * i);
    const auto pose = pose_of(estimator, view, {});
    ASSERT_TRUE(pose);
    EXPECT_LT(angle(pose->normal, view.truth.normal), 1e-5) << i;
    EXPECT_GT(pose->certainty, 0.99) << i;
  }
}

TEST(PoseEstimator, RepeatedFramesAddNoEvidence) {
  PoseEstimator estimator;
  const CircleView view = view_at(0.5);
  const FittedEllipse inner = inner_edge(view.truth, 0.8, 0.05);
  const auto log_odds = [&] {
    const double certainty = pose_of(estimator, view, {inner})->certainty;
    return std::log(certainty / (1.0 - certainty));
  };
  const double once = log_odds();
  EXPECT_GT(once, 0.1);
  double often = 0.0;
  for (int i = 0; i < 300; ++i) often = log_odds();
  EXPECT_NEAR(often, once, 1e-6 * once);
}

TEST(PoseEstimator, InnerEdgesThatFitNeitherSolutionAddLittleEvidence) {
  const CircleView view = view_at(0.5);
  FittedEllipse strange = inner_edge(view.truth);
  strange.ellipse.semi_major *= 1.1;
  strange.ellipse.semi_minor /= 1.1;
  PoseEstimator estimator;
  EXPECT_LT(pose_of(estimator, view, {strange})->certainty, 0.9);
}

TEST(PoseEstimator, GravityOverridesAnInnerEdge) {
  for (double turn = 0.0; turn < 6.28; turn += 0.3) {
    const CircleView view = view_at(0.5, turn);
    PoseEstimator estimator;
    const auto poses = circle_poses(camera_640(), view.ideal);
    const bool is_first = angle((*poses)[0].normal, view.truth.normal) < 1e-3;
    const FittedEllipse wrong = inner_edge((*poses)[is_first ? 1 : 0]);
    for (int i = 0; i < 20; ++i) (void)pose_of(estimator, view, {wrong});
    const auto pose = pose_of(estimator, view, {wrong}, -view.truth.normal);
    EXPECT_LT(angle(pose->normal, view.truth.normal), 1e-5);
  }
}

// The pattern's view is the true one, or one in which a tilt was wrong when its lines were learned.
TEST(PoseEstimator, ResolvesTheAmbiguityByThePattern) {
  const Eigen::Matrix2d covariance = Vector2d::Constant(1e-5).asDiagonal();
  for (double turn = 0.0; turn < 6.28; turn += 0.3) {
    const CircleView view = view_at(0.5, turn);
    Matrix3d biased = image_from_pad(camera_640(), view.truth);
    biased.row(2).head<2>() += 0.02 * biased(2, 2) * Eigen::RowVector2d(1.0, -1.0);
    for (const Matrix3d& seen : {image_from_pad(camera_640(), view.truth), biased}) {
      PoseEstimator estimator;
      const PoseEvidence evidence{.pattern = PatternView{seen, covariance}};
      const RingUncertainty edge = uncertainty_of(view.ideal, 1e-3);
      const auto pose = estimator.estimate(Lens(camera_640()), view.ideal, edge, evidence, 0.75);
      ASSERT_TRUE(pose);
      EXPECT_LT(angle(pose->normal, view.truth.normal), 1e-5);
      EXPECT_GT(pose->certainty, 0.9);
    }
  }
}

// Frames without a target or without inner edges age the evidence, too.
TEST(PoseEstimator, ForgetsInFramesWithoutInnerEdges) {
  const CircleView view = view_at(0.5);
  const auto poses = circle_poses(camera_640(), view.ideal);
  ASSERT_TRUE(poses);
  const bool is_first = angle((*poses)[0].normal, view.truth.normal) < 1e-5;
  const FittedEllipse other = inner_edge((*poses)[is_first ? 1 : 0]);
  for (const bool has_gap : {false, true}) {
    PoseEstimator estimator;
    for (int i = 0; i < 60; ++i) (void)pose_of(estimator, view, {inner_edge(view.truth)});
    if (has_gap) {
      estimator.advance(10.0);
      for (int i = 0; i < 300; ++i) (void)pose_of(estimator, view, {});
    }
    const auto pose = pose_of(estimator, view, {other});
    ASSERT_TRUE(pose);
    EXPECT_EQ(angle(pose->normal, view.truth.normal) < 1e-5, !has_gap);
  }
}

TEST(PoseEstimator, CertaintyIsOneHalfWithoutEvidence) {
  PoseEstimator estimator;
  const auto pose = pose_of(estimator, view_at(0.5), {});
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->certainty, 0.5, 1e-3);
}

TEST(PoseEstimator, ReportsDirectionsOnlyWithoutADiameter) {
  const CircleView view = view_at(0.5);
  PoseEstimator estimator;
  const auto pose = estimator.estimate(Lens(camera_640()),
                                       view.ideal,
                                       uncertainty_of(view.ideal, 1e-3),
                                       {.gravity = -view.truth.normal},
                                       0.0);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->radius_m, 0.0);
  EXPECT_LT(angle(pose->bearing, view.truth.position), 1e-6);
  EXPECT_NEAR(std::tan(pose->angles_rad.x()), (400.0 - 319.5) / camera_640().fx, 1e-6);
  EXPECT_NEAR(std::tan(pose->angles_rad.y()), (120.0 - 179.5) / camera_640().fy, 1e-6);
  EXPECT_LT((pose->centre_px - Vector2d(400.0, 120.0)).norm(), 1e-4);
}

}  // namespace
}  // namespace ellipse
