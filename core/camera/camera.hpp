#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

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

/// Samples of a curve, and its unit normals, in single precision. Borrowed.
struct CurveSamples {
  std::size_t count = 0;
  float* x = nullptr;
  float* y = nullptr;
  float* nx = nullptr;
  float* ny = nullptr;
  float* px_per_ideal = nullptr;        ///< Written: pixels of the picture per one of the ideal
                                        ///< plane, of moves of the curve along its normal;
  float* px_per_ideal_along = nullptr;  ///< and of lengths along the curve.

  static constexpr float kNowhere = 1e8F;  ///< Outside of any picture.
};

/// A camera's way between the picture and the ideal plane. A value; thread-safe; allocates nothing.
class Lens {
 public:
  explicit Lens(const Camera& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }

  /// nullopt beyond what the lens maps one to one: farther out its polynomial turns back.
  [[nodiscard]] std::optional<LensPoint> picture_from_ideal(const Eigen::Vector2d& ideal_px) const;

  /// A curve of the ideal plane becomes what the lens makes of it, within 1e-6 of the picture's
  /// size; what the lens does not show goes to kNowhere.
  /// @param origin_px, scale  A place p of the curve is pixel origin + scale p, before and after.
  void distort(const Eigen::Vector2d& origin_px, double scale, const CurveSamples& places) const;

  /// Within 1e-9 px of the inverse, by Newton's method; nullopt where there is none.
  [[nodiscard]] std::optional<Eigen::Vector2d> ideal_from_picture(
      const Eigen::Vector2d& picture_px) const;

  /// The same from a table: within .01 px of the picture, up to 80 degrees from the axis. NaN
  /// where there is none, and beyond pictures of the camera's size.
  [[nodiscard]] Eigen::Vector2d near_ideal(const Eigen::Vector2d& picture_px) const;

 private:
  static constexpr std::size_t kTableSize = 1024;

  void make_table();
  [[nodiscard]] Eigen::Vector2d from_table(const Eigen::Vector2d& distorted) const;

  [[nodiscard]] Eigen::Vector2d ray(const Eigen::Vector2d& px) const {
    return (px - middle_).cwiseProduct(inverse_focal_);
  }
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector2d& at) const {
    return at.cwiseProduct(focal_) + middle_;
  }

  Camera camera_;
  Eigen::Vector2d focal_;
  Eigen::Vector2d inverse_focal_;
  Eigen::Vector2d middle_;
  double largest_squared_ = 0.0;  // radius of the ideal plane that is mapped one to one; focal
  double largest_picture_ = 0.0;  // length 1. And where the lens puts it.
  double table_scale_ = 0.0;      // places in the table, by the squared radius in the picture
  std::array<float, kTableSize + 2> table_{};  // radius in the ideal plane over that in the picture
};

}  // namespace ellipse
