#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

namespace ellipse {

/// A step edge under Gaussian blur: the share of its light at a point `sigmas` standard deviations
/// outside the edge; 1 deep inside, 0 far outside.
[[nodiscard]] double blurred_step(double sigmas);

/// Beyond this many standard deviations blurred_step() is 0 or 1.
inline constexpr double kStepReach = 4.0;

/// A straight edge in the picture.
struct StraightEdge {
  Eigen::Vector3d line;  ///< (unit normal, offset): distance [px] = line . (x, y, 1), > 0 outside.

  [[nodiscard]] double distance_px(const Eigen::Vector2d& pixel) const {
    return line.x() * pixel.x() + line.y() * pixel.y() + line.z();
  }
  [[nodiscard]] double coverage(const Eigen::Vector2d& pixel, double blur_px) const {
    return blurred_step(distance_px(pixel) / blur_px);
  }
};

/// The image of the half plane normal . p <= offset of a plane; exact, as lines map to lines.
[[nodiscard]] StraightEdge project_half_plane(const Eigen::Matrix3d& plane_from_image,
                                              const Eigen::Vector2d& normal,
                                              double offset);

/// A straight band |normal . p| <= half_width.
struct Band {
  StraightEdge outer;
  StraightEdge inner;

  [[nodiscard]] double coverage(const Eigen::Vector2d& pixel, double blur_px) const {
    return outer.coverage(pixel, blur_px) - inner.coverage(pixel, blur_px);
  }
  /// Whether neither edge is within this distance of the pixel.
  [[nodiscard]] bool is_clear_of(const Eigen::Vector2d& pixel, double reach_px) const;
};

[[nodiscard]] Band project_band(const Eigen::Matrix3d& plane_from_image,
                                const Eigen::Vector2d& normal,
                                double center,
                                double half_width);

/// A rectangle: the product of two bands, which is exact if their images are at right angles.
struct Box {
  Band along;
  Band across;

  [[nodiscard]] double coverage(const Eigen::Vector2d& pixel, double blur_px) const {
    const double share = across.coverage(pixel, blur_px);
    return share > 0.0 ? share * along.coverage(pixel, blur_px) : 0.0;
  }
  [[nodiscard]] bool is_clear_of(const Eigen::Vector2d& pixel, double reach_px) const {
    return along.is_clear_of(pixel, reach_px) && across.is_clear_of(pixel, reach_px);
  }
};

[[nodiscard]] Box project_box(const Eigen::Matrix3d& plane_from_image,
                              const Eigen::Vector2d& center,
                              const Eigen::Vector2d& along,
                              double half_length,
                              double half_width);

/// The image of a circle about a plane's origin: exactly a conic, C' = H^-T C H^-1
/// [HartleyZisserman2004] 2.3.
class CircularEdge {
 public:
  CircularEdge(const Eigen::Matrix3d& plane_from_image, double radius);

  [[nodiscard]] double radius() const { return radius_; }
  /// Valid only at pixels that see the plane's front side.
  [[nodiscard]] double coverage(const Eigen::Vector2d& pixel, double blur_px) const;

 private:
  double radius_;
  Eigen::Matrix3d conic_;  // negative inside
};

}  // namespace ellipse
