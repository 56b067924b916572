#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

#include "core/camera/camera.hpp"

namespace ellipse {

/// A pinhole camera over the pad, whose centre is (0, 0, 0), x and y in its plane, z up; in units
/// of the pad's radius.
struct CameraPose {
  Eigen::Vector3d position{0.0, 0.0, 10.0};
  Eigen::Vector3d looks_at{0.0, 0.0, 0.0};
  double roll_rad = 0.0;  ///< About the optical axis.
};

/// Path of a camera, with the small motions of a flying vehicle. kDash, kShake and kHover have
/// their own periods instead of Flight::period_s.
enum class Path {
  kApproach,  ///< From `highest` down to `lowest` and up again, with lateral drift.
  kOblique,   ///< At 60 degrees from the vertical, from distance `highest` to `lowest` and back.
  kOrbit,     ///< Around the pad once a period, at 45 degrees, at distance `highest`.
  kDash,      ///< Side to side at `lowest`, about once a second: 40 px/frame at 640 px, 30 fps.
  kShake,     ///< Hovering at `lowest` with airframe vibration of 7 to 11 Hz.
  kReenter,   ///< Over the pad and away at `lowest`, until it leaves the picture.
  kHover,     ///< Swaying at `lowest`.
  kAside,     ///< From a given direction, alternating between `highest` and `lowest`.
};

struct Flight {
  Path path = Path::kApproach;
  double period_s = 20.0;
  double highest = 20.0;  ///< Distance from the pad [radii].
  double lowest = 2.6;    ///< Distance from the pad [radii].
  double reach = 1.0;     ///< Factor on the motion of kDash, kShake, kReenter and kAside.
  double begins_s = 0.0;  ///< Time on the path at time 0.
  double tilt_rad = 0.0;  ///< Of kAside: view direction from the vertical, and azimuth.
  double azimuth_rad = 0.0;
  double roll_rad = 0.0;               ///< Of kAside.
  Eigen::Vector3d aim{0.0, 0.0, 0.0};  ///< Of kAside: the point it looks at [radii].
};

/// Camera pose at a time [s]. Deterministic, thread-safe.
[[nodiscard]] CameraPose pose_at(const Flight& flight, double time_s);

/// Homography from the pad's plane to pixels of the camera's ideal plane.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const CameraPose& pose, const Camera& camera);

/// The same for a pinhole. @param hfov_rad  Horizontal field of view.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const CameraPose& pose,
                                             double hfov_rad,
                                             int width,
                                             int height);

}  // namespace ellipse
