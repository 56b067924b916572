#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// A transparent picture of tiles that are created when they are drawn on: the cost depends on the
/// drawing, not on the size of the picture. Reused for many frames it allocates only when a drawing
/// needs more tiles than any before. Not thread-safe.
///
/// Shapes first cover pixels; overlapping shapes keep the larger coverage. paint() then colours all
/// covered pixels, so that the segments of a line leave no seams.
class Canvas {
 public:
  static constexpr int kTileSize = 64;  ///< [px]. A multiple of every chroma block.

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
    int x = 0;  ///< Position of the top-left pixel [px].
    int y = 0;
    Spans drawn;  ///< All pixels outside are transparent.
    Spans covered;
    std::array<std::uint32_t, kTilePixels> pixels{};  ///< 0xAARRGGBB, premultiplied.
    std::array<std::uint8_t, kTilePixels> coverage{};

    /// Index of a pixel in `pixels` and `coverage`.
    [[nodiscard]] static constexpr std::size_t index(int column, int row) {
      return static_cast<std::size_t>(row) * kTileSize + static_cast<std::size_t>(column);
    }
  };

  /// Empties it and sets its size [px].
  void clear(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// @param level  Coverage of the pixel; 255 is all of it. Pixels outside the picture are ignored.
  void cover(int x, int y, std::uint8_t level);
  /// A line with round ends, which may lie up to 1e6 px outside the picture.
  void cover_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px);

  /// Paints the covered pixels in a colour, 0xAARRGGBB, not premultiplied, and clears the coverage.
  void paint(std::uint32_t argb);

  /// The tiles that were drawn on. Valid until the next call of clear() or cover().
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
  std::vector<Tile*> cells_;                  // row by row; null if nothing was drawn
  std::vector<std::unique_ptr<Tile>> tiles_;  // those in use first
  std::size_t used_ = 0;
};
