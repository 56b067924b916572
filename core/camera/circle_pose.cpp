// SPDX-License-Identifier: MIT
#include "core/camera/circle_pose.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Found by experiment, see docs/provenance.md.
constexpr double kInnerEdgeMemory_s = 1.7;
constexpr double kInnerBiasPx = 0.02;  // standard deviation of an edge's systematic error
constexpr double kLevelRad = 0.1;      // standard deviation of a level target's normal

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Two unit vectors that form a right-handed frame with the normal.
Eigen::Matrix<double, 3, 2> plane_axes(const Vector3d& normal) {
  const Vector3d first = normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> axes;
  axes << first, normal.cross(first);
  return axes;
}

// Maps the pad's plane to the camera frame: columns are its axes and its centre [radii].
Matrix3d camera_from_plane(const CirclePose& pose) {
  Matrix3d plane;
  plane << plane_axes(pose.normal), pose.position;
  return plane;
}

// Change of a view's unit circle to a circle's image, to first order.
std::optional<RingChange> ring_change(const Matrix3d& view, const std::optional<Ellipse>& image) {
  const auto there = image ? with_circle(view, *image) : std::nullopt;
  if (!there) return std::nullopt;
  return change_between(view, *there).head<5>();
}

// Residuals of the inner edges under the two solutions.
struct InnerMisfit {
  std::array<double, 2> chi_squared{};
  double separation = 0.0;  // chi-square between the two predictions
  int degrees = 0;
};

// Residual of an inner edge under a solution, for the radius that fits best.
struct RadiusFit {
  RingChange residual;
  RingMatrix weights;  // of rank 4: the radius is projected out
};

std::optional<RadiusFit> fit_radius(const Matrix3d& predicted,
                                    const Matrix3d& view,
                                    const RingChange& measured,
                                    const RingMatrix& information,
                                    double radius) {
  RadiusFit fit;
  for (const bool is_last : {false, true}) {  // a Gauss-Newton step
    const auto here = ring_change(view, project_circle(predicted, radius));
    if (!here) return std::nullopt;
    const Matrix3d circle = predicted * Vector3d(radius, radius, 1.0).asDiagonal();
    const RingChange growth = ring_jacobian(circle, view).col(2);
    const RingChange weighted = information * growth;
    fit.residual = measured - *here;
    fit.weights = information - weighted * weighted.transpose() / weighted.dot(growth);
    if (!is_last) radius *= 1.0 + weighted.dot(fit.residual) / weighted.dot(growth);
  }
  return fit;
}

// Compares one inner edge with the predictions of both solutions. Its radius is fitted, so four of
// its five parameters discriminate.
void add_misfit(const Camera& camera,
                const std::array<CirclePose, 2>& poses,
                const RingUncertainty& outer,
                const FittedEllipse& inner,
                InnerMisfit& misfit) {
  const Matrix3d& view = inner.uncertainty.view;
  const auto measured = ring_change(view, inner.ellipse);
  const auto outer_ellipse = project_circle(outer.view, 1.0);
  if (!measured || !outer_ellipse) return;
  const double size_px = mean_radius_px(inner.ellipse);
  // An error of the outer edge shifts the prediction.
  const RingMatrix along = ring_jacobian(outer.view, view);
  RingMatrix covariance = inner.uncertainty.information.inverse() +
                          along * outer.information.inverse() * along.transpose();
  covariance.diagonal().array() += std::pow(kInnerBiasPx / size_px, 2);
  const RingMatrix information = covariance.inverse();

  const double ratio = size_px / mean_radius_px(*outer_ellipse);
  const auto first =
      fit_radius(image_from_pad(camera, poses[0]), view, *measured, information, ratio);
  const auto second =
      fit_radius(image_from_pad(camera, poses[1]), view, *measured, information, ratio);
  if (!first || !second) return;
  const RingMatrix& weights = second->weights;
  misfit.chi_squared[0] += first->residual.dot(weights * first->residual);
  misfit.chi_squared[1] += second->residual.dot(weights * second->residual);
  const RingChange apart = second->residual - first->residual;
  misfit.separation += apart.dot(weights * apart);
  misfit.degrees += RingChange::SizeAtCompileTime - 1;  // the radius is fitted
}

