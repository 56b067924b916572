#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

#include "core/scene/random.hpp"
#include "tests/support/picture.hpp"

namespace support {

/// An upright ellipse drawn with integers only, so that its picture is the same on every processor;
/// the scene renderer calls sin(), whose last digit differs. Units: pixels.
struct IntegerDisc {
  int x;
  int y;
  int semi_x;
  int semi_y;

  [[nodiscard]] bool contains(int at_x, int at_y) const {
    const std::int64_t along_x = std::int64_t{at_x - x} * semi_y;
    const std::int64_t along_y = std::int64_t{at_y - y} * semi_x;
    const std::int64_t limit = std::int64_t{semi_x} * semi_y;
    return along_x * along_x + along_y * along_y <= limit * limit;
  }

  /// The disc on a ramp, each pixel the mean of 4 x 4, with noise of +-`noise` grey levels.
  [[nodiscard]] GrayPicture draw(int width, int height, int noise) const {
    GrayPicture picture(width, height);
    const IntegerDisc fine{4 * x, 4 * y, 4 * semi_x, 4 * semi_y};
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        int covered = 0;
        for (int part = 0; part < 16; ++part) {
          covered += fine.contains(4 * column + part % 4, 4 * row + part / 4) ? 1 : 0;
        }
        const auto pixel = static_cast<std::uint64_t>(row * width + column);
        const int shift = static_cast<int>(ellipse::hash(pixel) % 64) % (2 * noise + 1) - noise;
        picture.at(column, row) =
            static_cast<std::uint8_t>(40 + 40 * column / width + 7 * covered + shift);
      }
    }
    return picture;
  }
};

}  // namespace support
