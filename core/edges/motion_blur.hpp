#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <span>

#include "core/edges/edge_measurement.hpp"

namespace ellipse {

/// Variance of even blur over a length, such as that of steady motion.
template <class Number>
[[nodiscard]] constexpr Number even_variance(Number squared_length) {
  return squared_length / Number(12);
}

/// Length and direction of the blur of an outline by its motion during the exposure, fitted to the
/// sharpness of its edges by least squares: edges across the motion are less sharp. Zero if the
/// edges do not show such a blur by three standard deviations. Allocates nothing; O(edges).
///
/// @param edges      In order around the outline.
/// @param motion_px  Displacement of the outline during the exposure, or longer [px of the
///                   picture]. The blur is at most as long.
[[nodiscard]] Eigen::Vector2f motion_blur(std::span<const EdgeMeasurement> edges,
                                          const Eigen::Vector2f& motion_px);

}  // namespace ellipse
