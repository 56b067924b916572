#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/homography.hpp"

namespace ellipse {

// Frame of reference: the camera's optical frame of REP 103, x right, y down, z forward.

/// A circle in space. Lengths in radii of the circle.
struct CirclePose {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  ///< Of its centre.
  Eigen::Vector3d normal{0.0, 0.0, 0.0};    ///< Unit, on the side facing the camera.
};

/// The two circles that project to this ellipse, in closed form [KanataniLiu1993]. They coincide in
/// a frontal view.
///
/// @param ideal  In the ideal plane [px].
/// @return nullopt if no circle in front of the camera projects to it. Thread-safe, allocates
///         nothing.
[[nodiscard]] std::optional<std::array<CirclePose, 2>> circle_poses(const Camera& camera,
                                                                    const Ellipse& ideal);

/// Projection of a circle's centre [px of the ideal plane]; differs from the ellipse's centre.
[[nodiscard]] Eigen::Vector2d projected_centre(const Camera& camera, const CirclePose& pose);

/// Homography from the circle's plane to the ideal plane; unit: the circle's radius.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Camera& camera, const CirclePose& pose);

/// The view of the same outer circle, tilted to the nearer of the circle's two poses; the view
/// itself if there is none. Thread-safe, allocates nothing.
[[nodiscard]] Eigen::Matrix3d with_nearer_pose(const Camera& camera,
                                               const Eigen::Matrix3d& image_from_pad);

/// Covariance of a circle's position [radii^2], from the uncertainty of its image. Wider near a
/// frontal view, where the ellipse determines the tilt to second order only.
///
/// @param tilt_sigma_rad  Prior standard deviation of the tilt.
[[nodiscard]] Eigen::Matrix3d position_covariance(const Camera& camera,
                                                  const CirclePose& pose,
                                                  const RingUncertainty& image,
                                                  double tilt_sigma_rad = 1.0);

/// The target's pose in the camera frame.
struct TargetPose {
  Eigen::Vector3d bearing{0.0, 0.0, 1.0};        ///< Unit, towards the circle's centre.
  Eigen::Vector2d angles_rad{0.0, 0.0};          ///< Of the bearing, to the right and downwards.
  Eigen::Vector2d centre_px{0.0, 0.0};           ///< The circle's centre in the picture.
  Eigen::Vector3d normal{0.0, 0.0, -1.0};        ///< Unit, towards the camera.
  Eigen::Vector3d other_normal{0.0, 0.0, -1.0};  ///< Of the other circle with the same image.
  double certainty = 0.5;  ///< Probability that `normal` is the right one of the two.
  double radius_m = 0.0;   ///< 0 = unknown; then so are the fields below.
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d other_position_m{0.0, 0.0, 0.0};
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< Of the position.
};

/// A target's view, known from the pattern inside its outer edge.
struct PatternView {
  Eigen::Matrix3d image_from_pad = Eigen::Matrix3d::Identity();  ///< Into the ideal plane.
  Eigen::Matrix2d centre_covariance =
      Eigen::Matrix2d::Identity();  ///< Of the centre, relative to the outer edge [radii^2].
};

/// Evidence that selects one of the two solutions of a target's pose. Each part is optional.
struct PoseEvidence {
  std::span<const FittedEllipse> inner_edges =
      {};  ///< Measured images of concentric circles inside
           ///< the outer one, of any radius; ideal plane.
  std::optional<PatternView> pattern = std::nullopt;
  Eigen::Vector3d gravity{0.0, 0.0, 0.0};  ///< Downwards in the camera frame, of any length, of a
                                           ///< level target. 0 = unknown.
};

/// Estimates a target's pose in each frame and selects one of the two solutions: each predicts the
/// images of concentric inner circles, the image of the centre, and the target's deviation from
/// level. The pattern counts in frames without inner circles only. Without evidence, keeps the
/// previous selection.
///
/// One object serves one target, on one thread. Allocates nothing.
class PoseEstimator {
 public:
  /// Call once per frame, also without a target.
  /// @param elapsed_s  Since the previous frame.
  void advance(double elapsed_s) { inner_.elapsed_s += elapsed_s; }

  /// @param ideal        The target's outer edge, in the ideal plane.
  /// @param uncertainty  Of the outer edge.
  /// @param radius_m     0 = unknown.
  /// @return nullopt if no circle in front of the camera projects to the ellipse.
  [[nodiscard]] std::optional<TargetPose> estimate(const Lens& lens,
                                                   const Ellipse& ideal,
                                                   const RingUncertainty& uncertainty,
                                                   const PoseEvidence& evidence,
                                                   double radius_m);

  /// Call before a new target.
  void reset() { *this = {}; }

 private:
  void follow_solutions(const std::array<CirclePose, 2>& poses);
  [[nodiscard]] double update_odds(const Camera& camera,
                                   const std::array<CirclePose, 2>& poses,
                                   const RingUncertainty& uncertainty,
                                   const PoseEvidence& evidence);

  // Mean of the frames' log odds from inner edges, weighted by information. Averaging reduces only
  // the error that is independent between frames. Successive differences measure that part
  // [VonNeumann1941]: a repeated frame adds no evidence.
  struct OddsAverage {
    double odds = 0.0;         // the mean
    double information = 0.0;  // sum of the frames' squared separations
    double noise_share = 0.0;  // share of the variance that is independent between frames
    double differences = 0.0;  // number of differences that measured it
    double last_deviation = 0.0;
    double elapsed_s = 0.0;  // since the last frame that was added

    // @param frame_odds  Log odds of the first solution from this frame.
    // @param deviation   Distance of the measurement from equal likelihood [sigma].
    // @param separation  Squared distance of the two predictions [sigma^2].
    // @return Log odds from all frames so far.
    double add(double frame_odds, double deviation, double separation);
  };

  // Log odds of the first solution against the second, in the order of the last frame.
  double odds_ = 0.0;     // from all evidence
  bool is_first_ = true;  // whether the first one is selected
  OddsAverage inner_;     // from inner edges alone
  std::optional<std::array<CirclePose, 2>> last_;
};

}  // namespace ellipse
