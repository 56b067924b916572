#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/geometry/ellipse.hpp"
#include "core/geometry/homography.hpp"
#include "core/geometry/least_squares.hpp"

namespace ellipse {

/// Sums of x^i y^j, i + j <= 4, over points relative to an origin. Sufficient for a least-squares
/// fit of an ellipse to any number of points.
class Moments {
 public:
  /// @param origin_px  A point near the data, such as its first one, which keeps the sums small.
  explicit Moments(const Eigen::Vector2d& origin_px) : origin_(origin_px) {}

  void add(const Eigen::Vector2d& point_px, double weight = 1.0);
  /// Adds the points of `other`, which must have the same origin.
  void add(const Moments& other);

  [[nodiscard]] double total_weight() const { return at(0, 0); }
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
/// @return nullopt for fewer than 5 points, and for (nearly) collinear or coincident points.
///
/// Deterministic, thread-safe, allocates nothing; O(N).
[[nodiscard]] std::optional<Ellipse> fit_ellipse(std::span<const Eigen::Vector2d> points_px);

/// The same from moments, with a total weight of at least 5: O(1).
[[nodiscard]] std::optional<Ellipse> fit_ellipse(const Moments& moments);

/// An ellipse and how well it fits its points.
struct MomentFit {
  Ellipse ellipse;
  /// RMS distance of the points [px], in the approximation of [Taubin1991].
  double rms_px = 0.0;
};

/// The same with the residual, also from moments: O(1).
[[nodiscard]] std::optional<MomentFit> fit_with_residual(const Moments& moments);

/// Position of a point relative to an ellipse's perimeter.
struct PerimeterOffset {
  Eigen::Vector2d anomaly;   ///< Cosine and sine of the eccentric anomaly.
  double px_per_unit = 0.0;  ///< Displacement of the perimeter per relative axis growth.
  double distance_px = 0.0;  ///< From the perimeter, positive outside; as sampson_distance().
};

/// One Gauss-Newton step towards the ellipse with the minimal sum of squared Sampson distances
/// [Sampson1982]. Direct least squares is biased towards small, flat ellipses on short arcs; this
/// is not.
///
/// The ellipse is {c + M u, |u| = 1}, M its axes: five parameters shift c in units of M and stretch
/// M symmetrically, which is not singular even at a circle. Allocates nothing; O(1) per point.
class GeometricFit {
 public:
  explicit GeometricFit(const Ellipse& start);

  [[nodiscard]] PerimeterOffset offset_of(const Eigen::Vector2d& point_px) const;

  void add(const PerimeterOffset& offset, double weight = 1.0);
  void add(const Eigen::Vector2d& point_px, double weight = 1.0) {
    add(offset_of(point_px), weight);
  }

  /// The ellipse after the step; nullopt for fewer than 5 points or a singular system.
  [[nodiscard]] std::optional<Ellipse> solve() const;

  /// Normal matrix: with weights of 1 over the variance of the points' distances, the inverse
  /// covariance of T, S and E (see HomographyChange) in the view image_from_pad(start).
  [[nodiscard]] RingMatrix information() const { return equations_.information(); }

 private:
  Eigen::Vector2d center_;
  Eigen::Matrix2d rotation_;  // M = rotation x axes
  Eigen::Vector2d axes_;      // semi-major, semi-minor
  Eigen::Vector2d inverse_axes_;
  LeastSquares<5> equations_;
};

/// An ellipse and its uncertainty.
struct FittedEllipse {
  Ellipse ellipse;
  RingUncertainty uncertainty;
};

/// Expected uncertainty of a fit to the edges along the part of an ellipse inside a frame; a
/// standard deviation of one radius if nothing is inside.
/// @param sigma_px  Standard deviation of an edge position, independent every 8 px.
[[nodiscard]] RingUncertainty expected_uncertainty(const Ellipse& e,
                                                   double width,
                                                   double height,
                                                   double sigma_px);

}  // namespace ellipse
