// SPDX-License-Identifier: MIT
#include "core/scene/ground_painting.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/scene/ground_painter.hpp"
#include "core/scene/outdoor_painting.hpp"

namespace ellipse {
namespace {

constexpr int kSize = kGroundTileSize;
constexpr int kGrainSize = 256;  // texels
constexpr double kPi = std::numbers::pi;

// Levels are relative to the ground's mean, in grey levels.

void asphalt(cv::Mat& tile, Painter& painter, std::uint64_t seed) {
  add_noise(tile, 8, 10.0F, seed);
  add_noise(tile, 32, 12.0F, seed + 1);
  add_noise(tile, 128, 10.0F, seed + 2);
  add_noise(tile, 512, 14.0F, seed + 3);
  for (int crack = 0; crack < 6; ++crack) {
    std::vector<cv::Point2d> points{painter.somewhere()};
    double angle = painter.random().between(0.0, 2.0 * kPi);
    for (int i = 0; i < 25; ++i) {
      angle += painter.random().between(-0.6, 0.6);
      points.push_back(towards(points.back(), angle, painter.random().between(5.0, 20.0)));
    }
    painter.line(points, -45.0, 2);
  }
}

void grass(cv::Mat& tile, Painter& painter, std::uint64_t seed) {
  add_noise(tile, 16, 14.0F, seed);
  for (int blade = 0; blade < 14000; ++blade) {
    const cv::Point2d root = painter.somewhere();
    const double angle = painter.random().between(0.0, 2.0 * kPi);
    const cv::Point2d tip = towards(root, angle, painter.random().between(8.0, 24.0));
    painter.line({root, tip}, painter.random().between(-38.0, 38.0), 2);
  }
}

std::vector<cv::Point2d> arc(const cv::Point2d& center, double radius, double from, double turn) {
  std::vector<cv::Point2d> points;
  for (int i = 0; i <= 24; ++i) points.push_back(towards(center, from + turn * i / 24.0, radius));
  return points;
}

// Painted arcs turn by less than 120 degrees, so that none resembles a full circle.
void arcs(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double radius = random.between(60.0, 250.0);
    const double from = random.between(0.0, 2.0 * kPi);
    painter.line(arc(center, radius, from, random.between(0.8, 2.0)), 90.0, 10);
  }
}

void road(cv::Mat& tile, Painter& painter, std::uint64_t seed) {
  asphalt(tile, painter, seed);
  for (const double x : {200.0, 226.0, 800.0}) painter.line({{x, 0.0}, {x, kSize}}, 95.0, 12);
  for (int i = 0; i < 4; ++i) {
    painter.line({{512.0, 256.0 * i}, {512.0, 256.0 * i + 128.0}}, 95.0, 12);
  }
  arcs(painter, 5);
}

void tiles(cv::Mat& tile, Painter& painter, std::uint64_t seed) {
  constexpr int kTile = 128;
  for (int y = 0; y < kSize; y += kTile) {
    for (int x = 0; x < kSize; x += kTile) {
      tile(cv::Rect(x, y, kTile, kTile)) = painter.random().between(-18.0, 18.0);
    }
  }
  for (int i = 0; i < kSize; i += kTile) {
    tile.rowRange(i, i + 6) = -55.0;
    tile.colRange(i, i + 6) = -55.0;
  }
  add_noise(tile, 64, 6.0F, seed);
  add_noise(tile, 512, 8.0F, seed + 1);
}

double strong_level(Random& random) {
  return (random.unit() < 0.5 ? -1.0 : 1.0) * random.between(35.0, 100.0);
}

void squares(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double turn = random.between(0.0, kPi);
    const double size = random.between(30.0, 90.0);
    std::vector<cv::Point2d> outline(4);
    for (std::size_t corner = 0; corner < outline.size(); ++corner) {
      outline[corner] = towards(center, turn + static_cast<double>(corner) * kPi / 2.0, size);
    }
    painter.polygon(outline, strong_level(random));
  }
}

// Five to eight corners; some with another polygon in the middle, as on a traffic sign.
void polygons(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double turn = random.between(0.0, kPi);
    const int corners = 5 + random.below(4);
    const auto draw = [&](double size) {
      std::vector<cv::Point2d> outline;
      for (int corner = 0; corner < corners; ++corner) {
        outline.push_back(towards(center, turn + 2.0 * kPi * corner / corners, size));
      }
      painter.polygon(outline, strong_level(random));
    };
    const double size = random.between(50.0, 110.0);
    draw(size);
    if (random.unit() < 0.5) draw(random.between(0.6, 0.95) * size);
  }
}

