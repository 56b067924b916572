#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "core/edges/gradient_map.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Edges that an ellipse of five parameters is fitted to, and judged by, at least.
inline constexpr std::size_t kMinEdgesOfEllipse = 8;

/// An edge that an outline meets, in the picture as the lens shows it.
struct EdgeMeasurement {
  int sample = 0;                    ///< Its number around the outline.
  Eigen::Vector2f point;             ///< The edge itself, from the outline's origin [px].
  Eigen::Vector2f normal;            ///< Of the outline there, outwards.
  PerimeterOffset offset;            ///< Of the edge; the anomaly is the sample's.
  float sigma_px = 0.0F;             ///< Standard deviation of the offset; 0 where not told.
  float direction_error_rad = 0.0F;  ///< From the normal to the gradient.
  float contrast = 0.0F;             ///< The gradient's norm [units of Gradient].
  float length_px = 0.0F;            ///< Of the outline that it stands for.
  float px_per_ideal = 1.0F;         ///< Pixels of the picture per one of the ideal plane, across.
};

/// How much of an outline meets edges.
struct OutlineSupport {
  double inside_px = 0.0;        ///< Length of the outline inside the picture.
  double inside_fraction = 0.0;  ///< Of the outline.
  double support = 0.0;          ///< Share of the inside length that meets edges.
  double turn_support = 0.0;     ///< The same, of the inside turn of the outline.
};

/// Measures where an ellipse's outline meets edges: at even samples it looks along the normal for
/// the nearest or the highest gradient maximum whose gradient is within 30 degrees of the normal
/// and has the right sign, places it below a pixel [Devernay1995], and undoes what smoothing does
/// to a curved edge.
///
/// One object serves one thread. Allocates nothing; O(samples x reach).
class EdgeMeasurer {
 public:
  /// The nearest chained gradient maxima of a map, in its ideal plane.
  /// @param samples   As of OutlineSamples.
  /// @param reach_px  How far from the outline an edge may lie.
  OutlineSupport measure(const GradientMap& map,
                         const Ellipse& e,
                         Polarity polarity,
                         std::size_t samples,
                         int reach_px);

  /// The highest gradient maxima within two pixels, on the picture itself: no gradient is computed
  /// elsewhere. The standard deviations are not told: that needs the noise.
  /// @param min_gradient  Weaker gradient maxima do not count [units of Gradient].
  OutlineSupport measure(const ImageView& luma,
                         const LensView& lens,
                         const Ellipse& e,
                         Polarity polarity,
                         std::size_t samples,
                         double min_gradient);

  /// Of the last call, around the outline.
  [[nodiscard]] std::span<const EdgeMeasurement> edges() const { return {edges_.data(), count_}; }
  /// Of the last call: what EdgeMeasurement::point is counted from [px of the picture].
  [[nodiscard]] Eigen::Vector2d origin() const { return origin_; }

 private:
  void tell_sigmas(float noise, float reach_px);
  template <class Search>
  OutlineSupport measure_along(const OutlineSamples& outline,
                               Polarity polarity,
                               const Search& search);

  std::array<EdgeMeasurement, OutlineSamples::kMaxSamples> edges_;
  std::size_t count_ = 0;
  float mean_sharpness_ = 0.0F;  // of the last call, see SubpixelMaximum
  Eigen::Vector2d origin_{0.0, 0.0};
};

}  // namespace ellipse
