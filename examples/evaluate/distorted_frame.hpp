#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"

namespace evaluate {

/// A frame distorted by a lens. Truth and judgement use its ideal (undistorted) plane [px], in
/// which the frame is not a rectangle. Immutable and thread-safe.
class DistortedFrame {
 public:
  /// Computes the ideal position of each pixel.
  explicit DistortedFrame(const ellipse::Camera& camera);

  [[nodiscard]] const ellipse::Lens& lens() const { return lens_; }

  /// Intersection over union of two ellipses in the ideal plane, counted in the frame's pixels; 0
  /// if both are outside the frame. O(pixels).
  [[nodiscard]] double iou(const ellipse::Ellipse& a, const ellipse::Ellipse& b) const;

  /// The ellipse in the ideal plane that best fits this ellipse of the distorted picture. Returns
  /// the input if too little of it is inside the lens's field of view.
  [[nodiscard]] ellipse::Ellipse to_ideal(const ellipse::Ellipse& in_picture) const;

  /// The ellipse in the distorted picture that best fits this ellipse of the ideal plane. nullopt
  /// if too little of it is inside the lens's field of view.
  [[nodiscard]] std::optional<ellipse::Ellipse> to_picture(const ellipse::Ellipse& ideal) const;

 private:
  ellipse::Lens lens_;
  std::vector<Eigen::Vector2f> ideal_px_;  // of the pixels inside the lens's field of view
};

}  // namespace evaluate
