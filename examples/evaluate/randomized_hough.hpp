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
  float normal_x = 0.0F;  ///< Both 0 if unknown; the pixel then only votes.
  float normal_y = 0.0F;
};

/// Finds ellipses by the Hough transform of [XieJi2002] with random sub-sampling: Y. Xie and Q. Ji,
/// "A new efficient ellipse detection method", International Conference on Pattern Recognition,
/// 2002. Two edge pixels are taken as the ends of a major axis; all others vote for the only
/// remaining unknown, the semi-minor axis.
///
/// A fixed number of random pairs is tried instead of all, and only a sample of pixels votes.
/// Deviation from the paper: a pair whose edges are not perpendicular to the connecting line is
/// rejected before the vote; without this test, even millions of trials find almost nothing.
///
/// Not thread-safe; allocates nothing once its vectors have grown.
class RandomizedHough {
 public:
  /// @param edges   In any order; coordinates must be finite. Borrowed for the call.
  /// @param limits  Only the limits of the axes and of their ratio are used.
  /// @return The ellipses found, scored by the number of votes. Valid until the next call.
  /// Deterministic: each call uses the same random numbers.
  [[nodiscard]] std::span<const ellipse::Detection> find(std::span<const EdgePixel> edges,
                                                         const ellipse::Thresholds& limits);

 private:
  // Knuth's MMIX generator; only the upper bits are used.
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
  std::vector<EdgePixel> sorted_;  // by direction of the normal
  std::array<std::size_t, kDirections + 1> starts_{};
  std::vector<float> voter_x_;
  std::vector<float> voter_y_;
  std::vector<float> semi_minor_;  // one per voter
  std::vector<int> votes_;         // by semi-minor axis, in bins of 1 px
  std::vector<ellipse::Detection> found_;
};

}  // namespace evaluate
