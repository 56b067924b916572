// SPDX-License-Identifier: MIT
#include "core/scene/lens_map.hpp"

#include <limits>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

int blocks_over(int pixels) {
  return (pixels + LensMap::kBlock - 1) / LensMap::kBlock;
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

LensMap::LensMap(const Camera& camera)
    : lens_(camera), corners_across_(blocks_over(camera.width) + 1) {
  const int down = blocks_over(camera.height) + 1;
  const Vector2d nowhere = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  corners_.reserve(static_cast<std::size_t>(corners_across_) * static_cast<std::size_t>(down));
  for (int row = 0; row < down; ++row) {
    for (int column = 0; column < corners_across_; ++column) {
      const Vector2d picture_px(kBlock * column - 0.5, kBlock * row - 0.5);
      corners_.push_back(lens_.ideal_from_picture(picture_px).value_or(nowhere));
    }
  }
}

const Vector2d& LensMap::corner(int column, int row) const {
  return corners_[static_cast<std::size_t>(row) * static_cast<std::size_t>(corners_across_) +
                  static_cast<std::size_t>(column)];
}

bool LensMap::is_shown(int column, int row) const {
  return corner(column, row).allFinite() && corner(column + 1, row).allFinite() &&
         corner(column, row + 1).allFinite() && corner(column + 1, row + 1).allFinite();
}

// From the unit square: p(u, v) = (p00 + u a + v b) / (1 + u g + v h). The corners (1, 0) and (0,
// 1) give a and b, the last one two linear equations for g and h.
Matrix3d LensMap::ideal_from_picture(int column, int row) const {
  const Vector2d& p00 = corner(column, row);
  const Vector2d& p10 = corner(column + 1, row);
  const Vector2d& p01 = corner(column, row + 1);
  const Vector2d& p11 = corner(column + 1, row + 1);
  const Vector2d to_right = p10 - p11;
  const Vector2d to_lower = p01 - p11;
  const Vector2d rest = p00 + p11 - p10 - p01;
  const double area = cross(to_right, to_lower);
  const double g = cross(rest, to_lower) / area;
  const double h = cross(to_right, rest) / area;
  Matrix3d ideal_from_square;
  ideal_from_square.col(0) << (1.0 + g) * p10 - p00, g;
  ideal_from_square.col(1) << (1.0 + h) * p01 - p00, h;
  ideal_from_square.col(2) << p00, 1.0;
  constexpr double kPart = 1.0 / kBlock;
  ideal_from_square.leftCols<2>() *= kPart;
  const Vector2d begin(kBlock * column - 0.5, kBlock * row - 0.5);
  ideal_from_square.col(2) -= ideal_from_square.leftCols<2>() * begin;
  return ideal_from_square;
}

}  // namespace ellipse
