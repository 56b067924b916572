#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera.hpp"
#include "core/scene/scene.hpp"
#include "examples/landing/platform.hpp"
#include "examples/landing/vehicle.hpp"

namespace landing {

/// The camera on the vehicle, and the pad that it looks for. A value.
struct Rig {
  ellipse::Camera camera = ellipse::Camera::with_hfov(1.4, 640, 360);
  Eigen::Vector3d place{0.0, 0.0, 0.12};  ///< On the body [m].
  double pitch_rad = 0.0;                 ///< From straight down to forward.
  double pad_radius = 0.75;               ///< [m]

  /// Optical axes (x right, y down, z forward) to the body's. The picture's top is forward.
  [[nodiscard]] Eigen::Matrix3d body_from_camera() const;
};

/// What the camera sees.
[[nodiscard]] ellipse::View view_of(const Rig& rig,
                                    const Motion& vehicle,
                                    const Platform& platform);

/// Down in the camera's frame, where the vehicle believes it to be.
[[nodiscard]] Eigen::Vector3d gravity_of(const Rig& rig, const Motion& vehicle);

/// Where a pad is from the body's origin, in the world's axes [m].
/// @param pad_in_camera  [m]
[[nodiscard]] Eigen::Vector3d pad_from_body(const Rig& rig,
                                            const Motion& vehicle,
                                            const Eigen::Vector3d& pad_in_camera);

}  // namespace landing
