// SPDX-License-Identifier: MIT
#include "core/edges/noise.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "core/edges/gradient_map.hpp"

namespace ellipse {
namespace {

// Sums of one row.
struct RowSums {
  int differences = 0;
  int samples = 0;
};

// Second differences along both axes at every other pixel. Has no branches, so that the compiler
// vectorizes it.
RowSums add_row(const std::uint8_t* above,
                const std::uint8_t* here,
                const std::uint8_t* below,
                int count) {
  RowSums sums;
  for (int i = 0; i < count; ++i) {
    const int x = 2 * i + 1;
    const int column = above[x] - 2 * here[x] + below[x];
    const int left = above[x - 1] - 2 * here[x - 1] + below[x - 1];
    const int right = above[x + 1] - 2 * here[x + 1] + below[x + 1];
    const int counts = is_saturated(here[x]) ? 0 : 1;
    sums.differences += counts * std::abs(left - 2 * column + right);
    sums.samples += counts;
  }
  return sums;
}

}  // namespace

double pixel_noise(const ImageView& luma) {
  std::int64_t sum = 0;
  int samples = 0;
  int all = 0;
  const int step = std::max(1, luma.height / kNoiseRows);
  const int border = GradientMap::kBorder;
  const int first = border - 2;  // column left of the first sample
  const int count = std::max(0, luma.width - 2 * border + 3) / 2;
  for (int y = border; y < luma.height - border; y += step) {
    const RowSums row =
        add_row(luma.row(y - 1) + first, luma.row(y) + first, luma.row(y + 1) + first, count);
    sum += row.differences;
    samples += row.samples;
    all += count;
  }
  // The mean of |N(0, s)| is s sqrt(2 / pi); the mask has the norm 6 [Immerkaer1996].
  const double mean = static_cast<double>(sum) / std::max(1, noise_samples(samples, all));
  return std::max(std::sqrt(0.5 * std::numbers::pi) / 6.0 * mean, 1.0 / std::sqrt(12.0));
}

}  // namespace ellipse
