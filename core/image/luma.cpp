// SPDX-License-Identifier: MIT
#include "core/image/luma.hpp"

#include <algorithm>

namespace ellipse {
namespace {

void copy_luma_row(const std::uint8_t* in, int pixel_stride, int width, std::uint8_t* out) {
  for (int x = 0; x < width; ++x) out[x] = in[std::ptrdiff_t{x} * pixel_stride];
}

// [BT601] 2.5.1: E'Y = 0.299 E'R + 0.587 E'G + 0.114 E'B, here in 1/256.
template <int kPixelStride>
void convert_rgb_row(const std::uint8_t* in,
                     const PixelLayout& layout,
                     int width,
                     std::uint8_t* out) {
  const int red = layout.red;
  const int green = layout.green;
  const int blue = layout.blue;
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* p = in + std::ptrdiff_t{x} * kPixelStride;
    out[x] = static_cast<std::uint8_t>((77 * p[red] + 150 * p[green] + 29 * p[blue] + 128) >> 8);
  }
}

void convert_row(const std::uint8_t* in, const PixelLayout& layout, int width, std::uint8_t* out) {
  if (layout.kind == PixelLayout::Kind::kLuma) {
    copy_luma_row(in + layout.luma, layout.pixel_stride, width, out);
  } else if (layout.pixel_stride == 3) {
    convert_rgb_row<3>(in, layout, width, out);
  } else {
    convert_rgb_row<4>(in, layout, width, out);
  }
}

}  // namespace

ImageView LumaReader::read(const PixelView& picture, const Rect& region) {
  const Rect inside = intersect(region, picture.bounds());
  if (inside.empty()) return {};
  const PixelLayout& layout = picture.layout;
  const auto row = [&](int y) {
    return picture.data + (inside.y + y) * picture.stride +
           std::ptrdiff_t{inside.x} * layout.pixel_stride;
  };
  if (layout.is_plain_luma() && picture.stride >= 0) {
    return {row(0) + layout.luma, inside.width, inside.height, picture.stride};
  }

  const auto pixels = static_cast<std::size_t>(inside.width) * inside.height;
  if (buffer_.size() < pixels) buffer_.resize(pixels);
  for (int y = 0; y < inside.height; ++y) {
    convert_row(row(y), layout, inside.width, buffer_.data() + std::ptrdiff_t{y} * inside.width);
  }
  return {buffer_.data(), inside.width, inside.height, inside.width};
}

}  // namespace ellipse
