#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>

#include "core/edges/gradient_map.hpp"

namespace ellipse {

/// Which side of an outline is dark: the same side everywhere, or different sides on parts of the
/// outline, as on a shaded ball.
enum class Polarity { kDarkInside = 1, kBrightInside = -1, kMixed = 0 };

[[nodiscard]] constexpr Polarity opposite(Polarity polarity) {
  return static_cast<Polarity>(-static_cast<int>(polarity));
}

/// Sub-pixel position and sharpness of a gradient maximum.
struct SubpixelMaximum {
  float offset_px = 0.0F;  ///< Along the axis, from the pixel's centre.
  float sharpness = 0.0F;  ///< Negative second derivative over the height [1/px^2].
};

/// Variance of the blur of a lens in focus [px^2].
inline constexpr double kLensVariance = 0.36;

/// Variance of a sharp edge's blur, along the edge: of the lens and the 5 x 5 kernels [px^2].
inline constexpr auto kSharpVariance = static_cast<float>(1.0 + kLensVariance);

/// Inward shift of a curved edge by blur along it [px], to first order (own derivation from the
/// mean of a disc's edge over a Gaussian).
/// @param variance   [px^2]
/// @param curvature  [1/px]
[[nodiscard]] constexpr float inward_shift(float variance, float curvature) {
  return 0.5F * variance * curvature;
}

/// Vertex of the parabola through three values at -1, 0 and 1, if it has one.
template <class Number>
[[nodiscard]] Number parabola_vertex(Number before, Number middle, Number after) {
  return Number(0.5) * (before - after) / (before - Number(2) * middle + after);
}

/// The vertex of the parabola through three pixels along the axis closest to the gradient
/// [Devernay1995] 2. Projects the neighbours' gradients on the middle one.
/// @param here  The middle gradient in a map; its neighbours are `step` before and after.
[[nodiscard]] inline SubpixelMaximum subpixel_maximum(const Gradient* here, int step) {
  const float gx = here->x;
  const float gy = here->y;
  const float before = here[-step].x * gx + here[-step].y * gy;
  const float height = gx * gx + gy * gy;
  const float after = here[step].x * gx + here[step].y * gy;
  const float curvature = before - 2.0F * height + after;
  const float offset = curvature < 0.0F ? parabola_vertex(before, height, after) : 0.0F;
  return {std::clamp(offset, -0.5F, 0.5F), height > 0.0F ? -curvature / height : 0.0F};
}

/// The same as an offset from the pixel's centre [px].
/// @param stride  Of the map.
[[nodiscard]] inline Eigen::Vector2d subpixel_offset(const Gradient* here, int stride) {
  const bool is_along_row = std::abs(here->x) > std::abs(here->y);
  const double offset_px = subpixel_maximum(here, is_along_row ? 1 : stride).offset_px;
  return is_along_row ? Eigen::Vector2d(offset_px, 0.0) : Eigen::Vector2d(0.0, offset_px);
}

}  // namespace ellipse
