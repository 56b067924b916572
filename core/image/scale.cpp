// SPDX-License-Identifier: MIT
#include "core/image/scale.hpp"

#include <algorithm>
#include <cstring>

#include "core/image/simd.hpp"

namespace ellipse {
namespace {

// Sums the rows of each column. Sixteen bits hold 128 rows.
void add_rows(const ImageView& luma, int first, int count, std::uint16_t* __restrict sums) {
  const std::uint8_t* __restrict row = luma.row(first);
  for (int x = 0; x < luma.width; ++x) sums[x] = row[x];
  for (int k = 1; k < count; ++k) {
    row = luma.row(first + k);
    for (int x = 0; x < luma.width; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + row[x]);
  }
}

ELLIPSE_INLINE void average(const std::uint16_t* __restrict sums,
                            unsigned scale,
                            int width,
                            std::uint8_t* __restrict out) {
  const unsigned pixels = scale * scale;
  for (int x = 0; x < width; ++x, sums += scale) {
    unsigned sum = pixels / 2;
    for (unsigned k = 0; k < scale; ++k) sum += sums[k];
    out[x] = static_cast<std::uint8_t>(sum / pixels);
  }
}

void halve(const std::uint8_t* __restrict upper,
           const std::uint8_t* __restrict lower,
           int width,
           std::uint8_t* __restrict out) {
  for (int x = 0; x < width; ++x) {
    std::uint16_t a = 0;  // two pixels
    std::uint16_t b = 0;
    std::memcpy(&a, upper + std::ptrdiff_t(2) * x, sizeof a);
    std::memcpy(&b, lower + std::ptrdiff_t(2) * x, sizeof b);
    const auto sum = static_cast<std::uint16_t>((a & 0xff) + (a >> 8) + (b & 0xff) + (b >> 8) + 2);
    out[x] = static_cast<std::uint8_t>(sum >> 2);
  }
}

}  // namespace

ImageView Scaler::reduce(const ImageView& luma, int scale) {
  if (scale <= 1) return luma;
  const int width = luma.width / scale;
  const int height = luma.height / scale;
  if (width == 0 || height == 0) return {};
  reduced_.resize(std::max(reduced_.size(), static_cast<std::size_t>(width) * height));
  sums_.resize(std::max(sums_.size(), static_cast<std::size_t>(luma.width)));
  for (int y = 0; y < height; ++y) {
    std::uint8_t* out = reduced_.data() + static_cast<std::ptrdiff_t>(y) * width;
    if (scale == 2) {
      halve(luma.row(2 * y), luma.row(2 * y + 1), width, out);
    } else {
      add_rows(luma, y * scale, scale, sums_.data());
      if (scale == 4) {  // specialized at compile time, as scale 2
        average(sums_.data(), 4, width, out);
      } else {
        average(sums_.data(), static_cast<unsigned>(scale), width, out);
      }
    }
  }
  return {reduced_.data(), width, height, width};
}

Ellipse to_frame(const Ellipse& in_region, const Rect& region, int scale) {
  return translated(scaled(in_region, scale), region.x, region.y);
}

Ellipse to_region(const Ellipse& in_frame, const Rect& region, int scale) {
  return scaled(translated(in_frame, -region.x, -region.y), 1.0 / scale);
}

}  // namespace ellipse
