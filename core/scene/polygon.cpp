// SPDX-License-Identifier: MIT
#include "core/scene/polygon.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace ellipse {
namespace {

constexpr std::int64_t kUnit = kPolygonUnitsPerPx;
constexpr std::int64_t kFine = 4096;  // subdivisions of a unit for the steps of edges

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

std::int64_t floor_divided(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

// A side of the polygon; its ends are rounded to row centres, its x coordinates are exact.
struct Edge {
  std::int64_t first_row = 0;
  std::int64_t end_row = 0;
  std::int64_t x = 0;     // in the first row [1 / (kUnit kFine) px]
  std::int64_t step = 0;  // from row to row

  [[nodiscard]] bool meets(std::int64_t row) const { return first_row <= row && row < end_row; }
  [[nodiscard]] std::int64_t x_in(std::int64_t row) const { return x + step * (row - first_row); }
};

std::int64_t nearest_px(std::int64_t units) {
  return floor_divided(units + kUnit / 2, kUnit);
}

Edge edge_between(const cv::Point& a, const cv::Point& b) {
  const cv::Point& upper = nearest_px(a.y) <= nearest_px(b.y) ? a : b;
  const cv::Point& lower = &upper == &a ? b : a;
  Edge edge{nearest_px(upper.y), nearest_px(lower.y), kFine * upper.x, 0};
  const std::int64_t rows = edge.end_row - edge.first_row;
  if (rows > 0) edge.step = kFine * (lower.x - upper.x) / rows;
  return edge;
}

// Writes a part of a row, both ends included, clipped to the tile.
void write_row(
    cv::Mat& tile, std::int64_t row, std::int64_t left, std::int64_t right, float level) {
  if (row < 0 || row >= tile.rows) return;
  auto* pixels = tile.ptr<float>(static_cast<int>(row));
  const std::int64_t last = std::min<std::int64_t>(right, tile.cols - 1);
  for (std::int64_t x = std::max<std::int64_t>(left, 0); x <= last; ++x) pixels[x] = level;
}

// Clips a line to the range [0, last] of one coordinate.
// @return false if no part of it is inside.
bool cut(Point& from,
         Point& to,
         std::int64_t Point::*across,
         std::int64_t Point::*along,
         std::int64_t last) {
  const auto lowest = std::min(from.*across, to.*across);
  const auto highest = std::max(from.*across, to.*across);
  if (highest < 0 || lowest > last) return false;
  for (const auto& [end, other] : {std::pair(&from, &to), std::pair(&to, &from)}) {
    const std::int64_t excess = std::clamp<std::int64_t>(end->*across, 0, last) - end->*across;
    if (excess == 0) continue;
    end->*along += excess * (other->*along - end->*along) / (other->*across - end->*across);
    end->*across += excess;
  }
  return true;
}

// The nearest pixels along a line [Bresenham1965], from the left; ties go to its beginning. Clips
// to the tile first, which may move the rest by a pixel; kept, as published figures depend on it.
void write_line(cv::Mat& tile, Point from, Point to, float level) {
  if (!cut(from, to, &Point::y, &Point::x, tile.rows - 1)) return;
  if (!cut(from, to, &Point::x, &Point::y, tile.cols - 1)) return;
  if (from.x > to.x) std::swap(from, to);
  const std::int64_t width = to.x - from.x;
  const std::int64_t height = std::abs(to.y - from.y);
  const std::int64_t down = to.y < from.y ? -1 : 1;
  const std::int64_t steps = std::max(width, height);
  const std::int64_t other = std::min(width, height);
  for (std::int64_t k = 0; k <= steps; ++k) {
    const std::int64_t aside = steps > 0 ? (2 * other * k + steps - 1) / (2 * steps) : 0;
    const std::int64_t x = from.x + (height > width ? aside : k);
    const std::int64_t y = from.y + down * (height > width ? k : aside);
    write_row(tile, y, x, x, level);
  }
}

void fill_inside(cv::Mat& tile, const std::vector<Edge>& edges, float level) {
  constexpr std::int64_t kPx = kUnit * kFine;
  std::vector<std::int64_t> crossings;
  for (int row = 0; row < tile.rows; ++row) {
    crossings.clear();
    for (const Edge& edge : edges) {
      if (edge.meets(row)) crossings.push_back(edge.x_in(row));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const std::int64_t left = floor_divided(crossings[i] + kPx - 1, kPx);
      write_row(tile, row, left, floor_divided(crossings[i + 1], kPx), level);
    }
  }
}

}  // namespace

void fill_polygon(cv::Mat& tile, std::span<const cv::Point> corners, float level) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point& a = corners[i];
    const cv::Point& b = corners[(i + 1) % corners.size()];
    edges.push_back(edge_between(a, b));
    write_line(tile, {nearest_px(a.x), nearest_px(a.y)}, {nearest_px(b.x), nearest_px(b.y)}, level);
  }
  fill_inside(tile, edges, level);
}

}  // namespace ellipse
