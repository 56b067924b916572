#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/geometry/ellipse.hpp"

namespace ellipse {

// A pad's plane seen by a camera: (u, v, 1) ~ H (x, y, 1). On the pad the unit is the radius of its
// outer circle, whose centre is the origin; in the picture it is the pixel.

/// The affine view in which the outer circle is exactly this ellipse.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Ellipse& outer_edge);

/// The exact picture of a circle about the pad's centre. nullopt where it is not an ellipse, such
/// as when part of it is behind the camera.
[[nodiscard]] std::optional<Ellipse> project_circle(const Eigen::Matrix3d& image_from_pad,
                                                    double radius);

/// The view next to this one in which the outer circle is exactly this ellipse: the pad is moved
/// and stretched in its own plane, and not turned. nullopt where the view shows no such ellipse.
[[nodiscard]] std::optional<Eigen::Matrix3d> with_outer_edge(const Eigen::Matrix3d& image_from_pad,
                                                             const Ellipse& outer_edge);

/// A small change of a view, in the pad's own measure: H becomes H exp(A) with
/// A = [S+E1, E2-R, T1+B1; E2+R, S-E1, T2+B2; B1, B2, 0].
/// T (0, 1) shifts, S (2) grows, E (3, 4) stretches the outer circle; R (5) turns and B (6, 7)
/// tilts the pad within it. Without a singularity at a circle.
using HomographyChange = Eigen::Matrix<double, 8, 1>;
using HomographyCovariance = Eigen::Matrix<double, 8, 8>;

[[nodiscard]] Eigen::Matrix3d moved(const Eigen::Matrix3d& image_from_pad,
                                    const HomographyChange& change);

/// The change whose A this is, but for a multiple of the unit matrix.
[[nodiscard]] HomographyChange change_of(const Eigen::Matrix3d& generator);

/// Of a change, what moves the outer circle: T, S and E.
using RingMatrix = Eigen::Matrix<double, 5, 5>;

/// How well the picture of an outer circle is known.
struct RingUncertainty {
  Eigen::Matrix3d view;    ///< One in which it is the outer circle.
  RingMatrix information;  ///< Inverse covariance of T, S and E in this view.
};

/// What T, S and E of one view are in another one with the same picture of the outer circle.
[[nodiscard]] RingMatrix ring_changes(const Eigen::Matrix3d& from_view,
                                      const Eigen::Matrix3d& to_view);

/// How a camera's own motion changes a view, to first order: columns are turns about its axes x, y,
/// z [rad] and shifts along them [radii of the pad].
/// @param camera_matrix  K [HartleyZisserman2004] 6.1.
[[nodiscard]] Eigen::Matrix<double, 8, 6> change_by_camera(const Eigen::Matrix3d& image_from_pad,
                                                           const Eigen::Matrix3d& camera_matrix);

/// A place on an edge of the pad, in the picture.
struct EdgeView {
  Eigen::Vector2d point;   ///< [px]
  Eigen::Vector2d normal;  ///< Unit, of the edge.
  double px_per_unit;      ///< By which the edge moves along it, per unit along the pad's normal.
  HomographyChange row;    ///< And per HomographyChange [px].
};

/// @param normal  Of the edge on the pad, unit.
/// nullopt where the place is behind the camera.
[[nodiscard]] std::optional<EdgeView> view_of(const Eigen::Matrix3d& image_from_pad,
                                              const Eigen::Vector2d& place,
                                              const Eigen::Vector2d& normal);

}  // namespace ellipse
