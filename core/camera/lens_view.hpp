#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// What a lens does to a picture that is a part of the frame, or a reduced copy of one: the way
/// between the picture's pixels and those of its ideal plane, which is cut and reduced alike.
///
/// By default there is no lens: the picture is the ideal plane. A value; borrows the lens.
class LensView {
 public:
  LensView() = default;
  /// Of whole frames. A lens without distortion is as good as none.
  LensView(const Lens& lens);  // NOLINT(google-explicit-constructor): a lens is a view of itself

  /// Of the part of this picture that begins at a pixel.
  [[nodiscard]] LensView part(const Eigen::Vector2d& origin_px) const;
  /// Of this picture at 1 / scale of its size, as ellipse::scaled() reduces.
  [[nodiscard]] LensView reduced(int scale) const;

  /// Whether the picture is not the ideal plane. Where it is, all below changes nothing.
  [[nodiscard]] bool is_distorted() const { return lens_ != nullptr; }

  /// As of Lens.
  [[nodiscard]] std::optional<LensPoint> picture_from_ideal(const Eigen::Vector2d& ideal_px) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> ideal_from_picture(
      const Eigen::Vector2d& picture_px) const;

  /// As of Lens; places are counted from a pixel. Does nothing without a lens.
  void distort(const Eigen::Vector2d& origin_px, const CurveSamples& places) const;

  /// As ideal_from_picture(), from a table: within .01 px of the picture; NaN where there is none.
  [[nodiscard]] Eigen::Vector2d near_ideal(const Eigen::Vector2d& picture_px) const;

 private:
  [[nodiscard]] Eigen::Vector2d in_frame(const Eigen::Vector2d& px) const {
    return origin_px_ + scale_ * px;
  }
  [[nodiscard]] Eigen::Vector2d in_picture(const Eigen::Vector2d& frame_px) const {
    return (frame_px - origin_px_) / scale_;
  }

  const Lens* lens_ = nullptr;
  Eigen::Vector2d origin_px_{0.0, 0.0};  // of pixel (0, 0), in the frame
  double scale_ = 1.0;                   // pixels of the frame per pixel
};

/// Share of the perimeter inside a picture: of its length there, where the lens distorts it.
[[nodiscard]] double visible_fraction(const LensView& lens,
                                      const Ellipse& ideal,
                                      int width,
                                      int height);

/// An ellipse of the ideal plane as the lens distorts it: points around it from the end of its
/// major axis on, at even anomalies [px of the picture]. Those that the lens does not show are NaN.
void distorted_outline(const LensView& lens,
                       const Ellipse& ideal,
                       std::span<Eigen::Vector2d> points_px);

/// The ellipse that looks most like what the lens makes of this one, by direct least squares.
/// nullopt where the lens does not show all of it. Allocates nothing.
[[nodiscard]] std::optional<Ellipse> distorted(const LensView& lens, const Ellipse& ideal);

/// The inverse: the ellipse of the ideal plane that the lens distorts into what looks like this
/// one. nullopt where less than a quarter of it is such as the lens makes. Allocates nothing.
[[nodiscard]] std::optional<Ellipse> undistorted(const LensView& lens, const Ellipse& in_picture);

}  // namespace ellipse
