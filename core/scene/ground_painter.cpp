// SPDX-License-Identifier: MIT
#include "core/scene/ground_painter.hpp"

#include <cmath>
#include <vector>

namespace ellipse {
namespace {

float smooth(float t) {
  return t * t * (3.0F - 2.0F * t);
}

}  // namespace

void add_noise(cv::Mat& tile, int cells, float amplitude, std::uint64_t seed) {
  const auto corner = [&](int x, int y) {
    const auto index = static_cast<std::uint64_t>(y % cells) * static_cast<std::uint64_t>(cells) +
                       static_cast<std::uint64_t>(x % cells);
    return static_cast<float>(hash(seed + index) >> 40U) / static_cast<float>(1U << 23U) - 1.0F;
  };
  const auto count = static_cast<std::size_t>(cells) + 1;
  std::vector<float> upper(count);
  std::vector<float> lower(count);
  std::vector<float> between(count);
  const float step = static_cast<float>(cells) / static_cast<float>(tile.cols);
  for (int y = 0, last = -1; y < tile.rows; ++y) {
    auto* row = tile.ptr<float>(y);
    const float fy = static_cast<float>(y) * step;
    const int iy = static_cast<int>(fy);
    for (std::size_t i = 0; i < count && iy != last; ++i) {
      upper[i] = corner(static_cast<int>(i), iy);
      lower[i] = corner(static_cast<int>(i), iy + 1);
    }
    last = iy;
    const float v = smooth(fy - static_cast<float>(iy));
    for (std::size_t i = 0; i < count; ++i) between[i] = std::lerp(upper[i], lower[i], v);
    for (int x = 0; x < tile.cols; ++x) {
      const float fx = static_cast<float>(x) * step;
      const auto ix = static_cast<std::size_t>(fx);
      const float u = smooth(fx - static_cast<float>(ix));
      row[x] += amplitude * std::lerp(between[ix], between[ix + 1], u);
    }
  }
}

}  // namespace ellipse
