#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "core/camera/lens_view.hpp"
#include "core/camera/picture.hpp"
#include "core/geometry/homography.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Projection of a pad into an image: a homography into the ideal plane, then the lens distortion.
/// A homography alone means no distortion. Borrows the lens.
struct PadView {
  PadView(const Eigen::Matrix3d& view, const LensView& through = {})  // NOLINT: see above
      : ideal_from_pad(view), lens(through) {}

  /// The projection into a picture that is a part of a frame.
  /// @param view  Into the frame's ideal plane.
  [[nodiscard]] static PadView in(const Picture& picture, const Eigen::Matrix3d& view) {
    return {translated(view, -picture.origin_px), picture.lens};
  }

  Eigen::Matrix3d ideal_from_pad;
  LensView lens;

  /// Projects a pad point; nullopt if it is behind the camera or outside the lens's range.
  [[nodiscard]] std::optional<ProjectedPoint> at(const Eigen::Vector2d& pad_point) const;

  /// Level of the image at a pad point (x, y); NaN outside the image.
  /// @param projected  ideal_from_pad * (x, y, 1): linear in x and y, so that a line of pad points
  ///                   needs one addition per point.
  [[nodiscard]] float level_at(const ImageView& luma, const Eigen::Vector3d& projected) const {
    const float outside = std::numeric_limits<float>::quiet_NaN();
    if (!is_in_front(ideal_from_pad, projected)) return outside;
    Eigen::Vector2d point = projected.head<2>() / projected.z();
    if (lens.is_distorted()) {
      const auto shown = lens.picture_from_ideal(point);
      if (!shown) return outside;
      point = shown->picture_px;
    }
    const Eigen::Vector2f rounded = point.cast<float>();
    const bool is_inside = rounded.x() >= 0.0F && rounded.y() >= 0.0F &&
                           rounded.x() < static_cast<float>(luma.width - 1) &&
                           rounded.y() < static_cast<float>(luma.height - 1);
    return is_inside ? luma.at(rounded.x(), rounded.y()) : outside;
  }

  /// Approximate radius of the pad in the image [px].
  [[nodiscard]] double radius_px() const;
};

}  // namespace ellipse
