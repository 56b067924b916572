#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/ellipse.hpp"

namespace ellipse {

// Projection of a pad's plane: (u, v, 1) ~ H (x, y, 1). On the pad the origin is the centre of its
// outer circle and the unit is its radius; in the image the unit is the pixel.

/// The affine view that maps the outer circle exactly to this ellipse.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Ellipse& outer_edge);

/// Exact projection of a circle around the pad's centre. nullopt if it is not an ellipse, such as
/// when part of it is behind the camera.
[[nodiscard]] std::optional<Ellipse> project_circle(const Eigen::Matrix3d& image_from_pad,
                                                    double radius);

/// Adjusts a view to map a circle around the pad's centre exactly to this ellipse, by a shift and a
/// symmetric stretch in the pad's plane, without rotation. nullopt if the ellipse has no such
/// preimage.
[[nodiscard]] std::optional<Eigen::Matrix3d> with_circle(const Eigen::Matrix3d& image_from_pad,
                                                         const Ellipse& image,
                                                         double radius = 1.0);

/// A small change of a view, in pad units: H becomes H exp(A) with
/// A = [S+E1, E2-R, T1+B1; E2+R, S-E1, T2+B2; B1, B2, 0].
/// T (0, 1) shifts, S (2) scales and E (3, 4) stretches the outer circle; R (5) rotates and
/// B (6, 7) tilts the pad within it. Not singular at a circle.
using HomographyChange = Eigen::Matrix<double, 8, 1>;
using HomographyCovariance = Eigen::Matrix<double, 8, 8>;

/// Variance of row . x, where x has this covariance. lazyProduct() is Eigen's faster product for
/// matrices of this size.
[[nodiscard]] inline double variance_along(const HomographyChange& row,
                                           const HomographyCovariance& covariance) {
  return row.dot(covariance.lazyProduct(row));
}

/// The view after a change with the generator A: H exp(A) to fourth order, scaled to H(2, 2) = 1.
[[nodiscard]] Eigen::Matrix3d moved(const Eigen::Matrix3d& image_from_pad,
                                    const HomographyChange& change);

/// The view of the same pad, shifted in the image.
[[nodiscard]] Eigen::Matrix3d translated(const Eigen::Matrix3d& image_from_pad,
                                         const Eigen::Vector2d& by_px);

/// The affine view with the same image of the outer circle; the view itself if this image is not
/// an ellipse. Needs H(2, 2) = 1.
[[nodiscard]] Eigen::Matrix3d without_perspective(const Eigen::Matrix3d& image_from_pad);

/// The change that moves one view to another, to first order; exact for a shift.
[[nodiscard]] HomographyChange change_between(const Eigen::Matrix3d& from,
                                              const Eigen::Matrix3d& to);

/// The change with this generator A, up to a multiple of the identity matrix.
[[nodiscard]] HomographyChange change_of(const Eigen::Matrix3d& generator);

/// T, S and E, the part of a change that moves the outer circle, and a matrix over them.
using RingChange = Eigen::Matrix<double, 5, 1>;
using RingMatrix = Eigen::Matrix<double, 5, 5>;

/// Uncertainty of the image of an outer circle.
struct RingUncertainty {
  /// A view that maps the outer circle to this image.
  Eigen::Matrix3d view = Eigen::Matrix3d::Identity();
  /// Inverse covariance of T, S and E in this view.
  RingMatrix information = RingMatrix::Zero();
};

/// Covariance of an ellipse's parameters: x and y of its centre, semi-major and semi-minor axis
/// [px], angle [rad], in this order; to first order. The angle's variance is at most pi^2 / 12,
/// that of an unknown angle, as for a circle.
/// @param edge  Uncertainty of this ellipse as the image of an outer circle.
[[nodiscard]] RingMatrix parameter_covariance(const Ellipse& e, const RingUncertainty& edge);

/// Jacobian of T, S and E from one view to another with the same image of the outer circle.
[[nodiscard]] RingMatrix ring_jacobian(const Eigen::Matrix3d& from_view,
                                       const Eigen::Matrix3d& to_view);

/// Jacobian of a view by camera motion: columns are rotations about the axes x, y, z [rad] and
/// shifts along them [radii of the pad].
/// @param camera_matrix  K [HartleyZisserman2004] 6.1.
[[nodiscard]] Eigen::Matrix<double, 8, 6> change_by_camera(const Eigen::Matrix3d& image_from_pad,
                                                           const Eigen::Matrix3d& camera_matrix);

/// Whether a point of the pad is in front of the camera.
/// @param projected  image_from_pad times the point.
[[nodiscard]] inline bool is_in_front(const Eigen::Matrix3d& image_from_pad,
                                      const Eigen::Vector3d& projected) {
  const double rounding = std::numeric_limits<float>::epsilon();
  return projected.z() > rounding * std::abs(image_from_pad(2, 2));
}

/// Image of a point on the pad's plane.
struct ProjectedPoint {
  Eigen::Vector2d point;  ///< [px]
  Eigen::Matrix2d slope;  ///< Jacobian of the point by its pad coordinates.
};

/// nullopt if the point is behind the camera.
[[nodiscard]] std::optional<ProjectedPoint> project_point(const Eigen::Matrix3d& image_from_pad,
                                                          const Eigen::Vector2d& pad_point);

/// Image of a point on an edge of the pad.
struct EdgeView {
  Eigen::Vector2d point;   ///< [px]
  Eigen::Vector2d normal;  ///< Unit normal of the edge.
  double px_per_unit;      ///< Displacement along `normal` per unit on the pad.
  HomographyChange row;    ///< Displacement along `normal` per unit of each component [px].
};

/// Projects a point on an edge of the pad.
/// @param normal  Unit normal of the edge on the pad.
/// @return nullopt if the point is behind the camera.
[[nodiscard]] std::optional<EdgeView> view_of(const Eigen::Matrix3d& image_from_pad,
                                              const Eigen::Vector2d& pad_point,
                                              const Eigen::Vector2d& normal);

}  // namespace ellipse
