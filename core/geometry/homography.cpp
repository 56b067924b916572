// SPDX-License-Identifier: MIT
#include "core/geometry/homography.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix3d generator_of(const HomographyChange& d) {
  Matrix3d a;
  a << d(2) + d(3), d(4) - d(5), d(0) + d(6),  //
      d(4) + d(5), d(2) - d(3), d(1) + d(7),   //
      d(6), d(7), 0.0;
  return a;
}

// Changes are small: the first omitted term is below 1.1e-3 of the change for |A| < 0.6.
Matrix3d exponential(const Matrix3d& a) {
  const Matrix3d squared = a * a;
  return Matrix3d::Identity() + a + squared / 2.0 + squared * a / 6.0 + squared * squared / 24.0;
}

}  // namespace

Matrix3d image_from_pad(const Ellipse& outer_edge) {
  const double c = std::cos(outer_edge.angle_rad);
  const double s = std::sin(outer_edge.angle_rad);
  Matrix3d affine;
  affine << outer_edge.semi_major * c, -outer_edge.semi_minor * s, outer_edge.cx,
      outer_edge.semi_major * s, outer_edge.semi_minor * c, outer_edge.cy, 0.0, 0.0, 1.0;
  return affine;
}

std::optional<Ellipse> project_circle(const Matrix3d& image_from_pad, double radius) {
  // The circle is in front of the camera if the third row is positive all along it.
  const Eigen::RowVector3d depth = image_from_pad.row(2);
  if (!(depth(2) > radius * depth.head<2>().norm())) return std::nullopt;
  const Matrix3d pad_from_image = image_from_pad.inverse();
  const Vector3d circle(1.0, 1.0, -radius * radius);
  // Conics map as C' = H^-T C H^-1 [HartleyZisserman2004] 2.3.
  return from_conic(pad_from_image.transpose() * circle.asDiagonal() * pad_from_image);
}

std::optional<Matrix3d> with_circle(const Matrix3d& image_from_pad,
                                    const Ellipse& image,
                                    double radius) {
  // The ellipse in pad coordinates: conics map as C = H^T C' H [HartleyZisserman2004] 2.3.
  const auto on_pad = from_conic(image_from_pad.transpose() * conic_matrix(image) * image_from_pad);
  if (!on_pad) return std::nullopt;
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(on_pad->angle_rad).toRotationMatrix();
  Matrix3d stretch = Matrix3d::Identity();
  stretch.topLeftCorner<2, 2>() = axes *
                                  Vector2d(on_pad->semi_major, on_pad->semi_minor).asDiagonal() *
                                  axes.transpose() / radius;
  stretch.topRightCorner<2, 1>() = on_pad->center();
  const Matrix3d view = image_from_pad * stretch;
  return view / view(2, 2);
}

Matrix3d moved(const Matrix3d& image_from_pad, const HomographyChange& change) {
  const Matrix3d view = image_from_pad * exponential(generator_of(change));
  return view / view(2, 2);
}

Matrix3d translated(const Matrix3d& image_from_pad, const Eigen::Vector2d& by_px) {
  Matrix3d result = image_from_pad;
  result.topRows<2>() += by_px * image_from_pad.row(2);
  return result;
}

Matrix3d without_perspective(const Matrix3d& image_from_pad) {
  Matrix3d affine = image_from_pad;
  affine.topLeftCorner<2, 2>() -= affine.topRightCorner<2, 1>() * affine.row(2).head<2>();
  affine.row(2) = Eigen::RowVector3d(0.0, 0.0, 1.0);
  const auto outer = project_circle(image_from_pad, 1.0);
  return outer ? with_circle(affine, *outer).value_or(image_from_pad) : image_from_pad;
}

HomographyChange change_between(const Matrix3d& from, const Matrix3d& to) {
  const Matrix3d change = from.inverse() * to;
  return change_of(change / change(2, 2) - Matrix3d::Identity());
}

HomographyChange change_of(const Matrix3d& generator) {
  const Matrix3d a = generator - generator(2, 2) * Matrix3d::Identity();
  HomographyChange d;
  d << a(0, 2) - a(2, 0), a(1, 2) - a(2, 1), 0.5 * (a(0, 0) + a(1, 1)), 0.5 * (a(0, 0) - a(1, 1)),
      0.5 * (a(0, 1) + a(1, 0)), 0.5 * (a(1, 0) - a(0, 1)), a(2, 0), a(2, 1);
  return d;
}

