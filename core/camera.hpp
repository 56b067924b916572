#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/ellipse.hpp"

namespace ellipse {

/// How a lens departs from a pinhole.
enum class LensModel {
  kBrownConrady,  ///< Rational radial and tangential: k1, k2, p1, p2, k3, k4, k5, k6.
  kFisheye,       ///< Kannala-Brandt: k1, k2, k3, k4.
};

/// A camera's intrinsics and its lens. A value.
///
/// The ideal plane is the picture that a lens without distortion would show with the same fx, fy,
/// cx, cy: there circles are ellipses. Pixels as everywhere: the centre of the first one is (0, 0).
struct Camera {
  int width = 0;   ///< Of the pictures that it was calibrated with [px].
  int height = 0;  ///< [px]
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;  ///< Principal point [px].
  double cy = 0.0;
  LensModel lens = LensModel::kBrownConrady;
  std::array<double, 8> distortion{};  ///< In the order of the model; the rest is 0.

  /// A pinhole with its principal point in the middle.
  [[nodiscard]] static Camera with_hfov(double hfov_rad, int width, int height);

  /// Whether the picture is not the ideal plane.
  [[nodiscard]] bool is_distorted() const;

  /// The same camera with its pictures resampled to another size, in both directions by itself.
  [[nodiscard]] Camera resized(int new_width, int new_height) const;

  /// K: the ideal plane [px] from directions (x / z, y / z, 1).
  [[nodiscard]] Eigen::Matrix3d matrix() const;

  /// Throws std::invalid_argument that names the field.
  void validate() const;

  bool operator==(const Camera&) const = default;
};

/// Where a lens puts a point of the ideal plane.
struct LensPoint {
  Eigen::Vector2d picture_px;
  Eigen::Matrix2d slope;  ///< Of picture_px, by the point in the ideal plane.
};

/// A camera's way between the picture and the ideal plane. A value; thread-safe; allocates nothing.
class Lens {
 public:
  explicit Lens(const Camera& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }

  /// nullopt beyond what the lens maps one to one: farther out its polynomial turns back.
  [[nodiscard]] std::optional<LensPoint> picture_from_ideal(const Eigen::Vector2d& ideal_px) const;

  /// Within 1e-9 px of the inverse, by Newton's method; nullopt where there is none.
  [[nodiscard]] std::optional<Eigen::Vector2d> ideal_from_picture(
      const Eigen::Vector2d& picture_px) const;

 private:
  Camera camera_;
  double largest_squared_ = 0.0;  // radius of the ideal plane that is mapped one to one; focal
  double largest_picture_ = 0.0;  // length 1. And where the lens puts it.
};

/// An ellipse of the ideal plane as the lens bends it: points around it from the end of its major
/// axis on, at even anomalies [px of the picture]. Those that the lens does not show are NaN.
void bent_outline(const Lens& lens, const Ellipse& ideal, std::span<Eigen::Vector2d> points_px);

/// The ellipse of the ideal plane that the lens bends into what looks like this one in the picture,
/// by direct least squares. nullopt where the lens does not show enough of it. Allocates nothing.
[[nodiscard]] std::optional<Ellipse> unbent(const Lens& lens, const Ellipse& in_picture);

}  // namespace ellipse
