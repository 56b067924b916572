// SPDX-License-Identifier: MIT
#include "core/scene/outdoor_painting.hpp"

#include <cmath>
#include <vector>

#include "core/geometry/ellipse.hpp"

namespace ellipse {
namespace {

constexpr int kSize = kGroundTileSize;

// Four to six corners at uneven distances: no ellipse fits it well.
std::vector<cv::Point2d> stone(const cv::Point2d& center, double size, Random& random) {
  const int corners = 4 + random.below(3);
  const double turn = random.between(0.0, kTwoPi);
  const double flat = random.between(0.5, 1.0);
  std::vector<cv::Point2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = kTwoPi * (i + random.between(-0.3, 0.3)) / corners;
    const double radius = size * random.between(0.6, 1.2);
    const double u = radius * std::cos(angle);
    const double v = flat * radius * std::sin(angle);
    outline.emplace_back(center.x + u * std::cos(turn) - v * std::sin(turn),
                         center.y + u * std::sin(turn) + v * std::cos(turn));
  }
  return outline;
}

}  // namespace

void gravel(Painter& painter) {
  Random& random = painter.random();
  for (int i = 0; i < 7000; ++i) {
    const cv::Point2d center = painter.somewhere();
    const double size = 5.0 * std::pow(4.0, random.unit());
    painter.polygon(stone(center, size + 1.5, random), -55.0);
    painter.polygon(stone(center, size, random), random.between(-35.0, 45.0));
  }
}

void pavement(cv::Mat& tile, Painter& painter) {
  Random& random = painter.random();
  constexpr int kHeight = 64;
  constexpr int kWidth = 128;
  constexpr int kJoint = 4;
  for (int row = 0; row < kSize / kHeight; ++row) {
    for (int column = 0; column < kSize / kWidth; ++column) {
      const double left = column * kWidth + 0.5 * (row % 2) * kWidth;
      const double top = row * kHeight;
      const double right = left + kWidth - kJoint;
      const double bottom = top + kHeight - kJoint;
      painter.polygon({{left, top}, {right, top}, {right, bottom}, {left, bottom}},
                      random.between(-15.0, 25.0));
    }
  }
  tile.setTo(-45.0, tile == 0.0);
}

void foliage(Painter& painter) {
  Random& random = painter.random();
  for (int i = 0; i < 6000; ++i) {
    const cv::Point2d root = painter.somewhere();
    const double angle = random.between(0.0, kTwoPi);
    const double length = random.between(15.0, 55.0);
    const cv::Point2d middle = towards(root, angle, 0.4 * length);
    const double half = length * random.between(0.08, 0.2);
    const double shade = 70.0 * (random.unit() - 0.55);
    const cv::Point2d tip = towards(root, angle, length);
    painter.polygon({root, towards(middle, angle + 1.57, half), tip}, shade);
    painter.polygon({root, towards(middle, angle - 1.57, half), tip}, shade - 20.0);
  }
}

void field(cv::Mat& tile, Painter& painter, std::uint64_t seed) {
  Random& random = painter.random();
  const int furrows = 16 << random.below(3);
  for (int x = 0; x < kSize; ++x) {
    tile.col(x) = 22.0 * std::sin(kTwoPi * furrows * x / kSize);
  }
  add_noise(tile, 12, 16.0F, seed + 2);
  add_noise(tile, 128, 16.0F, seed + 3);
  for (int i = 0; i < 3000; ++i) {
    const cv::Point2d from = painter.somewhere();
    const double angle = random.between(0.0, kTwoPi);
    painter.line(
        {from, towards(from, angle, random.between(3.0, 14.0))}, random.between(-50.0, 50.0), 2);
  }
}

void page(Painter& painter) {
  Random& random = painter.random();
  constexpr int kLine = 32;
  for (int line = 0; line < kSize / kLine; ++line) {
    const double top = line * kLine + 4.0;
    for (double x = 0.0; x < kSize - 20.0;) {
      const double width = random.between(6.0, 12.0);
      if (random.unit() < 0.16) {
        x += width;  // between words
        continue;
      }
      const double bottom = top + 18.0;
      painter.line({{x, top}, {x, bottom}}, -85.0, 3);
      const double from = random.between(top, bottom);
      painter.line({{x, from}, {x + width - 3.0, random.between(top, bottom)}}, -85.0, 3);
      if (random.unit() < 0.5)
        painter.line({{x + width - 3.0, top}, {x + width - 3.0, bottom}}, -85.0, 3);
      x += width + 3.0;
    }
  }
}

// A blade has two nearly parallel edges, a straight root and a pointed tip, so that no ellipse fits
// both ends.
void blades(Painter& painter) {
  Random& random = painter.random();
  const double upwards = random.between(0.0, kTwoPi);
  constexpr int kSteps = 32;
  for (int i = 0; i < 60; ++i) {
    cv::Point2d middle = painter.somewhere();
    double angle = upwards + random.between(-0.4, 0.4);
    const double bend = random.between(-1.2, 1.2) / kSteps;
    const double step = random.between(500.0, 1000.0) / kSteps;
    const double half_at_root = random.between(20.0, 140.0);
    std::vector<cv::Point2d> outline;
    for (int k = 0; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      const double half_width = half_at_root * (1.0 - share * share);
      outline.insert(outline.begin(), towards(middle, angle - 0.25 * kTwoPi, half_width));
      outline.push_back(towards(middle, angle + 0.25 * kTwoPi, half_width));
      middle = towards(middle, angle, step);
      angle += bend;
    }
    painter.polygon(outline, random.between(-70.0, 70.0));
  }
}

}  // namespace ellipse