RingMatrix ring_jacobian(const Matrix3d& from_view, const Matrix3d& to_view) {
  const Matrix3d between = to_view.inverse() * from_view;
  const Matrix3d back = between.inverse();
  RingMatrix changes;
  for (int i = 0; i < 5; ++i) {
    changes.col(i) = change_of(between * generator_of(HomographyChange::Unit(i)) * back).head<5>();
  }
  return changes;
}

// With image = c + M (I + [S+E1, E2; E2, S-E1]) (x + T), M = R diag(a, b): dc = M T, da = a (S +
// E1), db = b (S - E1), and the axes turn by 2 a b E2 / (a^2 - b^2).
RingMatrix parameter_covariance(const Ellipse& e, const RingUncertainty& edge) {
  const double a = e.semi_major;
  const double b = e.semi_minor;
  const Matrix3d view = image_from_pad(e);
  RingMatrix parameters = RingMatrix::Zero();
  parameters.topLeftCorner<2, 2>() = view.topLeftCorner<2, 2>();
  parameters.row(2) << 0.0, 0.0, a, a, 0.0;
  parameters.row(3) << 0.0, 0.0, b, -b, 0.0;
  parameters(4, 4) = 1.0;
  const RingMatrix jacobian = parameters * ring_jacobian(edge.view, view);
  const RingMatrix changes = edge.information.ldlt().solve(RingMatrix::Identity());
  RingMatrix covariance = jacobian * changes * jacobian.transpose();
  const double difference = a * a - b * b;
  // An unknown angle is uniform over half a turn.
  const double max_turn = std::numbers::pi / std::sqrt(12.0 * covariance(4, 4));
  const double turn = 2.0 * a * b < max_turn * difference ? 2.0 * a * b / difference : max_turn;
  covariance.row(4) *= turn;
  covariance.col(4) *= turn;
  return covariance;
}

// With H = K [r1 r2 t], G = K^-1 H: a motion of the camera changes G to (I + [w]x) G + v e3^T.
Eigen::Matrix<double, 8, 6> change_by_camera(const Matrix3d& image_from_pad,
                                             const Matrix3d& camera_matrix) {
  Matrix3d g = camera_matrix.inverse() * image_from_pad;
  g /= std::sqrt(0.5 * g.leftCols<2>().squaredNorm());
  const Matrix3d inverse = g.inverse();
  Eigen::Matrix<double, 8, 6> changes;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d unit = Vector3d::Unit(axis);
    Matrix3d turn;
    turn << 0.0, -unit.z(), unit.y(), unit.z(), 0.0, -unit.x(), -unit.y(), unit.x(), 0.0;
    changes.col(axis) = change_of(inverse * turn * g);
    changes.col(3 + axis) = change_of(inverse * unit * Eigen::RowVector3d::UnitZ());
  }
  return changes;
}

std::optional<ProjectedPoint> project_point(const Matrix3d& h, const Vector2d& pad_point) {
  const Vector3d projected = h * pad_point.homogeneous();
  if (!is_in_front(h, projected)) return std::nullopt;
  const Vector2d point = projected.hnormalized();
  return ProjectedPoint{
      point, (h.topLeftCorner<2, 2>() - point * h.bottomLeftCorner<1, 2>()) / projected.z()};
}

std::optional<EdgeView> view_of(const Matrix3d& h,
                                const Vector2d& pad_point,
                                const Vector2d& normal) {
  const auto projected = project_point(h, pad_point);
  if (!projected) return std::nullopt;
  EdgeView view;
  view.point = projected->point;
  const Vector2d across = projected->slope.inverse().transpose() * normal;
  view.px_per_unit = 1.0 / across.norm();
  view.normal = view.px_per_unit * across;
  const double x = pad_point.x();
  const double y = pad_point.y();
  const double outwards = normal.dot(pad_point);
  view.row << normal, outwards, normal.x() * x - normal.y() * y, normal.x() * y + normal.y() * x,
      normal.y() * x - normal.x() * y, normal - outwards * pad_point;
  view.row *= view.px_per_unit;
  return view;
}

}  // namespace ellipse