void flowers(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double size = random.between(45.0, 110.0);
    const int petals = 4 + random.below(4);
    const double turn = random.between(0.0, kPi);
    std::vector<cv::Point2d> outline;
    for (int k = 0; k < 180; ++k) {
      const double angle = 2.0 * kPi * k / 180.0;
      // A notch at each petal's tip; without it the petal would be half an ellipse.
      const double across = std::sin(petals * angle / 2.0);
      const double notch = 0.35 * std::exp(-across * across / 0.05);
      const double petal = std::sqrt(1.0 - across * across) * (1.0 - notch);
      outline.push_back(towards(center, turn + angle, size * (0.3 + 0.7 * petal)));
    }
    painter.polygon(outline, strong_level(random));
  }
}

void rounded(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double half_width = random.between(30.0, 80.0);
    const double half_length = half_width * random.between(1.0, 2.5);
    const double radius = half_width * random.between(0.15, 0.3);
    const double turn = random.between(0.0, kPi);
    std::vector<cv::Point2d> outline;
    for (int corner = 0; corner < 4; ++corner) {
      const double sx = corner == 0 || corner == 3 ? 1.0 : -1.0;
      const double sy = corner < 2 ? 1.0 : -1.0;
      const double u = sx * (half_length - radius);
      const double v = sy * (half_width - radius);
      const cv::Point2d middle(center.x + u * std::cos(turn) - v * std::sin(turn),
                               center.y + u * std::sin(turn) + v * std::cos(turn));
      const auto piece = arc(middle, radius, turn + corner * kPi / 2.0, kPi / 2.0);
      outline.insert(outline.end(), piece.begin(), piece.end());
    }
    painter.polygon(outline, strong_level(random));
  }
}

std::vector<cv::Point2d> circle(const cv::Point2d& center, double radius) {
  constexpr int kCorners = 180;
  std::vector<cv::Point2d> outline;
  outline.reserve(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    outline.push_back(towards(center, 2.0 * kPi * i / kCorners, radius));
  }
  return outline;
}

void circles(Painter& painter, int count) {
  Random& random = painter.random();
  for (int i = 0; i < count; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double level = strong_level(random);
    if (i % 2 == 0) {
      painter.polygon(circle(center, random.between(20.0, 65.0)), level);
    } else {
      const double radius = random.between(25.0, 55.0);
      painter.polygon(circle(center, radius), level);
      painter.polygon(circle(center, random.between(0.6, 0.8) * radius), 0.0);
    }
  }
}

}  // namespace

cv::Mat draw_ground(GroundKind kind, std::uint64_t seed) {
  cv::Mat tile(kSize, kSize, CV_32F, cv::Scalar(0.0));
  Painter painter(tile, seed);
  switch (kind) {
    case GroundKind::kAsphalt:
      asphalt(tile, painter, seed);
      return tile;
    case GroundKind::kGrass:
      grass(tile, painter, seed);
      return tile;
    case GroundKind::kRoad:
      road(tile, painter, seed);
      return tile;
    case GroundKind::kTiles:
      tiles(tile, painter, seed);
      return tile;
    case GroundKind::kSquares:
      squares(painter, 40);
      break;
    case GroundKind::kFlowers:
      flowers(painter, 30);
      break;
    case GroundKind::kRounded:
      rounded(painter, 25);
      break;
    case GroundKind::kClutter:
      squares(painter, 14);
      flowers(painter, 10);
      rounded(painter, 8);
      arcs(painter, 6);
      break;
    case GroundKind::kCircles:
      circles(painter, 16);
      break;
    case GroundKind::kGravel:
      gravel(painter);
      break;
    case GroundKind::kPavement:
      pavement(tile, painter);
      break;
    case GroundKind::kFoliage:
      foliage(painter);
      break;
    case GroundKind::kField:
      field(tile, painter, seed);
      break;
    case GroundKind::kPage:
      page(painter);
      break;
    case GroundKind::kPolygons:
      polygons(painter, 30);
      break;
    case GroundKind::kBlades:
      blades(painter);
      break;
    case GroundKind::kSkin:
      add_noise(tile, 6, 14.0F, seed + 2);
      add_noise(tile, 24, 8.0F, seed + 3);
      break;
    case GroundKind::kPlain:
    case GroundKind::kPicture:
      break;
  }
  add_noise(tile, 64, 8.0F, seed);
  add_noise(tile, 512, 8.0F, seed + 1);
  return tile;
}

cv::Mat draw_ground_grain(std::uint64_t seed) {
  cv::Mat tile(kGrainSize, kGrainSize, CV_32F, cv::Scalar(0.0));
  add_noise(tile, 32, 6.0F, seed);
  add_noise(tile, 128, 8.0F, seed + 1);
  return tile;
}

}  // namespace ellipse
