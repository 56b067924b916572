// SPDX-License-Identifier: MIT
#include "gst/overlay/blend.hpp"

#include <algorithm>
#include <array>

namespace {

// Weights of red, green and blue, each 0 to 255, and of opacity in a component of the frame.
struct Mix {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
  float offset = 0.0F;
};
using Mixes = std::array<Mix, 4>;

Mixes rgb_mixes() {
  return {Mix{.red = 1.0F}, Mix{.green = 1.0F}, Mix{.blue = 1.0F}, Mix{.offset = 255.0F}};
}

Mix mix_of(double scale, double red, double green, double blue, int offset) {
  return {static_cast<float>(scale * red),
          static_cast<float>(scale * green),
          static_cast<float>(scale * blue),
          static_cast<float>(offset)};
}

Mixes yuv_mixes(const GstVideoInfo& info) {
  double kr = 0.299;  // [BT601], unless the caps specify another
  double kb = 0.114;
  gst_video_color_matrix_get_Kr_Kb(info.colorimetry.matrix, &kr, &kb);
  const double kg = 1.0 - kr - kb;
  gint offset[GST_VIDEO_MAX_COMPONENTS];
  gint scale[GST_VIDEO_MAX_COMPONENTS];
  gst_video_color_range_offsets(info.colorimetry.range, info.finfo, offset, scale);
  const double y = scale[0] / 255.0;
  const double u = 0.5 * scale[1] / 255.0 / (1.0 - kb);
  const double v = 0.5 * scale[2] / 255.0 / (1.0 - kr);
  return {mix_of(y, kr, kg, kb, offset[0]),
          mix_of(u, -kr, -kg, 1.0 - kb, offset[1]),
          mix_of(v, 1.0 - kr, -kg, -kb, offset[2])};
}

// Sum of premultiplied pixels.
struct Sum {
  int red = 0;
  int green = 0;
  int blue = 0;
  int alpha = 0;

  void add(std::uint32_t pixel) {
    red += static_cast<int>(pixel >> 16U & 0xffU);
    green += static_cast<int>(pixel >> 8U & 0xffU);
    blue += static_cast<int>(pixel & 0xffU);
    alpha += static_cast<int>(pixel >> 24U);
  }
};

float mixed(float under, const Mix& mix, const Sum& sum, int pixels) {
  const float alpha = static_cast<float>(sum.alpha) * (1.0F / 255.0F);
  const float over = mix.red * static_cast<float>(sum.red) +
                     mix.green * static_cast<float>(sum.green) +
                     mix.blue * static_cast<float>(sum.blue);
  return under + (over + (mix.offset - under) * alpha) / static_cast<float>(pixels);
}

// How the samples of a component are stored: a byte each, two bytes, or three in 32 bits.
enum class Storage { kByte, kLittleEndian, kBigEndian, kPacked };

Storage storage_of(const GstVideoFormatInfo* format) {
  if (GST_VIDEO_FORMAT_INFO_FORMAT(format) == GST_VIDEO_FORMAT_GRAY10_LE32) return Storage::kPacked;
  if (GST_VIDEO_FORMAT_INFO_DEPTH(format, 0) == 8) return Storage::kByte;
  return GST_VIDEO_FORMAT_INFO_IS_LE(format) ? Storage::kLittleEndian : Storage::kBigEndian;
}

// GStreamer 1.22 puts V of P010 at byte 1, in the middle of U: samples of two bytes are aligned.
guint8* first_sample(GstVideoFrame& frame, guint component) {
  const GstVideoFormatInfo* format = frame.info.finfo;
  const int offset = GST_VIDEO_FORMAT_INFO_POFFSET(format, component);
  const int misplaced = GST_VIDEO_FORMAT_INFO_DEPTH(format, component) > 8 ? offset % 2 : 0;
  return static_cast<guint8*>(GST_VIDEO_FRAME_COMP_DATA(&frame, component)) + misplaced;
}

// The samples of one component; each is shared by a block of pixels.
class Plane {
 public:
  Plane(GstVideoFrame& frame, guint component)
      : x_shift_(GST_VIDEO_FORMAT_INFO_W_SUB(frame.info.finfo, component)),
        y_shift_(GST_VIDEO_FORMAT_INFO_H_SUB(frame.info.finfo, component)),
        data_(first_sample(frame, component)),
        stride_(GST_VIDEO_FRAME_COMP_STRIDE(&frame, component)),
        pixel_stride_(GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, component)),
        storage_(storage_of(frame.info.finfo)),
        unused_bits_(GST_VIDEO_FORMAT_INFO_SHIFT(frame.info.finfo, component)),
        max_((1U << GST_VIDEO_FORMAT_INFO_DEPTH(frame.info.finfo, component)) - 1U) {}

