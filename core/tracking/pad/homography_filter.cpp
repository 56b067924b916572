// SPDX-License-Identifier: MIT
#include "core/tracking/pad/homography_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kFocalOverWidth = 0.8;  // if no camera is known
constexpr double kTurnNoise = 0.33;   // sigma of the change of the camera's angular velocity in 1 s
constexpr double kShiftNoise = 0.24;  // the same of its velocity and of other changes [radii/s]

// Changes of a view by one-sigma camera motions, one per column.
Eigen::Matrix<double, 8, 6> typical_changes(const Eigen::Matrix3d& image_from_pad,
                                            const Camera& camera) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(kTurnNoise), Eigen::Vector3d::Constant(kShiftNoise);
  return change_by_camera(image_from_pad, camera.matrix()) * sigmas.asDiagonal();
}

}  // namespace

Camera default_camera(const Eigen::Vector2d& frame_px) {
  const int width = std::max(1, static_cast<int>(frame_px.x()));
  const auto height = static_cast<int>(frame_px.y());
  return Camera::with_hfov(2.0 * std::atan(0.5 / kFocalOverWidth), width, height);
}

HomographyCovariance inverse_of(const HomographyCovariance& matrix) {
  return matrix.ldlt().solve(HomographyCovariance::Identity());
}

HomographyCovariance camera_noise(const Eigen::Matrix3d& image_from_pad, const Camera& camera) {
  const auto changes = typical_changes(image_from_pad, camera);
  return changes * changes.transpose();
}

// Attributes the velocity to the most likely camera motion under a Gaussian prior.
HomographyChange carried(const HomographyChange& velocity,
                         const Eigen::Matrix3d& from,
                         const Eigen::Matrix3d& to,
                         const Camera& camera) {
  const auto here = typical_changes(from, camera);
  const auto there = typical_changes(to, camera);
  Eigen::Matrix<double, 6, 6> normal = here.transpose() * here;
  normal.diagonal().array() += kShiftNoise * kShiftNoise;
  const Eigen::Matrix<double, 6, 1> motion = normal.ldlt().solve(here.transpose() * velocity);
  return velocity + (there - here) * motion;
}

HomographyFilter HomographyFilter::after(double elapsed_s,
                                         const HomographyCovariance& noise) const {
  // White acceleration of density q adds q t^3 / 3 to the position's variance. The half below is
  // more conservative; on real footage neither is consistently better.
  const HomographyCovariance added = elapsed_s * noise;
  HomographyFilter next;
  next.velocity = velocity;
  next.covariance = covariance + elapsed_s * (cross_covariance + cross_covariance.transpose()) +
                    elapsed_s * elapsed_s * (velocity_covariance + 0.5 * added);
  next.cross_covariance = cross_covariance + elapsed_s * (velocity_covariance + 0.5 * added);
  next.velocity_covariance = velocity_covariance + added;
  // Changes that no motion of the camera explains.
  next.covariance.diagonal().array() += std::pow(elapsed_s, 3) * kShiftNoise * kShiftNoise;
  return next;
}

HomographyFilter HomographyFilter::corrected(const HomographyEstimate& measured) const {
  const HomographyCovariance gain = cross_covariance.transpose() * inverse_of(covariance);
  HomographyFilter result;
  result.covariance = inverse_of(measured.information);
  result.velocity = velocity + gain * measured.change;
  result.cross_covariance = result.covariance * gain.transpose();
  const HomographyCovariance reduced =
      velocity_covariance - gain * (covariance - result.covariance) * gain.transpose();
  result.velocity_covariance = 0.5 * (reduced + reduced.transpose());
  return result;
}

// In the form of [BucyJoseph1968], because the considered errors [Schmidt1966] change the gain.
RingGain HomographyFilter::correct_by_ring(const RingChange& change,
                                           const RingMatrix& errors,
                                           const HomographyCovariance& considered) {
  const HomographyCovariance total = covariance + considered;
  const RingMatrix inverse =
      (total.topLeftCorner<5, 5>() + errors).ldlt().solve(RingMatrix::Identity());
  const RingGain gain = total.leftCols<5>() * inverse;
  const RingGain velocity_gain = cross_covariance.topRows<5>().transpose() * inverse;
  HomographyCovariance kept = HomographyCovariance::Identity();
  kept.leftCols<5>() -= gain;
  const RingGain errors_of_change = gain * errors;
  const HomographyCovariance learned = velocity_gain * cross_covariance.topRows<5>();

  velocity += velocity_gain * change;
  velocity_covariance +=
      velocity_gain * (covariance.topLeftCorner<5, 5>() + errors) * velocity_gain.transpose() -
      learned - learned.transpose();
  cross_covariance =
      kept * (cross_covariance - covariance.leftCols<5>() * velocity_gain.transpose()) +
      errors_of_change * velocity_gain.transpose();
  covariance = kept * covariance * kept.transpose() + errors_of_change * gain.transpose();
  return gain;
}

void HomographyFilter::fix_rotation() {
  velocity(5) = 0.0;
  for (HomographyCovariance* part : {&covariance, &cross_covariance, &velocity_covariance}) {
    part->row(5).setZero();
    part->col(5).setZero();
  }
}

double centre_sigma(const HomographyCovariance& covariance) {
  const double ring = covariance(0, 0) + covariance(1, 1);
  const double pad =
      ring + covariance(6, 6) + covariance(7, 7) + 2.0 * (covariance(0, 6) + covariance(1, 7));
  return std::sqrt(std::min(ring, pad));
}

}  // namespace ellipse
