#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera.hpp"
#include "core/scene/scene.hpp"
#include "examples/landing/platform.hpp"
#include "examples/landing/vehicle.hpp"

namespace landing {

/// The camera on the vehicle and the size of the pad. Value type.
struct Rig {
  ellipse::Camera camera = ellipse::Camera::with_hfov(1.4, 640, 360);
  Eigen::Vector3d position{0.0, 0.0, 0.12};  ///< Position on the body [m].
  double pitch_rad = 0.0;                    ///< From straight down towards forward.
  double pad_radius = 0.75;                  ///< [m]

  /// Rotation from optical axes (x right, y down, z forward) to body axes. The picture's top is
  /// forward.
  [[nodiscard]] Eigen::Matrix3d body_from_camera() const;
};

/// The camera's view of the scene.
[[nodiscard]] ellipse::View view_of(const Rig& rig,
                                    const Motion& vehicle,
                                    const Platform& platform);

/// The direction of gravity in the camera frame, from the vehicle's estimated attitude.
[[nodiscard]] Eigen::Vector3d gravity_of(const Rig& rig, const Motion& vehicle);

/// The vector from the body's origin to the pad, in world axes [m].
/// @param pad_in_camera  [m]
[[nodiscard]] Eigen::Vector3d pad_from_body(const Rig& rig,
                                            const Motion& vehicle,
                                            const Eigen::Vector3d& pad_in_camera);

/// Standard deviations of that vector's coordinates [m].
/// @param covariance  Of the position in the camera frame [m^2].
[[nodiscard]] Eigen::Vector3d errors_from_body(const Rig& rig,
                                               const Motion& vehicle,
                                               const Eigen::Matrix3d& covariance);

}  // namespace landing