  void blend(const Canvas& canvas, const Mix& mix) const {
    for (const auto& tile : canvas.tiles()) {
      const int rows = std::min(Canvas::kTileSize, canvas.height() - tile->y);
      for (int row = 0; row < rows; row += 1 << y_shift_) {
        blend_row(*tile, row, std::min(rows, row + (1 << y_shift_)), canvas.width(), mix);
      }
    }
  }

 private:
  void blend_row(const Canvas::Tile& tile, int top, int bottom, int width, const Mix& mix) const {
    Canvas::Span span;
    for (int row = top; row < bottom; ++row) span.add(tile.drawn[static_cast<std::size_t>(row)]);
    const int columns = std::min(Canvas::kTileSize, width - tile.x);
    guint8* samples = data_ + std::ptrdiff_t{(tile.y + top) >> y_shift_} * stride_;
    for (int left = span.begin >> x_shift_ << x_shift_; left < span.end; left += 1 << x_shift_) {
      const int right = std::min(columns, left + (1 << x_shift_));
      Sum sum;
      for (int row = top; row < bottom; ++row) {
        for (int column = left; column < right; ++column) {
          sum.add(tile.pixels[Canvas::Tile::index(column, row)]);
        }
      }
      if (sum.alpha == 0) continue;
      blend_sample(samples, (tile.x + left) >> x_shift_, mix, sum, (bottom - top) * (right - left));
    }
  }

  void blend_sample(guint8* row, int column, const Mix& mix, const Sum& sum, int pixels) const {
    const bool is_packed = storage_ == Storage::kPacked;
    guint8* at =
        row + (is_packed ? std::ptrdiff_t{column / 3} * 4 : std::ptrdiff_t{column} * pixel_stride_);
    const guint shift = is_packed ? static_cast<guint>(column % 3) * 10U : unused_bits_;
    const guint32 word = load(at);
    const auto under = static_cast<float>(word >> shift & max_);
    const float level = std::clamp(mixed(under, mix, sum, pixels), 0.0F, static_cast<float>(max_));
    // Never negative; lround would be a call. NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const auto sample = static_cast<guint32>(level + 0.5F);
    store(at, (word & ~(max_ << shift)) | sample << shift);
  }

  [[nodiscard]] guint32 load(const guint8* at) const {
    switch (storage_) {
      case Storage::kByte:
        return *at;
      case Storage::kLittleEndian:
        return GST_READ_UINT16_LE(at);
      case Storage::kBigEndian:
        return GST_READ_UINT16_BE(at);
      case Storage::kPacked:
        return GST_READ_UINT32_LE(at);
    }
    return 0;
  }

  void store(guint8* at, guint32 word) const {
    switch (storage_) {
      case Storage::kByte:
        *at = static_cast<guint8>(word);
        break;
      case Storage::kLittleEndian:
        GST_WRITE_UINT16_LE(at, static_cast<guint16>(word));
        break;
      case Storage::kBigEndian:
        GST_WRITE_UINT16_BE(at, static_cast<guint16>(word));
        break;
      case Storage::kPacked:
        GST_WRITE_UINT32_LE(at, word);
        break;
    }
  }

  guint x_shift_;
  guint y_shift_;
  guint8* data_;
  std::ptrdiff_t stride_;
  std::ptrdiff_t pixel_stride_;
  Storage storage_;
  guint unused_bits_;  // below a sample
  guint32 max_;
};

}  // namespace

void blend(const Canvas& canvas, GstVideoFrame& frame) {
  const GstVideoFormatInfo* format = frame.info.finfo;
  const Mixes mixes = GST_VIDEO_FORMAT_INFO_IS_RGB(format) ? rgb_mixes() : yuv_mixes(frame.info);
  for (guint i = 0; i < GST_VIDEO_FORMAT_INFO_N_COMPONENTS(format); ++i) {
    Plane(frame, i).blend(canvas, mixes[i]);
  }
}
