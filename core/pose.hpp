#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/camera.hpp"
#include "core/homography.hpp"

namespace ellipse {

// Frame of reference: the camera's, x right, y down, z forward (REP 103's optical frame).

/// A circle in space. Lengths in radii of the circle.
struct CirclePose {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  ///< Of its centre.
  Eigen::Vector3d normal{0.0, 0.0, 0.0};    ///< Unit, on the side that the camera sees.
};

/// The two circles that have this ellipse as their picture, in closed form [KanataniLiu1993]. Seen
/// straight on they are the same one.
///
/// @param ideal  In the ideal plane [px].
/// nullopt where it is no picture of a circle in front of the camera. Thread-safe, allocates
/// nothing.
[[nodiscard]] std::optional<std::array<CirclePose, 2>> circle_poses(const Camera& camera,
                                                                    const Ellipse& ideal);

/// Where the camera sees a circle's centre, which is not the ellipse's [px of the ideal plane].
[[nodiscard]] Eigen::Vector2d projected_centre(const Camera& camera, const CirclePose& pose);

/// The view of the circle's plane; unit: its radius.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Camera& camera, const CirclePose& pose);

/// Covariance of a circle's position [radii^2], from how well its picture is known. Its tilt is
/// taken for no better known than the second order of a circle seen straight on allows.
[[nodiscard]] Eigen::Matrix3d position_covariance(const Camera& camera,
                                                  const CirclePose& pose,
                                                  const RingUncertainty& picture);

/// What is known of the target in space.
struct TargetPose {
  Eigen::Vector3d bearing{0.0, 0.0, 1.0};        ///< Unit, towards the circle's centre.
  Eigen::Vector2d angles_rad{0.0, 0.0};          ///< Of the bearing to the right and downwards.
  Eigen::Vector2d centre_px{0.0, 0.0};           ///< The circle's centre in the picture.
  Eigen::Vector3d normal{0.0, 0.0, -1.0};        ///< Unit, towards the camera.
  Eigen::Vector3d other_normal{0.0, 0.0, -1.0};  ///< Of the circle with the same picture.
  double certainty = 0.5;  ///< Probability that the first of the two is the right one.
  double radius_m = 0.0;   ///< 0 = not known; then so are those below.
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d other_position_m{0.0, 0.0, 0.0};
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< Of the position.
};

/// What the inner edges of a target tell of its tilt.
struct TiltEvidence {
  Eigen::Matrix3d view;        ///< Of the pad's plane, in the ideal plane.
  Eigen::Matrix2d covariance;  ///< Of PoseChange's B.
};

/// Tells a target's pose frame by frame: chooses between the two solutions by where the inner
/// edges put the centre, by the direction of gravity, and by the solution that was right before.
/// One object follows one target, on one thread. Allocates nothing.
class PoseEstimator {
 public:
  /// @param ideal      The target's outer edge, in the ideal plane.
  /// @param picture    How well it is known.
  /// @param evidence   Where there are inner edges.
  /// @param radius_m   0 = not known.
  /// @param gravity    Downwards, in the camera's frame, of any length: the target is level. 0 =
  /// not
  ///                   known.
  [[nodiscard]] std::optional<TargetPose> estimate(const Lens& lens,
                                                   const Ellipse& ideal,
                                                   const RingUncertainty& picture,
                                                   const std::optional<TiltEvidence>& evidence,
                                                   double radius_m,
                                                   const Eigen::Vector3d& gravity);

  /// Another target, or the same after a gap.
  void forget() { was_known_ = false; }

 private:
  [[nodiscard]] double carried_odds(const std::array<CirclePose, 2>& poses) const;

  bool was_known_ = false;
  double odds_ = 0.0;  // of the last normal against the other one, logarithm
  Eigen::Vector3d last_normal_{0.0, 0.0, -1.0};
  Eigen::Vector3d last_other_{0.0, 0.0, -1.0};
};

}  // namespace ellipse
