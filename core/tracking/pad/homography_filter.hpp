#pragma once  // SPDX-License-Identifier: MIT

#include "core/camera/camera.hpp"
#include "core/geometry/homography.hpp"
#include "core/tracking/pad/homography_solver.hpp"

namespace ellipse {

/// The camera assumed if none is known: a pinhole of typical focal length.
[[nodiscard]] Camera default_camera(const Eigen::Vector2d& frame_px);

/// Transports a homography velocity to another view, assuming constant camera motion.
/// @param velocity  Change of the view `from` per second. The part that camera motion does not
///                  explain is kept.
[[nodiscard]] HomographyChange carried(const HomographyChange& velocity,
                                       const Eigen::Matrix3d& from,
                                       const Eigen::Matrix3d& to,
                                       const Camera& camera);

/// Change of the whole view per change of the outer circle.
using RingGain = Eigen::Matrix<double, 8, 5>;

/// Kalman filter [Kalman1960] of a moving view. The state is the view's change and its velocity,
/// the change per second. A value.
struct HomographyFilter {
  HomographyChange velocity = HomographyChange::Zero();            ///< Per second.
  HomographyCovariance covariance = HomographyCovariance::Zero();  ///< Of the change.
  HomographyCovariance cross_covariance =
      HomographyCovariance::Zero();  ///< Of the change and the velocity.
  HomographyCovariance velocity_covariance = HomographyCovariance::Zero();

  /// Predicts at constant velocity plus noise.
  /// @param noise  Growth of the velocity's covariance per second.
  [[nodiscard]] HomographyFilter after(double elapsed_s, const HomographyCovariance& noise) const;

  /// Updates with a measurement of the view; the cross-covariance corrects the velocity.
  /// @param measured  Posterior change from the prediction: the prior is already included.
  [[nodiscard]] HomographyFilter corrected(const HomographyEstimate& measured) const;

  /// Updates with a measurement of the outer circle whose errors are independent of the filter's.
  /// @param change      T, S and E from the view to the measured circle.
  /// @param errors      Covariance of the measurement.
  /// @param considered  Covariance of the view due to model errors. It is not part of `covariance`,
  ///                    before or after the update [Schmidt1966].
  /// @return The gain: times `change`, the correction of the view.
  [[nodiscard]] RingGain correct_by_ring(const RingChange& change,
                                         const RingMatrix& errors,
                                         const HomographyCovariance& considered);

  /// Fixes the rotation about the pad's normal, which rings do not determine.
  void fix_rotation();
};

/// Not defined for a singular matrix.
[[nodiscard]] HomographyCovariance inverse_of(const HomographyCovariance& matrix);

/// Growth of the velocity's covariance per second under random camera motion.
[[nodiscard]] HomographyCovariance camera_noise(const Eigen::Matrix3d& image_from_pad,
                                                const Camera& camera);

/// Standard deviation of the centre of the pad or of its outer circle, whichever is smaller
/// [radii]. Rings alone do not determine the first, nor the pattern the second.
[[nodiscard]] double centre_sigma(const HomographyCovariance& covariance);

}  // namespace ellipse
