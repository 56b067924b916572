#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <vector>

#include "core/camera/camera.hpp"

namespace ellipse {

/// A picture's way into the ideal plane, block by block: in each block the lens is the homography
/// that is exact at its four corners. Neighbours therefore meet, and at the blocks' size the rest
/// of the distortion is below .01 px, as far out as 69 degrees from the axis at 640 x 360.
class LensMap {
 public:
  static constexpr int kBlock = 4;  ///< Pixels.

  /// Allocates, and looks up each corner: O(pixels).
  explicit LensMap(const Camera& camera);

  [[nodiscard]] const Lens& lens() const { return lens_; }

  /// Whether the lens shows something in the whole block.
  [[nodiscard]] bool is_shown(int column, int row) const;

  /// To pixels of the ideal plane, up to a positive factor, from those of the picture. Of a block
  /// that is shown. Thread-safe; allocates nothing.
  [[nodiscard]] Eigen::Matrix3d ideal_from_picture(int column, int row) const;

 private:
  [[nodiscard]] const Eigen::Vector2d& corner(int column, int row) const;

  Lens lens_;
  int corners_across_;
  std::vector<Eigen::Vector2d>
      corners_;  // of the blocks, in the ideal plane; NaN where there is none
};

}  // namespace ellipse
