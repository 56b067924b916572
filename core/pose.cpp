// SPDX-License-Identifier: MIT
#include "core/pose.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Found by experiment, see docs/provenance.md.
constexpr double kStretchNoise = 2.3;
constexpr double kTiltOfNoise = 8.0;
constexpr double kMemory = 0.9;         // of the odds, from frame to frame
constexpr double kMostOdds = 12.0;      // logarithm
constexpr double kLevelRad = 0.1;       // standard deviation of a level target's normal
constexpr double kTurnPerFrame = 0.05;  // by which a normal moves between frames [rad]

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Two unit vectors that make a right-handed frame with the normal.
Eigen::Matrix<double, 3, 2> plane_axes(const Vector3d& normal) {
  const Vector3d first = normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> axes;
  axes << first, normal.cross(first);
  return axes;
}

// The pad's plane in front of the camera: columns are its axes and its centre [radii].
Matrix3d camera_from_plane(const CirclePose& pose) {
  Matrix3d plane;
  plane << plane_axes(pose.normal), pose.position;
  return plane;
}

// How far a solution would have to tilt the pad within its outer edge, in standard deviations.
double mismatch(const Camera& camera, const CirclePose& pose, const TiltEvidence& evidence) {
  const Vector3d on_pad = evidence.view.inverse() * projected_centre(camera, pose).homogeneous();
  const Vector2d place = on_pad.hnormalized();
  return place.dot(evidence.covariance.inverse() * place);
}

double from_level(const CirclePose& pose, const Vector3d& gravity) {
  return angle_between(pose.normal, -gravity) / kLevelRad;
}

}  // namespace

std::optional<std::array<CirclePose, 2>> circle_poses(const Camera& camera, const Ellipse& ideal) {
  const Matrix3d from_circle = camera.matrix().inverse() * image_from_pad(ideal);
  const Matrix3d to_circle = from_circle.inverse();
  Matrix3d cone = to_circle.transpose() * Vector3d(1.0, 1.0, -1.0).asDiagonal() * to_circle;
  // [KanataniLiu1993]: the cone's matrix Q with det Q = -1.
  cone /= std::cbrt(-cone.determinant());
  if (!cone.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(cone);
  const Vector3d& l = eigen.eigenvalues();  // ascending
  if (!(l(0) < 0.0 && l(1) > 0.0)) return std::nullopt;
  // [KanataniLiu1993]: the plane's normal, and its distance l1^(3/2) r.
  const double across = std::sqrt(std::max(0.0, (l(2) - l(1)) / (l(2) - l(0))));
  const double along = std::sqrt((l(1) - l(0)) / (l(2) - l(0)));
  const double distance = l(1) * std::sqrt(l(1));
  const Vector3d aside = eigen.eigenvectors().col(2);
  Vector3d axis = eigen.eigenvectors().col(0);
  if (axis.z() < 0.0) axis = -axis;
  std::array<CirclePose, 2> poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector3d away = along * axis + (i == 0 ? across : -across) * aside;
    // The centre is the pole of the plane's vanishing line.
    const Vector3d towards = cone.ldlt().solve(away);
    poses[i].position = distance / away.dot(towards) * towards;
    poses[i].normal = -away;
    if (!poses[i].position.allFinite() || !(poses[i].position.z() > 0.0)) return std::nullopt;
  }
  return poses;
}

Vector2d projected_centre(const Camera& camera, const CirclePose& pose) {
  return (camera.matrix() * pose.position).hnormalized();
}

Matrix3d image_from_pad(const Camera& camera, const CirclePose& pose) {
  return camera.matrix() * camera_from_plane(pose);
}

