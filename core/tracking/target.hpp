#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>

#include "core/camera/circle_pose.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

enum class TargetState {
  kDetected,   ///< Found without a prior.
  kTracked,    ///< Found near its last position.
  kPredicted,  ///< Its matched edges do not determine its position, which is extrapolated.
};

/// The target in one frame.
struct Target {
  Ellipse ellipse;       ///< The outer edge [px], undistorted if the lens has distortion.
  std::uint64_t id = 0;  ///< From 1; constant until the target is lost.
  TargetState state = TargetState::kDetected;
  /// [Keipour2021] Eq. (1). With edge tracking: matched share of the pad's visible edges, inner
  /// ones included.
  double contour_overlap = 0.0;
  /// [Keipour2021] Eq. (2). With edge tracking: matched share of the visible outer edge.
  double ellipse_overlap = 0.0;
  /// Probability of being an ellipse: with edge tracking, from all frames so far; else from the
  /// detector in this frame, 1 if it gives none.
  double probability = 1.0;
  double visible_fraction = 0.0;     ///< Share of the perimeter inside the frame.
  int scale = 1;                     ///< Frame scale of the detection.
  Rect search_region;                ///< Region that was searched [px].
  std::int64_t pts_ns = 0;           ///< Time stamp of the frame.
  RingUncertainty uncertainty = {};  ///< Of the ellipse.
  /// Of centre x and y, semi-major and semi-minor axis [px], angle [rad]: parameter_covariance().
  RingMatrix covariance = RingMatrix::Zero();
  std::optional<TargetPose> pose = {};  ///< Only if a camera is known.
};

}  // namespace ellipse
