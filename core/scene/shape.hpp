#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace ellipse {

/// The outline of a shape, in its own frame.
enum class Outline {
  kEllipse,       ///< The unit circle; `sheet_from_shape` makes it any ellipse.
  kSuperellipse,  ///< |x|^amount + |y|^amount = 1.
  kEgg,           ///< The unit circle, wider towards +x: y is multiplied by 1 + amount x.
  kWavy,          ///< The unit circle with smooth random deviations up to `amount`.
  kPolygon,       ///< Through `corners`, grown by `amount` on all sides. Two corners: a stroke.
  kMesh,          ///< Wires at all whole x and y, of half the width `amount`.
};

/// Reflectance of a shape.
struct Paint {
  double level = 128.0;               ///< Grey level of the light at gain 1.
  double opacity = 1.0;               ///< Share of the light beneath that it hides.
  double texture = 0.0;               ///< Amplitude of a random texture [grey levels].
  double grain = 8.0;                 ///< Cells of the texture per unit of the sheet.
  Eigen::Vector2d slope{0.0, 0.0};    ///< Relative change of the light per unit of the shape.
  Eigen::Vector3d lit_from{0, 0, 0};  ///< Unit; of a ball: x right, y down, z to the camera.
};

/// A painted shape. A value.
struct Shape {
  Outline outline = Outline::kEllipse;
  double amount = 0.0;  ///< Parameter of the outline.
  std::vector<Eigen::Vector2d> corners;
  Eigen::Affine2d sheet_from_shape = Eigen::Affine2d::Identity();  ///< From its frame to the sheet.
  double hole = 0.0;      ///< Scale of a hole of the same form; 0 = none.
  double softness = 0.0;  ///< Standard deviation of its edge's ramp [units of the shape].
  Paint paint;
  std::uint64_t seed = 1;
  bool is_listed = false;  ///< The truth lists its outline, and that of its hole, as ellipses.
  bool is_target = false;  ///< Its outer outline is a target.
};

/// A shape prepared for sampling.
class ShapeEdge {
 public:
  explicit ShapeEdge(const Shape& shape);

  /// Distance to an outline in the shape's frame.
  struct Nearness {
    double distance = 0.0;               ///< Above 0 outside; to first order.
    Eigen::Vector2d gradient{1.0, 0.0};  ///< Of the distance.
  };
  [[nodiscard]] Nearness at(const Eigen::Vector2d& point) const;

  /// Share of the light at a point that comes from the shape.
  /// @param point_per_px  Derivative of the point by the picture's pixels.
  [[nodiscard]] double coverage(const Eigen::Vector2d& point,
                                const Eigen::Matrix2d& point_per_px,
                                double blur_px) const;

  /// Signed lower bound of the distance to the next edge: above 0 outside the paint, below 0
  /// inside; 0 = unknown.
  [[nodiscard]] double clearance(const Eigen::Vector2d& point) const;

  /// The point on the outline in a direction; not for polygons and meshes.
  [[nodiscard]] Eigen::Vector2d outline_at(double angle_rad) const;

  /// Largest distance of the shape from the frame's origin; infinite for a mesh.
  [[nodiscard]] double extent() const { return extent_; }

 private:
  static constexpr std::size_t kTableSize = 1024;

  void make_table(std::uint64_t seed);
  [[nodiscard]] double radius_at(double angle_rad) const;
  [[nodiscard]] Nearness from_radius(const Eigen::Vector2d& point) const;
  [[nodiscard]] Nearness from_corners(const Eigen::Vector2d& point) const;
  [[nodiscard]] double mesh_coverage(const Eigen::Vector2d& point,
                                     const Eigen::Matrix2d& point_per_px,
                                     double blur_px) const;

  Outline outline_;
  double amount_;
  double hole_;
  double softness_;
  double extent_ = 1.0;
  double inner_ = 1.0;  // smallest distance of the outline from the origin
  std::vector<Eigen::Vector2d> corners_;
  std::vector<float> radii_;  // by direction, of noncircular outlines
};

}  // namespace ellipse
