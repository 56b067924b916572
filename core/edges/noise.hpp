#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/image/image_view.hpp"

namespace ellipse {

/// Quantile of a picture's gradient magnitudes that shows the noise: low enough to exclude edges.
inline constexpr double kNoiseQuantile = 0.3;

/// Bin of that quantile in a histogram of magnitudes, whose last bin collects all larger ones; 0
/// without samples.
[[nodiscard]] inline std::size_t noise_bin(std::span<const int> histogram, int samples) {
  if (samples == 0) return 0;
  std::size_t bin = 0;
  for (int below = histogram[0]; below <= kNoiseQuantile * samples && bin + 1 < histogram.size();) {
    below += histogram[++bin];
  }
  return bin;
}

/// Standard deviation of the gradient's components from that quantile: the magnitudes of noise are
/// Rayleigh distributed, with the quantile q at sigma sqrt(-2 ln(1 - q)) [Rosin1997].
[[nodiscard]] inline double noise_of(double quantile) {
  return quantile / std::sqrt(-2.0 * std::log(1.0 - kNoiseQuantile));
}

/// Multiple of sigma that is unlikely to be noise: 2 % of normal errors are above it.
inline constexpr double kUnlikelySigmas = 2.0;

/// Multiple of sigma that contains normal errors: .1 % are above it.
inline constexpr double kAllSigmas = 3.0;

/// Approximate number of rows that estimates of noise sample.
inline constexpr int kNoiseRows = 16;

/// Whether clipping hides the noise of a pixel.
[[nodiscard]] inline bool is_saturated(std::uint8_t level) {
  return level < 2 || level > 253;
}

/// Number of samples without saturation, raised to the quantile's share of all. In a picture of
/// black and white most of the others are edges; then saturated samples count as free of noise.
[[nodiscard]] inline int noise_samples(int unsaturated, int all) {
  return std::max(unsaturated, static_cast<int>(kNoiseQuantile * all));
}

/// Standard deviation of the pixels' noise [grey levels], from second differences
/// [Immerkaer1996]: zero on planes and on straight edges along an axis. At least that of rounding
/// to grey levels. O(width).
[[nodiscard]] double pixel_noise(const ImageView& luma);

}  // namespace ellipse
