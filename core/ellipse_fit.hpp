#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/ellipse.hpp"

namespace ellipse {

/// Sums of x^i y^j, i + j <= 4, over points taken relative to an origin. All that a least-squares
/// ellipse needs to know of its points, however many they are.
class Moments {
 public:
  /// @param origin_px  A point near the data, such as its first one: it keeps the sums small.
  explicit Moments(const Eigen::Vector2d& origin_px) : origin_(origin_px) {}

  void add(const Eigen::Vector2d& point_px, double weight = 1.0);
  /// The points of both. Both must have the same origin.
  void add(const Moments& other);

  [[nodiscard]] double count() const { return at(0, 0); }
  [[nodiscard]] Eigen::Vector2d mean() const;
  /// RMS distance of the points to their mean [px].
  [[nodiscard]] double spread_px() const;
  /// The moments of (p - mean) / spread.
  [[nodiscard]] Moments standardized() const;
  [[nodiscard]] double at(int i, int j) const { return sums_[index(i, j)]; }

 private:
  static constexpr int index(int i, int j) { return (i + j) * (i + j + 1) / 2 + j; }

  Eigen::Vector2d origin_;
  std::array<double, 15> sums_{};  // by degree: 1, x, y, x^2, xy, y^2, x^3, ...
};

/// Fits one ellipse by direct least squares [Fitzgibbon1999] in the stable form of
/// [HalirFlusser1998], on standardized points.
///
/// @param points_px  Image points [px], any order. Borrowed for the call only.
/// @return nullopt for fewer than 5 points, and for points (nearly) on one line or at one place.
///
/// Deterministic, thread-safe, allocates nothing; O(N).
[[nodiscard]] std::optional<Ellipse> fit_ellipse(std::span<const Eigen::Vector2d> points_px);

/// The same from moments: O(1).
[[nodiscard]] std::optional<Ellipse> fit_ellipse(const Moments& moments);

/// An ellipse and how well it fits its points.
struct MomentFit {
  Ellipse ellipse;
  /// RMS distance of the points [px], in the approximation of [Taubin1991].
  double rms_px = 0.0;
};

/// The same with the residual, which the moments tell too: O(1).
[[nodiscard]] std::optional<MomentFit> fit_with_residual(const Moments& moments);

/// One Gauss-Newton step towards the ellipse with the least sum of squared Sampson distances
/// [Sampson1982]. Direct least squares draws short arcs towards small, flat ellipses; this does
/// not.
///
/// The ellipse is {c + M u, |u| = 1}, M symmetric: its five parameters move c within M and stretch
/// M, so that no direction is singular, at a circle neither. Allocates nothing; O(1) a point.
class GeometricFit {
 public:
  explicit GeometricFit(const Ellipse& start);

  void add(const Eigen::Vector2d& point_px, double weight = 1.0);

  /// Distance of a point to the starting ellipse [px], as sampson_distance().
  [[nodiscard]] double distance_px(const Eigen::Vector2d& point_px) const;

  /// The ellipse after the step; nullopt for fewer than 5 points or a singular system.
  [[nodiscard]] std::optional<Ellipse> solve() const;

 private:
  using Vector5d = Eigen::Matrix<double, 5, 1>;
  using Matrix5d = Eigen::Matrix<double, 5, 5>;

  Eigen::Vector2d center_;
  Eigen::Matrix2d stretch_;          // M
  Eigen::Matrix2d inverse_stretch_;  // M^-1
  Matrix5d normal_ = Matrix5d::Zero();
  Vector5d right_side_ = Vector5d::Zero();
  int points_ = 0;
};

}  // namespace ellipse