// The edge moves by five parameters of the pose: a shift, and turns about two axes in the plane.
Matrix3d position_covariance(const Camera& camera,
                             const CirclePose& pose,
                             const RingUncertainty& picture) {
  const Matrix3d plane = camera_from_plane(pose);
  const Matrix3d inverse = plane.inverse();
  RingMatrix changes;
  for (int i = 0; i < 3; ++i) {
    changes.col(i) = change_of(inverse * Vector3d::Unit(i) * Eigen::RowVector3d::UnitZ()).head<5>();
  }
  const Eigen::RowVector3d first = Eigen::RowVector3d::UnitX();
  const Eigen::RowVector3d second = Eigen::RowVector3d::UnitY();
  changes.col(3) = change_of(inverse * pose.normal * second).head<5>();
  changes.col(4) = change_of(-inverse * pose.normal * first).head<5>();
  const RingMatrix from_here = ring_changes(camera.matrix() * plane, picture.view);
  RingMatrix covariance = (from_here.transpose() * picture.information * from_here).inverse();
  // Near the view straight on the stretch goes with the tilt's square: it tells the tilt the less,
  // the nearer it is to its own noise, and at its noise no better than by that one's square root.
  const double noise = std::sqrt(covariance(3, 3) + covariance(4, 4));
  const double cosine = pose.normal.dot(pose.position.normalized());
  const double stretch = 0.25 * (1.0 - cosine * cosine);
  const double wider = std::hypot(1.0, kStretchNoise * noise / std::max(stretch, 1e-12));
  covariance.bottomRows<2>() *= wider;
  covariance.rightCols<2>() *= wider;
  RingMatrix information = changes.transpose() * covariance.inverse() * changes;
  information(3, 3) += 1.0 / (kTiltOfNoise * noise);
  information(4, 4) += 1.0 / (kTiltOfNoise * noise);
  return information.inverse().topLeftCorner<3, 3>();
}

// Near the view straight on the two solutions meet, and which was which is lost.
double PoseEstimator::carried_odds(const std::array<CirclePose, 2>& poses) const {
  const double same =
      angle_between(poses[0].normal, last_normal_) + angle_between(poses[1].normal, last_other_);
  const double swapped =
      angle_between(poses[1].normal, last_normal_) + angle_between(poses[0].normal, last_other_);
  const double apart = angle_between(poses[0].normal, poses[1].normal) / kTurnPerFrame;
  const double kept = kMemory * (1.0 - std::exp(-0.5 * apart * apart));
  return (same <= swapped ? odds_ : -odds_) * kept;
}

std::optional<TargetPose> PoseEstimator::estimate(const Lens& lens,
                                                  const Ellipse& ideal,
                                                  const RingUncertainty& picture,
                                                  const std::optional<TiltEvidence>& evidence,
                                                  double radius_m,
                                                  const Vector3d& gravity) {
  const Camera& camera = lens.camera();
  const auto poses = circle_poses(camera, ideal);
  if (!poses) return std::nullopt;
  const auto& [first, second] = *poses;
  double odds = was_known_ ? carried_odds(*poses) : 0.0;  // of the first one
  if (evidence) {
    odds += 0.5 * (mismatch(camera, second, *evidence) - mismatch(camera, first, *evidence));
  }
  if (gravity.squaredNorm() > 0.0) {
    odds +=
        0.5 * (std::pow(from_level(second, gravity), 2) - std::pow(from_level(first, gravity), 2));
  }
  if (!std::isfinite(odds)) odds = 0.0;
  const bool is_first = odds >= 0.0;
  const CirclePose& chosen = is_first ? first : second;
  const CirclePose& other = is_first ? second : first;
  // What is decided by nothing stays as it was decided.
  odds_ = std::clamp(std::abs(odds), 1e-3, kMostOdds);
  last_normal_ = chosen.normal;
  last_other_ = other.normal;
  was_known_ = true;

  TargetPose pose;
  pose.bearing = chosen.position.normalized();
  pose.angles_rad = {std::atan2(pose.bearing.x(), pose.bearing.z()),
                     std::atan2(pose.bearing.y(), pose.bearing.z())};
  const Vector2d centre = projected_centre(camera, chosen);
  const auto bent = lens.picture_from_ideal(centre);
  pose.centre_px = bent ? bent->picture_px : centre;
  pose.normal = chosen.normal;
  pose.other_normal = other.normal;
  pose.certainty = 1.0 / (1.0 + std::exp(-odds_));
  if (radius_m > 0.0) {
    pose.radius_m = radius_m;
    pose.position_m = radius_m * chosen.position;
    pose.other_position_m = radius_m * other.position;
    pose.covariance_m2 = radius_m * radius_m * position_covariance(camera, chosen, picture);
  }
  return pose;
}

}  // namespace ellipse
