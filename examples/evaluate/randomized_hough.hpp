#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/detection/detector.hpp"

namespace evaluate {

/// A pixel of an edge map, and the unit normal of its edge, from dark to light.
struct EdgePixel {
  float x = 0.0F;         ///< [px]
  float y = 0.0F;         ///< [px]
  float normal_x = 0.0F;  ///< Both 0 where it is not known: then the pixel only votes.
  float normal_y = 0.0F;
};

/// Finds ellipses by the Hough transform of [XieJi2002] with random sub-sampling: Y. Xie and Q. Ji,
/// "A new efficient ellipse detection method", International Conference on Pattern Recognition,
/// 2002. Two edge pixels are taken for the ends of a major axis, and every other one then votes for
/// the one unknown that is left, the semi-minor axis.
///
/// Not all pairs are tried but a fixed number, drawn at random, and only some pixels vote. A pair
/// whose edges are not square to the line between them is no axis and is dropped before the vote,
/// which the paper does not do: without it, trials by the million would find next to nothing.
///
/// One object serves one thread at a time; it allocates nothing once its vectors have grown.
class RandomizedHough {
 public:
  /// @param edges   Any order, at any finite place. Borrowed for the call only.
  /// @param limits  The limits of the axes and of their ratio are read.
  /// @return Every ellipse found, its score the number of edge pixels that voted for it. Valid
  ///         until the next call. Deterministic: each call draws the same numbers.
  [[nodiscard]] std::span<const ellipse::Detection> find(std::span<const EdgePixel> edges,
                                                         const ellipse::Thresholds& limits);

 private:
  // Knuth's MMIX generator; only its upper bits are used.
  using Random = std::
      linear_congruential_engine<std::uint64_t, 6364136223846793005U, 1442695040888963407U, 0U>;

  static constexpr std::size_t kDirections = 24;

  void choose_voters(std::span<const EdgePixel> edges, Random& random);
  void sort_by_direction(std::span<const EdgePixel> edges);
  [[nodiscard]] std::span<const EdgePixel> facing_pixels(const EdgePixel& p) const;
  [[nodiscard]] static std::size_t direction(const EdgePixel& pixel);
  [[nodiscard]] std::optional<ellipse::Detection> vote(const EdgePixel& p, const EdgePixel& q);
  void keep(const ellipse::Detection& found);

  double pixels_per_voter_ = 1.0;
  std::vector<EdgePixel> shuffled_;
  std::vector<EdgePixel> sorted_;  // by the direction of the normal
  std::array<std::size_t, kDirections + 1> starts_{};
  std::vector<float> voter_x_;
  std::vector<float> voter_y_;
  std::vector<float> semi_minor_;  // each voter's
  std::vector<int> votes_;         // by the semi-minor axis, in bins of a pixel
  std::vector<ellipse::Detection> found_;
};

}  // namespace evaluate
