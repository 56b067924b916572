// SPDX-License-Identifier: MIT
#include "core/scene/ground_painter.hpp"

#include <cmath>

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
  const float step = static_cast<float>(cells) / static_cast<float>(tile.cols);
  for (int y = 0; y < tile.rows; ++y) {
    auto* row = tile.ptr<float>(y);
    const float fy = static_cast<float>(y) * step;
    const int iy = static_cast<int>(fy);
    const float v = smooth(fy - static_cast<float>(iy));
    float left = 0.0F;
    float right = 0.0F;
    for (int x = 0, last = -1; x < tile.cols; ++x) {
      const float fx = static_cast<float>(x) * step;
      const int ix = static_cast<int>(fx);
      if (ix != last) {
        left = std::lerp(corner(ix, iy), corner(ix, iy + 1), v);
        right = std::lerp(corner(ix + 1, iy), corner(ix + 1, iy + 1), v);
        last = ix;
      }
      row[x] += amplitude * std::lerp(left, right, smooth(fx - static_cast<float>(ix)));
    }
  }
}

}  // namespace ellipse
