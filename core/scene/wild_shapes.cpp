// SPDX-License-Identifier: MIT
#include "core/scene/wild_shapes.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string_view>

namespace ellipse::wild {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Shape disc(const Vector2d& center, double radius, const Paint& paint) {
  Shape shape;
  shape.sheet_from_shape.translate(center).scale(radius);
  shape.paint = paint;
  return shape;
}

Shape polygon(const std::vector<Vector2d>& corners, const Paint& paint, double rounding) {
  Shape shape;
  shape.outline = Outline::kPolygon;
  shape.corners = corners;
  shape.amount = rounding;
  shape.paint = paint;
  return shape;
}

Shape box(const Vector2d& center,
          const Vector2d& half_size,
          double turn_rad,
          const Paint& paint,
          double rounding) {
  const Vector2d half = half_size - Vector2d::Constant(rounding);
  Shape shape = polygon(
      {{-half.x(), -half.y()}, {half.x(), -half.y()}, {half.x(), half.y()}, {-half.x(), half.y()}},
      paint,
      rounding);
  shape.sheet_from_shape.translate(center).rotate(turn_rad);
  return shape;
}

Shape stroke(const Vector2d& from, const Vector2d& to, double width, const Paint& paint) {
  const Vector2d middle = 0.5 * (from + to);
  Shape shape = polygon({from - middle, to - middle}, paint, 0.5 * width);
  shape.sheet_from_shape.translate(middle);
  return shape;
}

std::vector<Vector2d> regular_corners(int count, double turn_rad) {
  std::vector<Vector2d> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = turn_rad + 2.0 * std::numbers::pi * i / count;
    corners.emplace_back(std::cos(angle), std::sin(angle));
  }
  return corners;
}

Shape mesh(double spacing, double wire_width, double shear_rad, const Paint& paint) {
  Shape shape;
  shape.outline = Outline::kMesh;
  shape.amount = 0.5 * wire_width / spacing;
  shape.sheet_from_shape.linear() << spacing, spacing * std::sin(shear_rad), 0.0,
      spacing * std::cos(shear_rad);
  shape.paint = paint;
  return shape;
}

Shape blot(const Vector2d& center, double radius, const Paint& paint, std::uint64_t seed) {
  Shape shape = disc(center, radius, paint);
  shape.outline = Outline::kWavy;
  shape.amount = 0.4;
  shape.seed = seed;
  return shape;
}

std::vector<Shape> glyph(char letter, double bar_width, const Paint& paint) {
  constexpr double kHalf = 0.6;  // of its width
  const auto bar = [&](double x0, double y0, double x1, double y1) {
    const Vector2d from(x0, y0);
    const Vector2d to(x1, y1);
    const Vector2d along = (to - from).normalized();
    Shape shape = box(0.5 * (from + to),
                      {0.5 * (to - from).norm() + 0.5 * bar_width, 0.5 * bar_width},
                      std::atan2(along.y(), along.x()),
                      paint);
    return shape;
  };
  if (letter == 'X') return {bar(-0.8, -0.8, 0.8, 0.8), bar(-0.8, 0.8, 0.8, -0.8)};
  if (letter == 'H') {
    return {bar(-kHalf, -1, -kHalf, 1), bar(kHalf, -1, kHalf, 1), bar(-kHalf, 0, kHalf, 0)};
  }
  // Seven segments: top, upper right, lower right, bottom, lower left, upper left, middle.
  constexpr std::string_view kSegments[] = {"1111110",
                                            "0110000",
                                            "1101101",
                                            "1111001",
                                            "0110011",
                                            "1011011",
                                            "1011111",
                                            "1110000",
                                            "1111111",
                                            "1111011"};
  const std::string_view segments = kSegments[static_cast<std::size_t>(letter - '0') % 10];
  const Shape all[] = {bar(-kHalf, -1, kHalf, -1),
                       bar(kHalf, -1, kHalf, 0),
                       bar(kHalf, 0, kHalf, 1),
                       bar(-kHalf, 1, kHalf, 1),
                       bar(-kHalf, 0, -kHalf, 1),
                       bar(-kHalf, -1, -kHalf, 0),
                       bar(-kHalf, 0, kHalf, 0)};
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i] == '1') shapes.push_back(all[i]);
  }
  return shapes;
}

void place(std::vector<Shape>& shapes, const Vector2d& to, double scale, double turn_rad) {
  Eigen::Affine2d move = Eigen::Affine2d::Identity();
  move.translate(to).rotate(turn_rad).scale(scale);
  for (Shape& shape : shapes) shape.sheet_from_shape = move * shape.sheet_from_shape;
}

Matrix3d level_frame(const Vector3d& at, double scale, double turn_rad) {
  const double c = scale * std::cos(turn_rad);
  const double s = scale * std::sin(turn_rad);
  Matrix3d frame;
  frame << c, -s, at.x(), s, c, at.y(), 0.0, 0.0, at.z();
  return frame;
}

Matrix3d upright_frame(const Vector3d& at, double scale, double azimuth_rad) {
  Matrix3d frame;
  frame.col(0) = scale * Vector3d(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0);
  frame.col(1) = Vector3d(0.0, 0.0, -scale);
  frame.col(2) = at;
  return frame;
}

}  // namespace ellipse::wild
