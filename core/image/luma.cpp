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

void read_words(const std::uint8_t* in, const PixelLayout& layout, int width, std::uint8_t* out) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* p = in + std::ptrdiff_t{x} * layout.pixel_stride;
    out[x] = static_cast<std::uint8_t>((p[0] | p[1] << 8) >> layout.shift);
  }
}

// Unpacks a row from column `left` on. `in` is the first byte of the row.
void unpack_row(const std::uint8_t* in, int left, int width, std::uint8_t* out) {
  for (int x = left; x < left + width; ++x) {
    const std::uint8_t* p = in + std::ptrdiff_t{x / 3} * 4;
    const int bit = 10 * (x % 3) + 2;
    const int word = p[bit / 8] | (bit / 8 < 3 ? p[bit / 8 + 1] << 8 : 0);
    *out++ = static_cast<std::uint8_t>(word >> bit % 8);
  }
}

void convert_row(
    const std::uint8_t* row, const PixelLayout& layout, int left, int width, std::uint8_t* out) {
  using Kind = PixelLayout::Kind;
  const std::uint8_t* in = row + std::ptrdiff_t{left} * layout.pixel_stride;
  if (layout.kind == Kind::kPacked) {
    unpack_row(row, left, width, out);
  } else if (layout.kind == Kind::kWord) {
    read_words(in, layout, width, out);
  } else if (layout.kind == Kind::kLuma) {
    copy_luma_row(in + layout.luma, layout.pixel_stride, width, out);
  } else if (layout.pixel_stride == 3) {
    convert_rgb_row<3>(in, layout, width, out);
  } else {
    convert_rgb_row<4>(in, layout, width, out);
  }
}

// Mirrors a row or column index at the border, which keeps its colours in the mosaic.
int mirrored(int at, int size) {
  if (at < 0) return std::min(-at, size - 1);
  return at < size ? at : std::max(2 * (size - 1) - at, 0);
}

// Filters a row of a mosaic by (1 2 1).
void filter_mosaic_row(
    const std::uint8_t* row, int picture_width, int left, int width, std::uint16_t* out) {
  const auto sum_at = [&](int x) {
    return static_cast<std::uint16_t>(row[mirrored(x - 1, picture_width)] + 2 * row[x] +
                                      row[mirrored(x + 1, picture_width)]);
  };
  out[0] = sum_at(left);
  out[width - 1] = sum_at(left + width - 1);
  const std::uint8_t* in = row + left;
  for (int x = 1; x < width - 1; ++x) {
    out[x] = static_cast<std::uint16_t>(in[x - 1] + 2 * in[x] + in[x + 1]);
  }
}

}  // namespace

void LumaReader::begin(const PixelView& picture) {
  picture_ = picture;
  converted_ = {};
}

ImageView LumaReader::read(const Rect& region) {
  const Rect inside = intersect(region, picture_.bounds());
  if (inside.empty()) return {};
  const PixelLayout& layout = picture_.layout;
  if (layout.is_plain_luma() && picture_.stride >= 0 && !picture_.is_slow) {
    return {picture_.data + inside.y * picture_.stride + inside.x + layout.luma,
            inside.width,
            inside.height,
            picture_.stride};
  }

  const auto pixels = static_cast<std::size_t>(picture_.width) * picture_.height;
  if (buffer_.size() < pixels) buffer_.resize(pixels);
  const Rect required = united(converted_, inside);
  const Rect done =
      converted_.empty() ? Rect{required.x, required.y, required.width, 0} : converted_;
  const int bottom = done.y + done.height;
  const int right = done.x + done.width;
  convert({required.x, required.y, required.width, done.y - required.y});
  convert({required.x, done.y, done.x - required.x, done.height});
  convert({right, done.y, required.x + required.width - right, done.height});
  convert({required.x, bottom, required.width, required.y + required.height - bottom});
  converted_ = required;
  return ImageView{buffer_.data(), picture_.width, picture_.height, picture_.width}.region(inside);
}

void LumaReader::convert(const Rect& region) {
  if (region.empty()) return;
  if (picture_.layout.kind == PixelLayout::Kind::kMosaic) {
    convert_mosaic(region);
    return;
  }
  for (int y = region.y; y < region.y + region.height; ++y) {
    convert_row(picture_.data + y * picture_.stride,
                picture_.layout,
                region.x,
                region.width,
                buffer_.data() + std::ptrdiff_t{y} * picture_.width + region.x);
  }
}

// Reads each row once and keeps the last three.
void LumaReader::convert_mosaic(const Rect& region) {
  const auto width = static_cast<std::size_t>(region.width);
  if (mosaic_lines_.size() < 3 * width) mosaic_lines_.resize(3 * width);
  const auto line = [&](int y) {
    return mosaic_lines_.data() + static_cast<std::size_t>(y % 3) * width;
  };
  const auto filter = [&](int y) {
    const std::uint8_t* row = picture_.data + y * picture_.stride;
    filter_mosaic_row(row, picture_.width, region.x, region.width, line(y));
  };
  const int height = picture_.height;
  if (region.y > 0) filter(region.y - 1);
  filter(region.y);
  for (int y = region.y; y < region.y + region.height; ++y) {
    if (y + 1 < height) filter(y + 1);
    const std::uint16_t* above = line(mirrored(y - 1, height));
    const std::uint16_t* centre = line(y);
    const std::uint16_t* below = line(mirrored(y + 1, height));
    std::uint8_t* out = buffer_.data() + std::ptrdiff_t{y} * picture_.width + region.x;
    for (int x = 0; x < region.width; ++x) {
      out[x] = static_cast<std::uint8_t>((above[x] + 2 * centre[x] + below[x] + 8) / 16);
    }
  }
}

}  // namespace ellipse
