#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/edges/gradient_map.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {

/// An edge matched along a normal of the perimeter, in distorted image coordinates.
struct EdgeHit {
  int sample = 0;                    ///< Its number around the perimeter.
  Eigen::Vector2f foot;              ///< On the perimeter, from the ellipse's centre [px].
  Eigen::Vector2f normal;            ///< Of the perimeter there, outwards.
  PerimeterOffset offset;            ///< Of the edge; the anomaly is the ellipse's.
  float direction_error_rad = 0.0F;  ///< From the normal to the gradient.
  float weight = 0.0F;               ///< Length of the perimeter that it stands for [px].
};

/// Tolerances of distance [px] and direction [rad], from strict to lax.
inline constexpr std::array<double, 4> kDistanceLevels = {0.35, 0.7, 1.0, 1.5};
inline constexpr std::array<double, 4> kDirectionLevels = {0.12, 0.2, 0.3, 0.45};

/// What the edges say of an ellipse.
struct PerimeterEvidence {
  double inside_px = 0.0;          ///< Length of the perimeter inside the picture.
  double inside_fraction = 0.0;    ///< Of the perimeter.
  double support = 0.0;            ///< Share of the inside length that matches edges.
  double turn_support = 0.0;       ///< The same, of the inside turn of the perimeter.
  std::array<double, 4> levels{};  ///< Share of the length within each of the tolerances.
  double signal_to_noise = 0.0;    ///< Mean gradient over the noise's.
  double sharpness = 0.0;          ///< Mean of SubpixelMaximum::sharpness.
};

/// The same as PerimeterEvidence::support of PerimeterProbe::probe(), and no more: less than
/// `least` where it becomes plain on the way that it will not reach it.
[[nodiscard]] double perimeter_support(const GradientMap& map,
                                       const Ellipse& e,
                                       Polarity polarity,
                                       int samples,
                                       int tolerance_px,
                                       double least);

/// Walks around ellipses and looks for chained edges along the normals. The ellipses are those of
/// the map's ideal plane.
///
/// Single precision, from the ellipse's centre: 6e-8 of its axes.
class PerimeterProbe {
 public:
  /// @param samples       Around the whole perimeter: 32, 64, 128 or 256.
  /// @param tolerance_px  How far from the perimeter an edge may lie.
  /// An edge counts where its gradient is within 30 degrees of the normal, and of the right sign.
  [[nodiscard]] PerimeterEvidence probe(
      const GradientMap& map, const Ellipse& e, Polarity polarity, int samples, int tolerance_px);

  /// Of the last call.
  [[nodiscard]] std::span<const EdgeHit> hits() const { return hits_; }

  static constexpr int kMaxSamples = 256;

 private:
  std::vector<EdgeHit> hits_;
};

}  // namespace ellipse
