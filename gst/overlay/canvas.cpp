// SPDX-License-Identifier: MIT
#include "gst/overlay/canvas.hpp"

#include <algorithm>
#include <cmath>

using Eigen::Vector2d;

namespace {

// Multiplies all four bytes of a pixel by alpha / 255, rounded, two at a time. For a product n of
// two bytes, (n + 128 + (n + 128) / 256) / 256 is n / 255, rounded.
std::uint32_t scaled(std::uint32_t pixel, std::uint32_t alpha) {
  constexpr std::uint32_t kEvenBytes = 0x00ff00ffU;
  const std::uint32_t even = (pixel & kEvenBytes) * alpha + 0x00800080U;
  const std::uint32_t odd = (pixel >> 8U & kEvenBytes) * alpha + 0x00800080U;
  return ((even + (even >> 8U & kEvenBytes)) >> 8U & kEvenBytes) |
         ((odd + (odd >> 8U & kEvenBytes)) & ~kEvenBytes);
}

std::uint32_t premultiplied(std::uint32_t argb) {
  return scaled(argb | 0xff000000U, argb >> 24U);
}

void wipe(Canvas::Tile& tile) {
  for (int row = 0; row < Canvas::kTileSize; ++row) {
    const Canvas::Span& span = tile.drawn[static_cast<std::size_t>(row)];
    if (span.begin >= span.end) continue;
    std::fill_n(&tile.pixels[Canvas::Tile::index(span.begin, row)], span.end - span.begin, 0U);
  }
  tile.drawn.fill({});
}

}  // namespace

void Canvas::clear(int width, int height) {
  paint(0U);  // discards the coverage of an aborted drawing
  for (const auto& tile : tiles()) {
    cell_at(tile->x, tile->y) = nullptr;
    wipe(*tile);
  }
  used_ = 0;
  if (width == width_ && height == height_) return;
  const auto columns = static_cast<std::size_t>((width + kTileSize - 1) / kTileSize);
  const auto rows = static_cast<std::size_t>((height + kTileSize - 1) / kTileSize);
  cells_.assign(columns * rows, nullptr);
  columns_ = columns;
  width_ = width;
  height_ = height;
}

Canvas::Tile* Canvas::add_tile(int x, int y) {
  if (used_ == tiles_.size()) tiles_.push_back(std::make_unique<Tile>());
  Tile* tile = tiles_[used_++].get();
  tile->x = x / kTileSize * kTileSize;
  tile->y = y / kTileSize * kTileSize;
  return tile;
}

void Canvas::cover(int x, int y, std::uint8_t level) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_ || level == 0) return;
  Tile*& cell = cell_at(x, y);
  if (cell == nullptr) cell = add_tile(x, y);
  const int column = x - cell->x;
  const int row = y - cell->y;
  std::uint8_t& coverage = cell->coverage[Tile::index(column, row)];
  coverage = std::max(coverage, level);
  cell->covered[static_cast<std::size_t>(row)].add({column, column + 1});
}

void Canvas::cover_line(const Vector2d& from, const Vector2d& to, double width_px) {
  const Vector2d way = to - from;
  const double length = way.norm();
  const Vector2d along = length > 0.0 ? Vector2d(way / length) : Vector2d::Zero();
  const double reach = 0.5 * width_px + 0.5;
  const double max_share = std::min(1.0, width_px);  // of a pixel, for lines thinner than 1 px
  const Vector2d box_min = from.cwiseMin(to).array() - reach;
  const Vector2d box_max = from.cwiseMax(to).array() + reach;
  const int bottom = static_cast<int>(std::min(height_ - 1.0, std::floor(box_max.y())));
  for (int y = static_cast<int>(std::max(0.0, std::ceil(box_min.y()))); y <= bottom; ++y) {
    double left = box_min.x();
    double right = box_max.x();
    if (std::abs(along.y()) > 1e-6) {  // restricts the row to the line
      const double middle = from.x() + (y - from.y()) * along.x() / along.y();
      left = std::max(left, middle - reach / std::abs(along.y()));
      right = std::min(right, middle + reach / std::abs(along.y()));
    }
    const int last = static_cast<int>(std::min(width_ - 1.0, std::floor(right)));
    for (int x = static_cast<int>(std::max(0.0, std::ceil(left))); x <= last; ++x) {
      const Vector2d d = Vector2d(x, y) - from;
      const double distance = (d - std::clamp(d.dot(along), 0.0, length) * along).norm();
      const double share = std::clamp(reach - distance, 0.0, max_share);
      // Never negative; lround would be a call. NOLINTNEXTLINE(bugprone-incorrect-roundings)
      cover(x, y, static_cast<std::uint8_t>(255.0 * share + 0.5));
    }
  }
}

void Canvas::paint(std::uint32_t argb) {
  const std::uint32_t color = premultiplied(argb);
  for (const auto& tile : tiles()) {
    for (int row = 0; row < kTileSize; ++row) {
      Span& span = tile->covered[static_cast<std::size_t>(row)];
      for (int column = span.begin; column < span.end; ++column) {
        const std::size_t i = Tile::index(column, row);
        if (tile->coverage[i] == 0) continue;
        const std::uint32_t over = scaled(color, tile->coverage[i]);
        tile->pixels[i] = over + scaled(tile->pixels[i], 255U - (over >> 24U));
        tile->coverage[i] = 0;
      }
      tile->drawn[static_cast<std::size_t>(row)].add(span);
      span = {};
    }
  }
}
