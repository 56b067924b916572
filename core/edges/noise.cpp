// SPDX-License-Identifier: MIT
#include "core/edges/noise.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "core/edges/gradient_map.hpp"

namespace ellipse {
namespace {

// Along both axes.
int second_difference(const ImageView& luma, int x, int y) {
  const auto along_row = [x](const std::uint8_t* row) {
    return row[x - 1] - 2 * row[x] + row[x + 1];
  };
  return along_row(luma.row(y - 1)) - 2 * along_row(luma.row(y)) + along_row(luma.row(y + 1));
}

}  // namespace

double pixel_noise(const ImageView& luma) {
  std::int64_t sum = 0;
  int samples = 0;
  const int step = std::max(1, luma.height / kNoiseRows);
  const int border = GradientMap::kBorder;
  for (int y = border; y < luma.height - border; y += step) {
    const std::uint8_t* levels = luma.row(y);
    for (int x = border - 1; x < luma.width - border + 1; x += 2) {
      if (is_saturated(levels[x])) continue;
      sum += std::abs(second_difference(luma, x, y));
      ++samples;
    }
  }
  // The mean of |N(0, s)| is s sqrt(2 / pi); the mask has the norm 6 [Immerkaer1996].
  const double mean = static_cast<double>(sum) / std::max(1, samples);
  return std::max(std::sqrt(0.5 * std::numbers::pi) / 6.0 * mean, 1.0 / std::sqrt(12.0));
}

}  // namespace ellipse
