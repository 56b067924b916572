#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// A transparent picture of which only those parts exist that were drawn on, so that what is drawn
/// costs the same in a picture of any size. Kept from frame to frame it allocates nothing once it
/// has seen its largest drawing. Not thread-safe.
///
/// Shapes first cover pixels, where of overlapping ones the larger coverage stays; paint() then
/// gives all that is covered a colour. So the pieces of a line leave no seams.
class Canvas {
 public:
  static constexpr int kTileSize = 64;  ///< [px]. A multiple of every block of chroma.

  static constexpr std::size_t kTilePixels = std::size_t{kTileSize} * kTileSize;

  /// A part of a tile's row, empty where end <= begin.
  struct Span {
    int begin = kTileSize;
    int end = 0;

    void add(const Span& other) {
      begin = std::min(begin, other.begin);
      end = std::max(end, other.end);
    }
  };
  using Spans = std::array<Span, kTileSize>;

  struct Tile {
    int x = 0;  ///< Of its top-left pixel [px].
    int y = 0;
    Spans drawn;  ///< Outside of these all pixels are transparent.
    Spans covered;
    std::array<std::uint32_t, kTilePixels> pixels{};  ///< 0xAARRGGBB, premultiplied.
    std::array<std::uint8_t, kTilePixels> coverage{};

    /// Of a pixel in `pixels` and `coverage`.
    [[nodiscard]] static constexpr std::size_t index(int column, int row) {
      return static_cast<std::size_t>(row) * kTileSize + static_cast<std::size_t>(column);
    }
  };

  /// Makes it empty and of this size [px].
  void clear(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// @param level  How much of the pixel is covered; 255 is all of it. Outside of the picture
  ///               nothing happens.
  void cover(int x, int y, std::uint8_t level);
  /// A line with round ends. Ends may lie anywhere up to 1e6 px away.
  void cover_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px);

  /// Lays a colour, 0xAARRGGBB, not premultiplied, over what is covered. Nothing is covered then.
  void paint(std::uint32_t argb);

  /// Where something was drawn. Valid until the next call of clear() or cover().
  [[nodiscard]] std::span<const std::unique_ptr<Tile>> tiles() const {
    return {tiles_.data(), used_};
  }

 private:
  [[nodiscard]] Tile*& cell_at(int x, int y) {
    return cells_[static_cast<std::size_t>(y / kTileSize) * columns_ +
                  static_cast<std::size_t>(x / kTileSize)];
  }
  Tile* add_tile(int x, int y);

  int width_ = 0;
  int height_ = 0;
  std::size_t columns_ = 0;
  std::vector<Tile*> cells_;                  // row by row; null where nothing was drawn
  std::vector<std::unique_ptr<Tile>> tiles_;  // those in use first
  std::size_t used_ = 0;
};
