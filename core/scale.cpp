// SPDX-License-Identifier: MIT
#include "core/scale.hpp"

#include <algorithm>

namespace ellipse {
namespace {

// Column by column. Sixteen bits hold 128 rows.
void add_rows(const ImageView& luma, int first, int count, std::uint16_t* __restrict sums) {
  const std::uint8_t* __restrict row = luma.row(first);
  for (int x = 0; x < luma.width; ++x) sums[x] = row[x];
  for (int k = 1; k < count; ++k) {
    row = luma.row(first + k);
    for (int x = 0; x < luma.width; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + row[x]);
  }
}

void average(const std::uint16_t* __restrict sums,
             int scale,
             int width,
             std::uint8_t* __restrict out) {
  if (scale == 2) {  // the one that is used most, as vectors
    for (int x = 0; x < width; ++x, sums += 2) {
      out[x] = static_cast<std::uint8_t>((sums[0] + sums[1] + 2) >> 2);
    }
    return;
  }
  const int pixels = scale * scale;
  for (int x = 0; x < width; ++x, sums += scale) {
    int sum = pixels / 2;
    for (int k = 0; k < scale; ++k) sum += sums[k];
    out[x] = static_cast<std::uint8_t>(sum / pixels);
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
    add_rows(luma, y * scale, scale, sums_.data());
    average(sums_.data(), scale, width, reduced_.data() + static_cast<std::ptrdiff_t>(y) * width);
  }
  return {reduced_.data(), width, height, width};
}

Ellipse to_frame(const Ellipse& in_region, const Rect& region, int scale) {
  return translated(scaled(in_region, scale), region.x, region.y);
}

Ellipse to_region(const Ellipse& in_frame, const Rect& region, int scale) {
  return scaled(translated(in_frame, -region.x, -region.y), 1.0 / scale);
}

int next_scale(int scale, int max_scale, double size_px, double min_size_px, double max_size_px) {
  if (size_px > max_size_px && 2 * scale <= max_scale) return 2 * scale;
  if (size_px < min_size_px && scale > 1) return scale / 2;
  return scale;
}

}  // namespace ellipse
