#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/camera/lens_view.hpp"

namespace ellipse {

/// A place of the pad's plane in the picture.
struct PadPlace {
  Eigen::Vector2d point;  ///< [px]
  Eigen::Matrix2d slope;  ///< Of the point, by its place on the pad.
};

/// How a picture shows a pad: through a view of its plane in the ideal plane, and from there
/// through the lens. A view alone is one without a lens. Borrows the lens.
struct PadView {
  PadView(const Eigen::Matrix3d& view, const LensView& through = {})  // NOLINT: see above
      : ideal_from_pad(view), lens(through) {}

  Eigen::Matrix3d ideal_from_pad;
  LensView lens;

  /// nullopt where the place is behind the camera, or is not shown by the lens.
  [[nodiscard]] std::optional<PadPlace> at(const Eigen::Vector2d& place) const;

  /// The pad's radius in the picture, about [px].
  [[nodiscard]] double radius_px() const;
};

}  // namespace ellipse
