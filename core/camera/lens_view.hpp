#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Lens distortion of a cropped or reduced frame: maps between the picture's pixels and those of
/// its ideal plane, which is cropped and reduced alike.
///
/// Without a lens (default) the picture is the ideal plane. A value; borrows the lens.
class LensView {
 public:
  LensView() = default;
  /// For whole frames. A lens without distortion is treated as none.
  LensView(const Lens& lens);  // NOLINT(google-explicit-constructor): a lens is a view of itself

  /// For the part of this picture that begins at a pixel.
  [[nodiscard]] LensView part(const Eigen::Vector2d& origin_px) const;
  /// For this picture at 1 / scale of its size, in the convention of ellipse::scaled().
  [[nodiscard]] LensView reduced(int scale) const;

  /// Whether the picture differs from the ideal plane. If not, all maps below are the identity.
  [[nodiscard]] bool is_distorted() const { return lens_ != nullptr; }

  /// As in Lens.
  [[nodiscard]] std::optional<LensPoint> picture_from_ideal(const Eigen::Vector2d& ideal_px) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> ideal_from_picture(
      const Eigen::Vector2d& picture_px) const;

  /// As in Lens; samples are relative to a pixel. Does nothing without a lens.
  void distort(const Eigen::Vector2d& origin_px, const CurveSamples& samples) const;

  /// As ideal_from_picture(), from a table: within .01 px of the picture; NaN if out of range.
  [[nodiscard]] Eigen::Vector2d approximate_ideal(const Eigen::Vector2d& picture_px) const;

 private:
  [[nodiscard]] Eigen::Vector2d in_frame(const Eigen::Vector2d& px) const {
    return origin_px_ + scale_ * px;
  }
  [[nodiscard]] Eigen::Vector2d in_picture(const Eigen::Vector2d& frame_px) const {
    return (frame_px - origin_px_) / scale_;
  }

  const Lens* lens_ = nullptr;
  Eigen::Vector2d origin_px_{0.0, 0.0};  // position of pixel (0, 0) in the frame
  double scale_ = 1.0;                   // frame pixels per pixel
};

/// Share of the perimeter inside a picture, by length in the distorted picture.
[[nodiscard]] double visible_fraction(const LensView& lens,
                                      const Ellipse& ideal,
                                      int width,
                                      int height);

/// Distorts an ellipse of the ideal plane: points at even anomalies, starting on its major axis [px
/// of the picture]. Points outside the lens's range are NaN.
void distorted_outline(const LensView& lens,
                       const Ellipse& ideal,
                       std::span<Eigen::Vector2d> points_px);

/// The ellipse that best approximates the distorted outline of this one, by direct least squares.
/// nullopt unless all of it is in the lens's range. Allocates nothing.
[[nodiscard]] std::optional<Ellipse> distorted(const LensView& lens, const Ellipse& ideal);

/// The inverse: fits an ellipse of the ideal plane to the undistorted outline of this one. nullopt
/// if less than a quarter of it can be undistorted. Allocates nothing.
[[nodiscard]] std::optional<Ellipse> undistorted(const LensView& lens, const Ellipse& in_picture);

}  // namespace ellipse
