#pragma once  // SPDX-License-Identifier: MIT

#include <cmath>
#include <cstddef>
#include <span>

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

}  // namespace ellipse
