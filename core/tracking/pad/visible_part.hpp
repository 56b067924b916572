#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// The visible part of a pad's plane, excluding a margin at the image border. Borrows the view.
/// Allocates nothing.
class VisiblePart {
 public:
  VisiblePart(const PadView& view, const ImageView& luma);

  [[nodiscard]] bool has(const Eigen::Vector2d& pad_point) const {
    const bool is_within =
        ((borders_.leftCols<2>() * pad_point + borders_.col(2)).array() >= 0.0).all();
    return is_within || (view_.lens.is_distorted() && is_visible_distorted(pad_point));
  }

  /// Whether a whole circle around the pad's centre is within the undistorted inner rectangle.
  [[nodiscard]] bool has_circle(double radius) const {
    const Eigen::Array4d nearest =
        borders_.col(2) - radius * borders_.leftCols<2>().rowwise().norm();
    return (nearest >= 0.0).all();
  }

  /// The visible part of a line, parameterized from 0 to 1; empty if end <= begin. With distortion
  /// accurate to 1/256 of the line, and empty for a line outside the undistorted inner rectangle.
  [[nodiscard]] Interval clip(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  [[nodiscard]] bool is_visible_distorted(const Eigen::Vector2d& pad_point) const;
  [[nodiscard]] double farthest(const Eigen::Vector2d& from,
                                const Eigen::Vector2d& to,
                                double inside,
                                double end) const;

  const PadView& view_;
  double right_px_;  // last visible column
  double bottom_px_;
  Eigen::Matrix<double, 4, 3> borders_;  // inside where b . (x, y, 1) >= 0 for all four
};

}  // namespace ellipse
