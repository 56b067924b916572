#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "core/camera/picture.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/edges/motion_blur.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {

/// Minimum number of edges to fit and judge an ellipse, which has five parameters.
inline constexpr std::size_t kMinEdgesOfEllipse = 8;

/// Squared cosine of the largest angle between the gradient of an outline's edge and the outline's
/// normal: 30 degrees.
inline constexpr float kMinSquaredCosine = 0.75F;

/// Standard deviation of the position of an edge in focus without noise [px].
inline constexpr float kVertexError = 0.017F;

/// Standard deviation of a position that is known to a pixel: 1 / sqrt(12) [px].
inline constexpr float kPixelError = 0.289F;

/// An edge matched to a sample of an outline, in the distorted picture.
struct EdgeMeasurement {
  int sample = 0;                    ///< Index of the sample.
  Eigen::Vector2f point;             ///< Position of the edge, from the outline's origin [px].
  Eigen::Vector2f normal;            ///< Outward normal of the outline at the sample.
  PerimeterOffset offset;            ///< Of the edge; the anomaly is the sample's.
  float sigma_px = 0.0F;             ///< Standard deviation of the offset.
  float direction_error_rad = 0.0F;  ///< Angle from the normal to the gradient.
  float contrast = 0.0F;             ///< The gradient's norm [units of Gradient].
  float sharpness = 0.0F;            ///< As of SubpixelMaximum, but across the outline.
  float length_px = 0.0F;            ///< Length of the outline that the sample represents.
  float turn = 0.0F;                 ///< As OutlineSamples::turn().
  float px_per_ideal = 1.0F;         ///< As OutlineSamples::px_per_ideal().
  bool is_bright_inside = false;     ///< Whether the gradient points inwards.
};

/// Share of an outline that is matched by edges.
struct OutlineSupport {
  double inside_px = 0.0;             ///< Length of the outline inside the picture.
  double inside_fraction = 0.0;       ///< The same, as a share of the outline.
  double support = 0.0;               ///< Matched share of the inside length.
  double inside_turn_fraction = 0.0;  ///< Share of the outline's turn that is inside the picture.
  double turn_support = 0.0;          ///< Matched share of the turn inside.
};

/// Matches edges to an ellipse's outline: searches at each sample, along the row or column closest
/// to the normal, for the nearest or highest gradient maximum within 30 degrees of the normal and
/// of the right sign, or of either sign if the polarity is mixed. Locates it to sub-pixel accuracy
/// [Devernay1995] and corrects the shift of curved edges by smoothing and, on the picture, by
/// defocus.
///
/// One object serves one thread. Allocates nothing; O(samples x (reach + length of the blur)).
class EdgeMeasurer {
 public:
  /// Matches the nearest chained gradient maxima of a map; `e` is in its ideal plane.
  /// @param samples   As of OutlineSamples.
  /// @param reach_px  Largest distance searched, along the row or column.
  OutlineSupport measure(const GradientMap& map,
                         const Ellipse& e,
                         Polarity polarity,
                         std::size_t samples,
                         int reach_px);

  /// Matches the highest gradient maxima within two pixels on the picture itself; computes no
  /// gradient elsewhere. The gradient of an edge blurred by motion has no clear maximum; the edge
  /// is at its centroid, the mean position during the exposure. The standard deviations are those
  /// without noise, which is unknown: kPixelError beside a saturated pixel, since clipping moves
  /// the maximum of the gradient; larger for centroids of long lines of pixels.
  /// @param min_gradient  Weaker gradient maxima do not count [units of Gradient].
  /// @param motion_px     As of motion_blur(); zero = unknown.
  OutlineSupport measure(const Picture& picture,
                         const Ellipse& e,
                         Polarity polarity,
                         std::size_t samples,
                         double min_gradient,
                         const Eigen::Vector2f& motion_px = {0.0F, 0.0F});

  /// Of the last call, in order around the outline.
  [[nodiscard]] std::span<const EdgeMeasurement> edges() const { return {edges_.data(), count_}; }
  /// Of the last call: the mean contrast of its edges; 0 without edges [units of Gradient].
  [[nodiscard]] double mean_contrast() const;
  /// Of the last call: variance of the blur of its edges beyond that of a lens in focus, from their
  /// mean sharpness [px^2]. 0 unless they show it by three standard deviations.
  [[nodiscard]] float defocus_variance() const;
  /// Of the last call: the mean sharpness of its edges; needs an edge.
  [[nodiscard]] Estimate sharpness() const;
  /// Of the last call.
  [[nodiscard]] const MotionBlur& motion_blur() const { return motion_blur_; }
  /// Of the last call: the origin of EdgeMeasurement::point [px of the picture].
  [[nodiscard]] Eigen::Vector2d origin() const { return origin_; }

 private:
  void compute_sigmas(float noise, float reach_px);
  void correct_curvature(const OutlineSamples& outline);
  void move_to_centroids(const Picture& picture, const OutlineSamples& outline, Polarity polarity);
  template <class Search>
  OutlineSupport measure_along(const OutlineSamples& outline,
                               Polarity polarity,
                               const Search& search);

  std::array<EdgeMeasurement, OutlineSamples::kMaxSamples> edges_;
  std::size_t count_ = 0;
  MotionBlur motion_blur_;
  Eigen::Vector2d origin_{0.0, 0.0};
};

}  // namespace ellipse
