#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image_view.hpp"

namespace ellipse {

/// Memory layout of the pixels.
struct PixelLayout {
  /// Stored brightness.
  enum class Kind {
    kLuma,    ///< One byte of luma: the only one, or the most significant one of several.
    kRgb,     ///< Red, green and blue bytes.
    kWord,    ///< 16 bits, little endian, of which 8 are read.
    kPacked,  ///< 32 bits, little endian, of three pixels with 10 bits each; the first is lowest.
    kMosaic,  ///< A byte behind the colour filters of a Bayer sensor, in any arrangement.
  };

  Kind kind = Kind::kLuma;
  int pixel_stride = 1;  ///< Bytes from a pixel to its right neighbour: 1 to 4. Not for kPacked.
  int luma = 0;          ///< Offset of the luma byte (kLuma).
  int red = 0;           ///< Offsets of the colour bytes (kRgb).
  int green = 0;
  int blue = 0;
  int shift = 0;  ///< Bits below the 8 that are read (kWord).

  [[nodiscard]] bool is_plain_luma() const { return kind == Kind::kLuma && pixel_stride == 1; }
};

/// A borrowed image in the camera's layout.
struct PixelView {
  const std::uint8_t* data = nullptr;  ///< First byte of the top-left pixel. Borrowed.
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  std::ptrdiff_t stride = 0;           ///< Bytes from a row to the one below; may be negative.
  PixelLayout layout = {};
  bool is_slow = false;  ///< Memory that is slow to read, such as a device's: read each byte once.

  PixelView() = default;
  PixelView(const std::uint8_t* first,
            int width_px,
            int height_px,
            std::ptrdiff_t row_stride,
            const PixelLayout& pixel_layout)
      : data(first), width(width_px), height(height_px), stride(row_stride), layout(pixel_layout) {}
  /// A luma image, readable without conversion.
  PixelView(const ImageView& luma)  // NOLINT(google-explicit-constructor)
      : PixelView(luma.data, luma.width, luma.height, luma.stride, PixelLayout{}) {}

  [[nodiscard]] Rect bounds() const { return {0, 0, width, height}; }
};

/// Reads the luma of regions of a picture: in place if the picture stores plain luma in memory that
/// is fast to read, else converted into an internal buffer that is reused between pictures.
/// Converts only the smallest rectangle around the regions read so far, and each of its pixels
/// once.
///
/// RGB becomes luma with the weights of [BT601], full range, rounded. Of more than 8 bits the 8
/// most significant ones are used. Bayer mosaics are filtered by (1 2 1) in both directions, so
/// that each pixel is a mean of a quarter of red, half of green and a quarter of blue,
/// independently of its own colour filter. Not thread-safe.
class LumaReader {
 public:
  /// Begins a picture, which is borrowed until the next one.
  void begin(const PixelView& picture);

  /// @param region  Clipped to the picture.
  /// @return A view of the clipped region, empty if nothing of it is inside. Valid until the next
  ///         call or until the picture is released. Its stride is not negative. Allocates only if a
  ///         larger rectangle is converted than any before.
  [[nodiscard]] ImageView read(const Rect& region);

 private:
  void convert(const Rect& region);
  void convert_mosaic(const Rect& region);

  PixelView picture_;
  Rect converted_;                           // part of the picture that is in buffer_
  std::vector<std::uint8_t> buffer_;         // of the whole picture, without padding
  std::vector<std::uint16_t> mosaic_lines_;  // three rows, filtered horizontally
};

}  // namespace ellipse