// Log likelihood ratio of the first solution under errors of unknown scale: Student's t, with as
// many degrees of freedom as were measured. If neither fits, as on a pad that is not flat, the
// ratio is small.
double log_odds(const InnerMisfit& misfit) {
  const double degrees = misfit.degrees;
  return degrees * std::log((degrees + misfit.chi_squared[1]) / (degrees + misfit.chi_squared[0]));
}

// Log likelihood ratio of the first solution by the pattern's centre, which lies elsewhere under
// the second one. Student's t again: the pattern was learned under a view that may have been wrong.
double log_odds(const Camera& camera,
                const std::array<CirclePose, 2>& poses,
                const PatternView& pattern) {
  const Matrix3d pad_from_camera = pattern.image_from_pad.inverse() * camera.matrix();
  InnerMisfit misfit;
  misfit.degrees = 2;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector2d centre = (pad_from_camera * poses[i].position).hnormalized();
    misfit.chi_squared[i] = centre.dot(pattern.centre_covariance.ldlt().solve(centre));
  }
  return log_odds(misfit);
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

// A Lorentz boost of the pad's plane maps the unit circle to itself, and the pad's centre to that
// of the nearer pose.
Matrix3d with_nearer_pose(const Camera& camera, const Matrix3d& image_from_pad) {
  const auto outer = project_circle(image_from_pad, 1.0);
  const auto poses = outer ? circle_poses(camera, *outer) : std::nullopt;
  if (!poses) return image_from_pad;
  const Matrix3d pad_from_image = image_from_pad.inverse();
  Vector2d nearest = Vector2d::Constant(1.0);
  for (const CirclePose& pose : *poses) {
    const Vector2d centre =
        (pad_from_image * projected_centre(camera, pose).homogeneous()).hnormalized();
    if (centre.norm() < nearest.norm()) nearest = centre;
  }
  const double slack = 1.0 - nearest.squaredNorm();
  if (!(slack > 0.0)) return image_from_pad;
  const double factor = 1.0 / std::sqrt(slack);
  Matrix3d boost = Matrix3d::Identity();
  boost.topLeftCorner<2, 2>() += factor * factor / (1.0 + factor) * nearest * nearest.transpose();
  boost.topRightCorner<2, 1>() = factor * nearest;
  boost.bottomLeftCorner<1, 2>() = factor * nearest.transpose();
  boost(2, 2) = factor;
  const Matrix3d view = image_from_pad * boost;
  return view / view(2, 2);
}

// Five pose parameters move the edge: a shift, and rotations about two axes in the plane.
Matrix3d position_covariance(const Camera& camera,
                             const CirclePose& pose,
                             const RingUncertainty& picture,
                             double tilt_sigma_rad) {
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
  const RingMatrix from_here = ring_jacobian(camera.matrix() * plane, picture.view);
  RingMatrix covariance = (from_here.transpose() * picture.information * from_here).inverse();
  // Near a frontal view the stretch is quadratic in the tilt. The tilt's sigma grows as the stretch
  // comes within two sigma of its noise, up to the given one.
  const double noise = std::sqrt(covariance(3, 3) + covariance(4, 4));
  const double cosine = pose.normal.dot(pose.position.normalized());
  const double stretch =
      std::max(0.25 * (1.0 - cosine * cosine), std::numeric_limits<double>::epsilon());
  const double wider = std::hypot(1.0, 2.0 * noise / stretch);
  covariance.bottomRows<2>() *= wider;
  covariance.rightCols<2>() *= wider;
  RingMatrix information = changes.transpose() * covariance.inverse() * changes;
  information.diagonal().tail<2>().array() += std::pow(tilt_sigma_rad, -2);
  return information.inverse().topLeftCorner<3, 3>();
}

// Reorders the accumulated odds to match this frame's solutions. Near a frontal view the solutions
// merge and their association is lost, so the odds decay.
void PoseEstimator::follow_solutions(const std::array<CirclePose, 2>& poses) {
  if (last_) {
    const auto turn = [&](std::size_t here, std::size_t there) {
      return angle_between(poses[here].normal, (*last_)[there].normal);
    };
    const double same = turn(0, 0) + turn(1, 1);
    const double other = turn(0, 1) + turn(1, 0);
    const bool is_swapped = same > other;
    const double ambiguity = std::min(same, other) / std::max(same, other);
    const double kept = ambiguity < 1.0 ? 1.0 - ambiguity * ambiguity : 0.0;  // or no difference
    is_first_ = is_first_ != is_swapped;
    odds_ *= is_swapped ? -kept : kept;
    inner_.odds *= is_swapped ? -kept : kept;
    inner_.last_deviation *= is_swapped ? -1.0 : 1.0;
    inner_.information *= kept;
  }
  last_ = poses;
}

