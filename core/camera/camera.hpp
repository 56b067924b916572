#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace ellipse {

/// Coordinate beyond any picture; also the largest size and focal length of a camera [px].
inline constexpr double kFarPx = 1e6;

/// Lens distortion model.
enum class LensModel {
  kBrownConrady,  ///< Rational radial and tangential: k1, k2, p1, p2, k3, k4, k5, k6.
  kFisheye,       ///< Kannala-Brandt: k1, k2, k3, k4.
};

/// A camera's intrinsics and its lens. A value.
///
/// The ideal plane is the undistorted image with the same fx, fy, cx, cy: in it, circles project to
/// ellipses. The centre of the first pixel is (0, 0), as everywhere.
struct Camera {
  int width = 0;   ///< Of the calibration images [px].
  int height = 0;  ///< [px]
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;  ///< Principal point [px].
  double cy = 0.0;
  LensModel lens = LensModel::kBrownConrady;
  std::array<double, 8> distortion{};  ///< In the order of the model, padded with 0.

  /// A pinhole with its principal point in the image centre.
  [[nodiscard]] static Camera with_hfov(double hfov_rad, int width, int height);

  /// Whether the picture differs from the ideal plane; always true for a fisheye.
  [[nodiscard]] bool is_distorted() const;

  /// The same camera for images resampled to another size, independently in both directions.
  [[nodiscard]] Camera resized(int new_width, int new_height) const;

  /// K: maps directions (x / z, y / z, 1) to the ideal plane [px].
  [[nodiscard]] Eigen::Matrix3d matrix() const;

  /// Throws std::invalid_argument that names the field.
  void validate() const;

  bool operator==(const Camera&) const = default;
};

/// Distorted image of a point in the ideal plane.
struct LensPoint {
  Eigen::Vector2d picture_px;
  Eigen::Matrix2d slope;  ///< Jacobian of picture_px by the point in the ideal plane.
};

/// Samples of a curve and their unit normals, in single precision. Borrowed.
struct CurveSamples {
  std::size_t count = 0;
  float* x = nullptr;
  float* y = nullptr;
  float* nx = nullptr;
  float* ny = nullptr;
  float* px_per_ideal = nullptr;        ///< Output: picture pixels per pixel of the ideal plane,
                                        ///< for displacements of the curve along its normal;
  float* px_per_ideal_along = nullptr;  ///< and for lengths along the curve.
};

/// Maps between a camera's picture and its ideal plane. A value; thread-safe; allocates nothing.
class Lens {
 public:
  explicit Lens(const Camera& camera);

  [[nodiscard]] const Camera& camera() const { return camera_; }

  /// Distorts a point; nullopt outside the range in which the distortion is one to one.
  [[nodiscard]] std::optional<LensPoint> picture_from_ideal(const Eigen::Vector2d& ideal_px) const;

  /// Distorts a curve in place, within 1e-6 of the picture's size. Samples outside the one-to-one
  /// range get the coordinates kFarPx.
  /// @param origin_px, scale  Sample p is pixel origin + scale p, before and after.
  void distort(const Eigen::Vector2d& origin_px, double scale, const CurveSamples& samples) const;

  /// Undistorts a point within 1e-9 px, by Newton's method; nullopt if there is no inverse.
  [[nodiscard]] std::optional<Eigen::Vector2d> ideal_from_picture(
      const Eigen::Vector2d& picture_px) const;

  /// The same from a table: within .01 px of the picture, up to 80 degrees from the axis. NaN if
  /// there is no inverse, and outside pictures of the camera's size.
  [[nodiscard]] Eigen::Vector2d approximate_ideal(const Eigen::Vector2d& picture_px) const;

 private:
  static constexpr std::size_t kTableSize = 1024;  // steps, even in the squared radius

  void make_table();
  [[nodiscard]] double farthest_radius() const;
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
  // Max one-to-one radius at focal length 1: squared in the ideal plane, and in the picture.
  double largest_squared_ = 0.0;
  double largest_picture_ = 0.0;
  double table_scale_ = 0.0;                   // table index per squared radius in the picture
  std::array<float, kTableSize + 2> table_{};  // radius in the ideal plane over that in the picture
};

}  // namespace ellipse
