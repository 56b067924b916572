#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace ellipse {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// An ellipse in the picture. Pixels, x right, y down, (0, 0) is the centre of the top-left pixel.
struct Ellipse {
  double cx = 0.0;          ///< Centre [px].
  double cy = 0.0;          ///< Centre [px].
  double semi_major = 0.0;  ///< [px], >= semi_minor.
  double semi_minor = 0.0;  ///< [px], > 0.
  double angle_rad = 0.0;   ///< Major axis, from +x towards +y, in (-pi/2, pi/2].

  [[nodiscard]] Eigen::Vector2d center() const { return {cx, cy}; }
  /// The point at the eccentric anomaly t [rad]: centre + R(angle) (a cos t, b sin t).
  [[nodiscard]] Eigen::Vector2d point_at(double t_rad) const;
  [[nodiscard]] double aspect_ratio() const { return semi_major / semi_minor; }
  bool operator==(const Ellipse&) const = default;
};

/// Radius of the circle with the same area [px].
[[nodiscard]] inline double mean_radius_px(const Ellipse& e) {
  return std::sqrt(e.semi_major * e.semi_minor);
}

/// A short piece of an ellipse's perimeter.
struct PerimeterStep {
  Eigen::Vector2d point;    ///< [px]
  Eigen::Vector2d tangent;  ///< Unit vector.
  double length_px = 0.0;
  /// Outward unit normal.
  [[nodiscard]] Eigen::Vector2d normal() const { return {tangent.y(), -tangent.x()}; }
};

/// Walks once around the perimeter in steps of at most a pixel; above a semi-major axis of
/// 10,000 px in 65,536 longer ones. Allocates nothing.
template <class Use>
void walk_perimeter(const Ellipse& e, const Use& use) {
  const int steps = static_cast<int>(std::clamp(std::ceil(kTwoPi * e.semi_major), 16.0, 65536.0));
  const double step_cos = std::cos(kTwoPi / steps);
  const double step_sin = std::sin(kTwoPi / steps);
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d major = e.semi_major * axis;
  const Eigen::Vector2d minor = e.semi_minor * Eigen::Vector2d(-axis.y(), axis.x());
  double cos_t = 1.0;
  double sin_t = 0.0;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d velocity = cos_t * minor - sin_t * major;
    const double speed = velocity.norm();
    use(PerimeterStep{
        e.center() + cos_t * major + sin_t * minor, velocity / speed, speed * kTwoPi / steps});
    const double next_cos = step_cos * cos_t - step_sin * sin_t;
    sin_t = step_sin * cos_t + step_cos * sin_t;
    cos_t = next_cos;
  }
}

/// Whether a point lies on a pixel of a picture.
[[nodiscard]] inline bool is_in_picture(const Eigen::Vector2d& p, double width, double height) {
  return p.x() >= -0.5 && p.y() >= -0.5 && p.x() < width - 0.5 && p.y() < height - 0.5;
}

/// Half the width and height of the upright box around the ellipse [px].
[[nodiscard]] Eigen::Vector2d half_extent(const Ellipse& e);

/// An interval of a coordinate, empty where end <= begin.
struct Interval {
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double length() const { return std::max(0.0, end - begin); }
};

/// Circumference [px], [Ramanujan1914]; relative error below 4e-5 up to an aspect ratio of 5.
[[nodiscard]] double perimeter_px(const Ellipse& e);

/// Symmetric C with (p - c)^T C^-1 (p - c) = 1 on the perimeter [px^2].
[[nodiscard]] Eigen::Matrix2d shape_matrix(const Ellipse& e);

/// The inverse of shape_matrix(). nullopt unless the matrix is positive definite and finite.
[[nodiscard]] std::optional<Ellipse> from_shape(const Eigen::Vector2d& center,
                                                const Eigen::Matrix2d& shape);

/// Symmetric Q with (x, y, 1) Q (x, y, 1)^T = 0 on the perimeter, negative inside.
[[nodiscard]] Eigen::Matrix3d conic_matrix(const Ellipse& e);

/// The inverse of conic_matrix(), for any scale and sign of Q. nullopt for other conics.
[[nodiscard]] std::optional<Ellipse> from_conic(const Eigen::Matrix3d& conic);

/// The ellipse mapped by p -> A p + t. nullopt if A is singular.
[[nodiscard]] std::optional<Ellipse> transformed(const Ellipse& e,
                                                 const Eigen::Matrix2d& linear,
                                                 const Eigen::Vector2d& translation_px);

/// The ellipse in a picture resampled by `factor`: x becomes (x + 0.5) factor - 0.5.
[[nodiscard]] Ellipse scaled(const Ellipse& e, double factor);

[[nodiscard]] Ellipse translated(const Ellipse& e, double dx_px, double dy_px);

/// Signed distance of a point to the perimeter [px], negative inside, to first order [Sampson1982].
[[nodiscard]] double sampson_distance(const Ellipse& e, const Eigen::Vector2d& point_px);

/// The largest difference among centre coordinates and semi-axes [px].
[[nodiscard]] double max_difference_px(const Ellipse& a, const Ellipse& b);

/// A tolerance that grows with the size of an ellipse.
struct Tolerance {
  double px = 0.0;
  double relative = 0.0;  ///< Of the semi-major axis.

  [[nodiscard]] constexpr double of(const Ellipse& e) const { return px + relative * e.semi_major; }
};

/// Whether no centre coordinate and no semi-axis differs by more than the tolerance of `reference`.
[[nodiscard]] bool is_same(const Ellipse& e, const Ellipse& reference, const Tolerance& tolerance);

/// Of two ellipses of one target. Covers the perspective offset of the centres of concentric
/// circles and the uncertainty of small fits.
inline constexpr Tolerance kSameTarget{2.0, 0.1};

/// Whether two ellipses may be images of concentric circles: whether their centres agree within
/// kSameTarget of the larger one.
[[nodiscard]] bool are_concentric(const Ellipse& a, const Ellipse& b);

/// Intersection over union of two ellipses inside a frame; 0 if both are outside.
[[nodiscard]] double iou_inside(const Ellipse& a, const Ellipse& b, int width, int height);

/// Share of the perimeter's length inside the frame, 0 to 1.
[[nodiscard]] double visible_fraction(const Ellipse& e, int width, int height);

}  // namespace ellipse
