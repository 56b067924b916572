#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/scene/deformation.hpp"
#include "core/scene/shape.hpp"

namespace ellipse {

/// A periodic motion around a position: sin(2 pi t / period + phase), to a power.
struct Swing {
  Eigen::Vector3d reach{0.0, 0.0, 0.0};
  double period_s = 4.0;
  double phase_rad = 0.0;
  int power = 1;  ///< An even power moves to one side only; a high one gives short pulses.

  [[nodiscard]] Eigen::Vector3d at(double time_s) const;
};

/// The reference of a sheet's frame.
enum class Anchor {
  kWorld,    ///< The pad's frame: x and y on the ground, z up [radii].
  kPicture,  ///< The picture: x right, y down from its middle [widths of the picture]; no z.
};

/// A flat sheet with shapes on it, or a ball. A value.
struct Sheet {
  Anchor anchor = Anchor::kWorld;
  /// Its x axis, its y axis and its origin, as columns.
  Eigen::Matrix3d frame = (Eigen::Matrix3d() << 1, 0, 0, 0, 1, 0, 0, 0, 0).finished();
  /// Above 0: a ball about the origin. The sheet is then the disc inside the ball's outline in the
  /// picture. The outline is the unit circle of its frame, x right, y down.
  double ball_radius = 0.0;
  Swing swing;
  double spin_rad_s = 0.0;  ///< Turns its axes.
  std::vector<Fold> folds;
  double defocus_px = 0.0;    ///< Standard deviation of its blur, besides the lens blur.
  std::vector<Shape> shapes;  ///< Each covers the ones before.
};

/// View of a sheet by a rolling shutter, row by row.
struct SheetView {
  Eigen::Matrix3d sheet_from_image = Eigen::Matrix3d::Identity();  ///< At row 0.
  Eigen::Matrix3d per_row = Eigen::Matrix3d::Zero();               ///< Its change from row to row.

  [[nodiscard]] Eigen::Matrix3d at_row(double y) const { return sheet_from_image + y * per_row; }
  [[nodiscard]] bool is_rolling() const { return !per_row.isZero(0.0); }
};

/// Projection from the world to the ideal plane: the images of the axes and the origin as columns.
/// @param image_from_pad  Of this camera, up to a positive factor.
[[nodiscard]] Eigen::Matrix<double, 3, 4> image_from_world(const Eigen::Matrix3d& image_from_pad,
                                                           const Camera& camera);

/// A sheet in the ideal plane at a time; nullopt for a ball that is not in front of the camera.
[[nodiscard]] std::optional<Eigen::Matrix3d> image_from_sheet(const Sheet& sheet,
                                                              const Eigen::Matrix3d& image_from_pad,
                                                              const Camera& camera,
                                                              double time_s);

/// The outline of a ball in the ideal plane. nullopt if it is not an ellipse.
/// @param from_camera  The ball's middle: x right, y down, z ahead.
[[nodiscard]] std::optional<Ellipse> project_ball(const Camera& camera,
                                                  const Eigen::Vector3d& from_camera,
                                                  double radius);

}  // namespace ellipse
