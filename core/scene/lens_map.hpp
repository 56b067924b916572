#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <vector>

#include "core/camera/camera.hpp"

namespace ellipse {

/// Maps a picture to the ideal plane by one homography per block, which is exact at the block's
/// four corners. The map is therefore continuous, and its residual distortion is below .01 px up to
/// 69 degrees from the axis at 640 x 360.
class LensMap {
 public:
  static constexpr int kBlock = 4;  ///< Pixels.

  /// Allocates; maps each corner: O(pixels).
  explicit LensMap(const Camera& camera);

  [[nodiscard]] const Lens& lens() const { return lens_; }

  /// Whether the lens maps the whole block.
  [[nodiscard]] bool is_shown(int column, int row) const;

  /// Homography from pixels of the picture to those of the ideal plane, up to a positive factor.
  /// Only for blocks with is_shown(). Thread-safe; allocates nothing.
  [[nodiscard]] Eigen::Matrix3d ideal_from_picture(int column, int row) const;

 private:
  [[nodiscard]] const Eigen::Vector2d& corner(int column, int row) const;

  Lens lens_;
  int corners_across_;
  std::vector<Eigen::Vector2d> corners_;  // of the blocks, in the ideal plane; NaN if unmapped
};

}  // namespace ellipse
