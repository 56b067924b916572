#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"

namespace evaluate {

/// A frame that a lens distorts. Truth and judgement are of its ideal plane [px], in which the
/// frame is no rectangle. A value that does not change: thread-safe.
class DistortedFrame {
 public:
  /// Looks up each pixel's place in the ideal plane.
  explicit DistortedFrame(const ellipse::Camera& camera);

  [[nodiscard]] const ellipse::Lens& lens() const { return lens_; }

  /// Intersection over union of two ellipses of the ideal plane, by the frame's pixels that lie in
  /// both and in either; 0 where both miss it. O(pixels).
  [[nodiscard]] double iou(const ellipse::Ellipse& a, const ellipse::Ellipse& b) const;

  /// The ellipse of the ideal plane that looks most like this one in the picture. Where the lens
  /// does not show enough of it, it stays what it is.
  [[nodiscard]] ellipse::Ellipse to_ideal(const ellipse::Ellipse& in_picture) const;

  /// The ellipse in the picture that looks most like this one of the ideal plane. nullopt where the
  /// lens does not show enough of it.
  [[nodiscard]] std::optional<ellipse::Ellipse> to_picture(const ellipse::Ellipse& ideal) const;

 private:
  ellipse::Lens lens_;
  std::vector<Eigen::Vector2f> ideal_px_;  // of the pixels that the lens shows
};

}  // namespace evaluate