double PoseEstimator::OddsAverage::add(double frame_odds, double deviation, double separation) {
  const double kept = std::exp(-std::exchange(elapsed_s, 0.0) / kInnerEdgeMemory_s);
  if (information > 0.0) {
    differences += 1.0;
    const double squared = std::min(1.0, 0.5 * std::pow(deviation - last_deviation, 2));
    noise_share += std::max(1.0 / differences, 1.0 - kept) * (squared - noise_share);
  }
  last_deviation = deviation;
  information = kept * information + separation;
  odds += separation / information * (frame_odds - odds);
  const double frames = std::max(1.0, information / separation);
  const double noise = std::min(noise_share, kept);
  return odds / (1.0 - noise + noise / frames);
}

double PoseEstimator::update_odds(const Camera& camera,
                                  const std::array<CirclePose, 2>& poses,
                                  const RingUncertainty& uncertainty,
                                  const PoseEvidence& evidence) {
  const auto& [inner_edges, pattern, gravity] = evidence;
  InnerMisfit misfit;
  for (const FittedEllipse& inner : inner_edges) {
    add_misfit(camera, poses, uncertainty, inner, misfit);
  }
  const double apart = std::sqrt(misfit.separation);
  // Standard deviations from equal likelihood of both solutions.
  const double deviation = 0.5 * (misfit.chi_squared[1] - misfit.chi_squared[0]) / apart;
  const bool has_inner = apart > 0.0 && std::isfinite(deviation);
  const bool has_gravity = gravity.squaredNorm() > 0.0;
  if (!has_inner && !has_gravity && !pattern) return odds_;
  // A pattern learned under a wrong tilt confirms it, so inner edges of this frame come first.
  // Those of earlier frames come last: their solutions may have been confused since.
  double odds = inner_.odds;
  if (has_inner) {
    odds = inner_.add(log_odds(misfit), deviation, misfit.separation);
  } else if (pattern) {
    odds = log_odds(camera, poses, *pattern);
  }
  if (has_gravity) {
    odds += 0.5 * (std::pow(from_level(poses[1], gravity), 2) -
                   std::pow(from_level(poses[0], gravity), 2));
  }
  return odds;
}

std::optional<TargetPose> PoseEstimator::estimate(const Lens& lens,
                                                  const Ellipse& ideal,
                                                  const RingUncertainty& uncertainty,
                                                  const PoseEvidence& evidence,
                                                  double radius_m) {
  const Camera& camera = lens.camera();
  const auto poses = circle_poses(camera, ideal);
  if (!poses) return std::nullopt;
  follow_solutions(*poses);
  const double odds = update_odds(camera, *poses, uncertainty, evidence);
  odds_ = std::isfinite(odds) ? odds : 0.0;
  if (odds_ != 0.0) is_first_ = odds_ > 0.0;  // without evidence, keeps the previous selection
  const CirclePose& chosen = (*poses)[is_first_ ? 0 : 1];
  const CirclePose& other = (*poses)[is_first_ ? 1 : 0];

  TargetPose pose;
  pose.bearing = chosen.position.normalized();
  pose.angles_rad = {std::atan2(pose.bearing.x(), pose.bearing.z()),
                     std::atan2(pose.bearing.y(), pose.bearing.z())};
  const Vector2d centre = projected_centre(camera, chosen);
  const auto shown = lens.picture_from_ideal(centre);
  pose.centre_px = shown ? shown->picture_px : centre;
  pose.normal = chosen.normal;
  pose.other_normal = other.normal;
  pose.certainty = 1.0 / (1.0 + std::exp(-std::abs(odds_)));
  if (radius_m > 0.0) {
    pose.radius_m = radius_m;
    pose.position_m = radius_m * chosen.position;
    pose.other_position_m = radius_m * other.position;
    const double tilt_sigma_rad = evidence.gravity.squaredNorm() > 0.0 ? kLevelRad : 1.0;
    pose.covariance_m2 =
        radius_m * radius_m * position_covariance(camera, chosen, uncertainty, tilt_sigma_rad);
  }
  return pose;
}

}  // namespace ellipse
