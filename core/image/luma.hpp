#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image_view.hpp"

namespace ellipse {

/// Memory layout of one pixel.
struct PixelLayout {
  /// Stored brightness: a luma byte, or red, green and blue.
  enum class Kind { kLuma, kRgb };

  Kind kind = Kind::kLuma;
  int pixel_stride = 1;  ///< Bytes from a pixel to its right neighbour: 1 to 4.
  int luma = 0;          ///< Offset of the luma byte (kLuma).
  int red = 0;           ///< Offsets of the colour bytes (kRgb).
  int green = 0;
  int blue = 0;

  [[nodiscard]] bool is_plain_luma() const { return kind == Kind::kLuma && pixel_stride == 1; }
};

/// A borrowed image in the camera's 8-bit layout.
struct PixelView {
  const std::uint8_t* data = nullptr;  ///< First byte of the top-left pixel. Borrowed.
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  std::ptrdiff_t stride = 0;           ///< Bytes from a row to the one below; may be negative.
  PixelLayout layout = {};

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

/// Reads the luma of a region: in place if the picture stores plain luma, else converted into an
/// internal buffer that is reused between frames. Only the region is converted.
///
/// RGB becomes luma with the weights of [BT601], full range, rounded. Not thread-safe.
class LumaReader {
 public:
  /// @param region  Clipped to the picture.
  /// @return A view of the clipped region, empty if nothing of it is inside. Valid until the next
  ///         call or until the picture is released. Its stride is not negative.
  [[nodiscard]] ImageView read(const PixelView& picture, const Rect& region);

 private:
  std::vector<std::uint8_t> buffer_;
};

}  // namespace ellipse
