#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>

namespace ellipse {

/// A rectangle of whole pixels: columns [x, x + width), rows [y, y + height).
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
  [[nodiscard]] bool contains(int px, int py) const {
    return px >= x && py >= y && px < x + width && py < y + height;
  }
  bool operator==(const Rect&) const = default;
};

/// The intersection of two rectangles, 0 x 0 if empty.
[[nodiscard]] Rect intersect(const Rect& a, const Rect& b);

/// The smallest rectangle around two rectangles, of which empty ones do not count.
[[nodiscard]] Rect united(const Rect& a, const Rect& b);

/// A borrowed 8-bit luma image. Copying it copies no pixels.
struct ImageView {
  const std::uint8_t* data = nullptr;  ///< The top-left pixel. Borrowed.
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  std::ptrdiff_t stride = 0;           ///< Bytes from a row to the one below; may be negative.

  [[nodiscard]] const std::uint8_t* row(int y) const { return data + y * stride; }
  [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
  [[nodiscard]] Rect bounds() const { return {0, 0, width, height}; }

  /// Bilinear interpolation. 0 <= x < width - 1 and 0 <= y < height - 1.
  [[nodiscard]] float at(float x, float y) const {
    const int column = static_cast<int>(x);
    const int line = static_cast<int>(y);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(line);
    const std::uint8_t* upper = row(line) + column;
    const std::uint8_t* lower = upper + stride;
    const float above = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
    const float below = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
    return above + fy * (below - above);
  }

  /// The part of the picture inside `rect`, clipped to the picture.
  [[nodiscard]] ImageView region(const Rect& rect) const;
};

}  // namespace ellipse
