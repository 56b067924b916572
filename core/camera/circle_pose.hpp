#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/homography.hpp"

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

/// Estimates a target's pose frame by frame, and chooses between the two solutions: each predicts
/// where a concentric inner circle appears, and how far from level the target is. Without either,
/// the choice of the frame before is kept.
///
/// One object follows one target, on one thread. Allocates nothing.
class PoseEstimator {
 public:
  /// @param ideal        The target's outer edge, in the ideal plane.
  /// @param uncertainty  Of the outer edge.
  /// @param inner_edges  Measured images of circles inside the outer one and concentric with it, of
  ///                     any radius; in the ideal plane. May be empty.
  /// @param radius_m     0 = not known.
  /// @param gravity      Downwards, in the camera's frame, of any length: the target is level.
  ///                     0 = not known.
  [[nodiscard]] std::optional<TargetPose> estimate(const Lens& lens,
                                                   const Ellipse& ideal,
                                                   const RingUncertainty& uncertainty,
                                                   std::span<const FittedEllipse> inner_edges,
                                                   double radius_m,
                                                   const Eigen::Vector3d& gravity);

  /// Call before another target, or the same one after a gap.
  void forget() { *this = {}; }

 private:
  void follow_solutions(const std::array<CirclePose, 2>& poses);
  [[nodiscard]] double update_odds(const Camera& camera,
                                   const std::array<CirclePose, 2>& poses,
                                   const RingUncertainty& uncertainty,
                                   std::span<const FittedEllipse> inner_edges,
                                   const Eigen::Vector3d& gravity);

  // The mean of the frames' log odds by inner edges, weighted by information. Averaging reduces
  // only the part of their error that differs from frame to frame, which is measured by successive
  // differences [VonNeumann1941]: a repeated frame is no further evidence.
  struct OddsAverage {
    double odds = 0.0;         // the mean
    double information = 0.0;  // sum of the frames' squared separations
    double noise_share = 0.0;  // of the variance, that differs from frame to frame
    double differences = 0.0;  // number of those that it was measured by
    double last_deviation = 0.0;

    // The log odds by all frames so far, with one more in which the solutions are separation^(1/2)
    // standard deviations apart.
    double add(double frame_odds, double deviation, double separation);
  };

  // Log odds of the first solution against the second, in the order of the last frame.
  double odds_ = 0.0;  // by all evidence
  OddsAverage inner_;  // by inner edges alone
  std::optional<std::array<CirclePose, 2>> last_;
};

}  // namespace ellipse
