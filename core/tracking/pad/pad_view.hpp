#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/camera/lens_view.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Image of a point on the pad's plane.
struct ProjectedPoint {
  Eigen::Vector2d point;  ///< [px]
  Eigen::Matrix2d slope;  ///< Jacobian of the point by its pad coordinates.
};

/// Projection of a pad into an image: a homography into the ideal plane, then the lens distortion.
/// A homography alone means no distortion. Borrows the lens.
struct PadView {
  PadView(const Eigen::Matrix3d& view, const LensView& through = {})  // NOLINT: see above
      : ideal_from_pad(view), lens(through) {}

  Eigen::Matrix3d ideal_from_pad;
  LensView lens;

  /// Projects a pad point; nullopt if it is behind the camera or outside the lens's range.
  [[nodiscard]] std::optional<ProjectedPoint> at(const Eigen::Vector2d& pad_point) const;

  /// Level of the image at a pad point; nullopt outside the image.
  [[nodiscard]] std::optional<float> level_at(const ImageView& luma,
                                              const Eigen::Vector2d& pad_point) const;

  /// Approximate radius of the pad in the image [px].
  [[nodiscard]] double radius_px() const;
};

}  // namespace ellipse
