#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <span>

namespace ellipse {

struct EdgeMeasurement;

/// Blur of an outline by its motion.
struct MotionBlur {
  /// Length and direction [px]. Zero unless the edges show it by three standard deviations and it
  /// halves the sharpness of those across it.
  Eigen::Vector2f px{0.0F, 0.0F};
  /// Squared length in any direction [px^2]; 0 unless the edges show it by three standard
  /// deviations.
  double squared_length = 0.0;
};

/// Variance of uniform blur over a length, such as that of steady motion.
template <class Number>
[[nodiscard]] constexpr Number uniform_variance(Number squared_length) {
  return squared_length / Number(12);
}

/// Fits the blur of an outline by its motion during the exposure to the sharpness of its edges, by
/// least squares: edges across the motion are less sharp. Allocates nothing; O(edges).
///
/// @param edges      In order around the outline.
/// @param motion_px  Displacement of the outline since the last match [px of the picture]; zero =
///                   unknown. The blur is at most as long.
[[nodiscard]] MotionBlur motion_blur(std::span<const EdgeMeasurement> edges,
                                     const Eigen::Vector2f& motion_px);

}  // namespace ellipse
