#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>

#include "core/camera/circle_pose.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

enum class TargetState {
  kDetected,   ///< Found where nothing was known of it.
  kTracked,    ///< Found around its last place.
  kPredicted,  ///< Not seen in this frame; its motion was continued.
};

/// The target in one frame.
struct Target {
  Ellipse ellipse;       ///< The outer edge [px]; in the ideal plane where the lens is distorted.
  std::uint64_t id = 0;  ///< The same while it is not lost, from 1.
  TargetState state = TargetState::kDetected;
  /// [Keipour2021] Eq. (1). Where edges are followed: share of the pad's edges in view that were
  /// matched, inner ones included.
  double contour_overlap = 0.0;
  /// [Keipour2021] Eq. (2). Where edges are followed: share of the outer edge in view that was
  /// matched.
  double ellipse_overlap = 0.0;
  /// That it is an ellipse: where edges are followed, by all frames so far; else by the detector in
  /// this frame, 1 where it does not say.
  double probability = 1.0;
  double visible_fraction = 0.0;  ///< Share of the perimeter inside the frame.
  int scale = 1;                  ///< Frame scale that it was found at.
  Rect search_region;             ///< Where it was looked for [px].
  std::int64_t pts_ns = 0;        ///< Of its frame.
  std::optional<RingUncertainty> uncertainty =
      {};                               ///< Of the ellipse, while its edges are followed.
  std::optional<TargetPose> pose = {};  ///< Where a camera is known.
};

}  // namespace ellipse
