#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <vector>

#include "core/scene/sheet.hpp"

// Shapes and frames for wild scenes.
namespace ellipse::wild {

[[nodiscard]] Shape disc(const Eigen::Vector2d& center, double radius, const Paint& paint);
[[nodiscard]] Shape polygon(const std::vector<Eigen::Vector2d>& corners,
                            const Paint& paint,
                            double rounding = 0.0);
/// @param rounding  Radius of the corners.
[[nodiscard]] Shape box(const Eigen::Vector2d& center,
                        const Eigen::Vector2d& half_size,
                        double turn_rad,
                        const Paint& paint,
                        double rounding = 0.0);
[[nodiscard]] Shape stroke(const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to,
                           double width,
                           const Paint& paint);
/// Its corners lie on the unit circle.
[[nodiscard]] std::vector<Eigen::Vector2d> regular_corners(int count, double turn_rad);
/// Wires of a mesh with square openings of this size, sheared by an angle.
[[nodiscard]] Shape mesh(double spacing, double wire_width, double shear_rad, const Paint& paint);
/// An irregular blot that deviates from any ellipse by at least 20 %.
[[nodiscard]] Shape blot(const Eigen::Vector2d& center,
                         double radius,
                         const Paint& paint,
                         std::uint64_t seed);

/// One of "HX0123456789", made of straight bars. It extends one unit above and below its middle.
[[nodiscard]] std::vector<Shape> glyph(char letter, double bar_width, const Paint& paint);
/// Moves, turns and scales shapes on their sheet.
void place(std::vector<Shape>& shapes, const Eigen::Vector2d& to, double scale, double turn_rad);

/// A frame on the ground, or level above it.
[[nodiscard]] Eigen::Matrix3d level_frame(const Eigen::Vector3d& at, double scale, double turn_rad);
/// An upright frame: x horizontal, left to right as seen from an azimuth, y down.
[[nodiscard]] Eigen::Matrix3d upright_frame(const Eigen::Vector3d& at,
                                            double scale,
                                            double azimuth_rad);

}  // namespace ellipse::wild
