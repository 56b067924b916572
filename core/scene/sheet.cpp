// SPDX-License-Identifier: MIT
#include "core/scene/sheet.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Projection = Eigen::Matrix<double, 3, 4>;

Matrix3d moved_frame(const Sheet& sheet, double time_s) {
  Matrix3d frame = sheet.frame;
  if (sheet.spin_rad_s != 0.0) {
    const Matrix2d turn = Eigen::Rotation2Dd(sheet.spin_rad_s * time_s).toRotationMatrix();
    frame.leftCols<2>() = (sheet.frame.leftCols<2>() * turn).eval();
  }
  frame.col(2) += sheet.swing.at(time_s);
  return frame;
}

// Maps the unit circle to the ellipse and keeps x to the right.
Matrix3d upright(const Ellipse& e) {
  const Matrix2d turn = Eigen::Rotation2Dd(e.angle_rad).toRotationMatrix();
  Matrix3d image_from_circle = Matrix3d::Identity();
  image_from_circle.topLeftCorner<2, 2>() =
      turn * Eigen::Vector2d(e.semi_major, e.semi_minor).asDiagonal() * turn.transpose();
  image_from_circle.topRightCorner<2, 1>() = e.center();
  return image_from_circle;
}

Matrix3d image_from_widths(const Camera& camera) {
  Matrix3d image;
  image << camera.width, 0.0, 0.5 * (camera.width - 1), 0.0, camera.width,
      0.5 * (camera.height - 1), 0.0, 0.0, 1.0;
  return image;
}

}  // namespace

Vector3d Swing::at(double time_s) const {
  if (reach.isZero(0.0)) return Vector3d::Zero();
  const double s = std::sin(2.0 * std::numbers::pi * time_s / period_s + phase_rad);
  return std::pow(s, power) * reach;
}

Projection image_from_world(const Matrix3d& image_from_pad, const Camera& camera) {
  const Matrix3d k = camera.matrix();
  Matrix3d axes = k.inverse() * image_from_pad;
  axes /= axes.col(0).norm();
  Projection world;
  world << k * axes.col(0), k * axes.col(1), k * axes.col(0).cross(axes.col(1)), k * axes.col(2);
  return world;
}

std::optional<Ellipse> project_ball(const Camera& camera,
                                    const Vector3d& from_camera,
                                    double radius) {
  const double rest = from_camera.squaredNorm() - radius * radius;
  if (!(rest > 0.0) || !(from_camera.z() > radius)) return std::nullopt;
  // A ray x touches the ball centred at c if (x . c)^2 = (|c|^2 - r^2) |x|^2: a cone,
  // hence a conic in the picture.
  const Matrix3d cone = from_camera * from_camera.transpose() - rest * Matrix3d::Identity();
  const Matrix3d inverse = camera.matrix().inverse();
  return from_conic(inverse.transpose() * cone * inverse);
}

std::optional<Matrix3d> image_from_sheet(const Sheet& sheet,
                                         const Matrix3d& image_from_pad,
                                         const Camera& camera,
                                         double time_s) {
  Matrix3d frame = moved_frame(sheet, time_s);
  if (sheet.anchor == Anchor::kPicture) {
    frame.row(2) << 0.0, 0.0, 1.0;
    return image_from_widths(camera) * frame;
  }
  const Projection world = image_from_world(image_from_pad, camera);
  if (sheet.ball_radius > 0.0) {
    const Vector3d origin = world * frame.col(2).homogeneous();
    const auto outline =
        project_ball(camera, camera.matrix().inverse() * origin, sheet.ball_radius);
    if (!outline) return std::nullopt;
    return upright(*outline);
  }
  // On the ground, the pad's homography is exact, even without a known camera.
  if (frame.row(2).isZero(0.0)) {
    Matrix3d pad_from_sheet = frame;
    pad_from_sheet.row(2) << 0.0, 0.0, 1.0;
    return image_from_pad * pad_from_sheet;
  }
  Matrix3d image = world.leftCols<3>() * frame;
  image.col(2) += world.col(3);
  return image;
}

}  // namespace ellipse
