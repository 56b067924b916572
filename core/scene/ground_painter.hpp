#pragma once  // SPDX-License-Identifier: MIT

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/scene/ground_painting.hpp"
#include "core/scene/polygon.hpp"
#include "core/scene/random.hpp"

namespace ellipse {

/// Adds smooth noise: random in [-amplitude, amplitude] at the corners of a lattice that repeats
/// [Perlin1985].
void add_noise(cv::Mat& tile, int cells, float amplitude, std::uint64_t seed);

/// Draws shapes on a seamless tile.
class Painter {
 public:
  explicit Painter(cv::Mat& tile, std::uint64_t seed) : tile_(tile), random_(seed) {}

  void polygon(const std::vector<cv::Point2d>& outline, double level) {
    for_each_copy([&](double dx, double dy) {
      fill_polygon(tile_, moved(outline, dx, dy), static_cast<float>(level));
    });
  }

  void line(const std::vector<cv::Point2d>& points, double level, int thickness) {
    for_each_copy([&](double dx, double dy) {
      cv::polylines(tile_, moved(points, dx, dy), false, level, thickness, cv::LINE_8, kShift);
    });
  }

  [[nodiscard]] cv::Point2d somewhere() {
    const double x = random_.between(0.0, kGroundTileSize);
    return {x, random_.between(0.0, kGroundTileSize)};
  }
  [[nodiscard]] Random& random() { return random_; }

 private:
  static constexpr int kShift = 4;
  static_assert(1 << kShift == kPolygonUnitsPerPx);

  template <class Use>
  static void for_each_copy(const Use& use) {
    for (const int dy : {-kGroundTileSize, 0, kGroundTileSize}) {
      for (const int dx : {-kGroundTileSize, 0, kGroundTileSize}) use(dx, dy);
    }
  }

  static std::vector<cv::Point> moved(const std::vector<cv::Point2d>& points,
                                      double dx,
                                      double dy) {
    std::vector<cv::Point> result;
    result.reserve(points.size());
    for (const cv::Point2d& p : points) {
      result.emplace_back(static_cast<int>(std::floor((p.x + dx) * (1 << kShift))),
                          static_cast<int>(std::floor((p.y + dy) * (1 << kShift))));
    }
    return result;
  }

  cv::Mat& tile_;
  Random random_;
};

/// The point at a distance in a direction.
[[nodiscard]] inline cv::Point2d towards(const cv::Point2d& from,
                                         double angle_rad,
                                         double distance) {
  return {from.x + distance * std::cos(angle_rad), from.y + distance * std::sin(angle_rad)};
}

}  // namespace ellipse
