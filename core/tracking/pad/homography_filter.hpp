#pragma once  // SPDX-License-Identifier: MIT

#include "core/camera/camera.hpp"
#include "core/geometry/homography.hpp"
#include "core/tracking/pad/homography_solver.hpp"

namespace ellipse {

/// The camera that is assumed where none is known: a pinhole of usual focal length.
[[nodiscard]] Camera usual_camera(const Eigen::Vector2d& frame_px);

/// Transports a velocity to another view, assuming that the camera moves evenly: the image of a pad
/// that leaves the frame stretches faster and faster all the same.
/// @param velocity  As change of the view `from` per frame. The part that no motion of a camera
///                  explains stays as it is.
/// Parameters as for camera_noise().
[[nodiscard]] HomographyChange carried(const HomographyChange& velocity,
                                       const Eigen::Matrix3d& from,
                                       const Eigen::Matrix3d& to,
                                       const Camera& camera,
                                       double turn_rad,
                                       double shift);

/// What is known of a view that moves: how certain it is, and its velocity. A Kalman filter
/// [Kalman1960] whose state is the view's change and that change per frame. A value.
struct HomographyFilter {
  HomographyChange velocity = HomographyChange::Zero();  ///< Per frame.
  HomographyCovariance pose = HomographyCovariance::Zero();
  HomographyCovariance homography_velocity =
      HomographyCovariance::Zero();  ///< Covariance of the two.
  HomographyCovariance velocity_variance = HomographyCovariance::Zero();

  /// Some frames later, at the same velocity but for the noise.
  [[nodiscard]] HomographyFilter after(double frames,
                                       const HomographyCovariance& noise_per_frame) const;

  /// After a measurement: what tells the pose tells the velocity as well.
  /// @param measured  The change from the prediction, with what was known before in it.
  [[nodiscard]] HomographyFilter corrected(const HomographyEstimate& measured) const;

  /// The same, where nothing tells how the pad is turned about its centre.
  void leave_turn_open();

  /// Standard deviation of the pad's centre, as far as the edges tell it [radii].
  [[nodiscard]] double centre_sigma() const;
};

[[nodiscard]] HomographyCovariance inverse_of(const HomographyCovariance& matrix);

/// How a view changes from frame to frame under a camera that turns and shifts at random.
/// @param turn_rad  Standard deviation about each axis.
/// @param shift     And along each [radii of the pad]; less along the optical axis.
[[nodiscard]] HomographyCovariance camera_noise(const Eigen::Matrix3d& image_from_pad,
                                                const Camera& camera,
                                                double turn_rad,
                                                double shift);

}  // namespace ellipse
