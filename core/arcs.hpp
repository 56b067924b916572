#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/chains.hpp"
#include "core/ellipse_fit.hpp"
#include "core/gradient.hpp"

namespace ellipse {

/// Which side of an edge is dark.
enum class Polarity { kDarkInside = 1, kBrightInside = -1 };

[[nodiscard]] constexpr Polarity opposite(Polarity polarity) {
  return polarity == Polarity::kDarkInside ? Polarity::kBrightInside : Polarity::kDarkInside;
}

/// A piece of a chain that turns to one side only, as an ellipse's edge does.
struct Arc {
  std::size_t begin = 0;  ///< Of all chains' pixels.
  std::size_t end = 0;
  double turn_rad = 0.0;  ///< By which it turns, above 0.
  Polarity polarity = Polarity::kDarkInside;
  // In the ideal plane:
  std::array<Eigen::Vector2d, 3> points;   ///< Near its begin, in its middle, near its end [px].
  std::array<Eigen::Vector2d, 3> inwards;  ///< Unit normals there, towards its inside.
  Moments moments{Eigen::Vector2d::Zero()};

  [[nodiscard]] double length_px() const { return static_cast<double>(end - begin); }
};

/// Where the crest of the gradient lies within its pixel, and how sharp it is.
struct CrestVertex {
  float offset_px = 0.0F;  ///< Along the axis, from the pixel's centre.
  float sharpness = 0.0F;  ///< Curvature of the crest's profile over its height [1/px^2].
};

/// Of the blur of a lens that is in focus [px^2].
inline constexpr double kLensVariance = 0.36;

/// How far inside a curved edge the crest of its smoothed gradient lies [px], per curvature [1/px]:
/// smoothing of variance v draws the crest of an edge of curvature k in by v k / 2, to first order
/// (own derivation from the mean of a disc's edge over a Gaussian). The 5 x 5 kernels have a
/// variance of 1 along the edge.
inline constexpr double kCrestShift = 0.5 * (1.0 + kLensVariance);

/// The vertex of the parabola through three pixels along the axis closest to the gradient
/// [Devernay1995] 2. The gradients' projections on the middle one count.
/// @param here  The middle one's gradient in a map; its neighbours are `step` before and behind.
[[nodiscard]] inline CrestVertex crest_vertex(const Gradient* here, int step) {
  constexpr float kFarthest = 0.7F;
  const float gx = here->x;
  const float gy = here->y;
  const float before = here[-step].x * gx + here[-step].y * gy;
  const float height = gx * gx + gy * gy;
  const float after = here[step].x * gx + here[step].y * gy;
  const float curvature = before - 2.0F * height + after;
  const float offset = curvature < 0.0F ? 0.5F * (before - after) / curvature : 0.0F;
  return {std::clamp(offset, -kFarthest, kFarthest), height > 0.0F ? -curvature / height : 0.0F};
}

/// Cuts chains into arcs: at corners, and where the curvature changes its sign.
class ArcSplitter {
 public:
  /// The best arcs by length and turn, at most kMaxPairedArcs. Valid until the next call.
  /// @param wants_all  Behind them the rest of those that can be tried alone, at most kMaxArcs
  ///                   together.
  /// Allocates only while it has not yet seen as many chains.
  [[nodiscard]] std::span<Arc> split(const GradientMap& map,
                                     const ChainTracer& chains,
                                     bool wants_all = false);

  static constexpr double kMinSingleTurn = 0.8;      ///< Of an arc that is tried alone [rad].
  static constexpr std::size_t kMaxPairedArcs = 50;  ///< Pairs grow with its square.
  static constexpr std::size_t kMaxArcs = 2048;      ///< Bounds the time spent on one image.

 private:
  struct Piece {
    std::size_t begin;
    std::size_t end;
    double turn_rad;  // signed
    [[nodiscard]] double rank() const;
  };

  void split_chain(const GradientMap& map, std::size_t begin, std::size_t end, bool is_closed);
  void split_smooth_part(double noise, std::size_t begin, std::size_t end);
  void smooth_angles(std::size_t begin, std::size_t end, std::size_t half_width);
  void unwrap(std::size_t begin, std::size_t end);
  [[nodiscard]] bool is_whole_ellipse(const GradientMap& map, std::size_t begin, std::size_t end);
  [[nodiscard]] Moments moments_of(const GradientMap& map,
                                   std::size_t begin,
                                   std::size_t end) const;
  [[nodiscard]] double mean_angle(std::size_t at, std::size_t begin, std::size_t end) const;
  void add_piece(std::size_t begin, std::size_t end);
  void keep_best_pieces(bool wants_all);
  [[nodiscard]] Arc make_arc(const GradientMap& map, const Piece& piece) const;

  std::span<const std::int32_t> pixels_;
  std::vector<float> angles_;  // of the gradient [rad], without jumps along a chain
  std::vector<float> smooth_;
  std::vector<float> strengths_;  // of the gradient, |x| + |y|
  std::vector<Piece> pieces_;
  std::vector<Arc> arcs_;
};

}  // namespace ellipse
