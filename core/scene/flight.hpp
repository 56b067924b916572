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

/// How a camera moves. All paths are periodic, and have the small motions of a flying vehicle.
enum class Path {
  kApproach,  ///< From `highest` down to `lowest`, drifting in from aside, and up again.
  kOblique,   ///< At 60 degrees from the vertical, from `highest` to `lowest` away and back.
  kOrbit,     ///< Around the pad once a period, at 45 degrees, `highest` away.
  kDash,      ///< To and fro at `lowest`, once a second: 40 px a frame at 640 px and 30 a second.
  kShake,     ///< Hovering at `lowest` with an airframe that trembles at 7 to 11 Hz.
  kReenter,   ///< Over the pad and away from it, out of the picture's sides, at `lowest`.
  kHover,     ///< Swaying at `lowest`.
  kAside,     ///< From a direction of its own, at `highest` and `lowest` by turns.
};

struct Flight {
  Path path = Path::kApproach;
  double period_s = 20.0;
  double highest = 20.0;  ///< Distance from the pad [radii].
  double lowest = 2.6;    ///< Distance from the pad [radii].
  double reach = 1.0;     ///< Of kDash, kShake, kReenter and kAside: so many times as far aside.
  double begins_s = 0.0;  ///< Where on the path it is at time 0.
  double tilt_rad = 0.0;  ///< Of kAside: from the vertical, and from where.
  double azimuth_rad = 0.0;
  double roll_rad = 0.0;               ///< Of kAside.
  Eigen::Vector3d aim{0.0, 0.0, 0.0};  ///< Of kAside: what it looks at [radii].
};

/// Where the camera is at a time [s]. Deterministic, thread-safe.
[[nodiscard]] CameraPose pose_at(const Flight& flight, double time_s);

/// From the pad's plane to pixels of the camera's ideal plane.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const CameraPose& pose, const Camera& camera);

/// The same for a pinhole. @param hfov_rad  Horizontal field of view.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const CameraPose& pose,
                                             double hfov_rad,
                                             int width,
                                             int height);

}  // namespace ellipse
