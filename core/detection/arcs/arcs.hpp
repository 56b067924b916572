#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {

/// A piece of a chain that turns to one side only, or a whole chain that turns by more than half a
/// turn.
struct Arc {
  std::size_t begin = 0;  ///< Index into ChainTracer::pixels().
  std::size_t end = 0;
  Polarity polarity = Polarity::kDarkInside;
  // In the ideal plane:
  std::array<Eigen::Vector2d, 3> points;   ///< Near its begin, middle and end [px].
  std::array<Eigen::Vector2d, 3> inwards;  ///< Unit normals at `points`, inwards.
  Moments moments{Eigen::Vector2d::Zero()};
};

/// Cuts chains into arcs: at corners, and where the curvature changes its sign.
class ArcSplitter {
 public:
  /// The best arcs by length times turn: kMaxTried, or kMaxArcs. Valid until the next call.
  /// @param wants_all  Whether to return kMaxArcs.
  /// Allocates only when pixels or arcs outnumber those of every earlier call.
  [[nodiscard]] std::span<Arc> split(const GradientMap& map,
                                     const ChainTracer& chains,
                                     bool wants_all = false);

  static constexpr double kMinTurn = 0.3;        ///< Of an arc [rad].
  static constexpr std::size_t kMaxTried = 200;  ///< Best arcs of a target search.
  static constexpr std::size_t kMaxArcs = 2048;  ///< Bounds the time spent on one image.

 private:
  struct Piece {
    std::size_t begin;
    std::size_t end;
    double turn_rad;  // signed
    [[nodiscard]] double rank() const;
  };

  void split_chain(const GradientMap& map, std::size_t begin, std::size_t end);
  [[nodiscard]] double min_reverse_turn(double noise, std::size_t begin, std::size_t end) const;
  void split_smooth_part(double noise, std::size_t begin, std::size_t end);
  void unwrap(std::size_t begin, std::size_t end);
  void add_whole(std::size_t begin, std::size_t end);
  [[nodiscard]] Moments moments_of(const GradientMap& map,
                                   std::size_t begin,
                                   std::size_t end) const;
  [[nodiscard]] double mean_angle(std::size_t at, std::size_t begin, std::size_t end) const;
  void add_piece(std::size_t begin, std::size_t end);
  void keep_best_pieces(bool wants_all);
  [[nodiscard]] Arc make_arc(const GradientMap& map, const Piece& piece) const;

  std::span<const std::int32_t> pixels_;
  std::vector<float> angles_;     // of the gradient [rad], unwrapped along each chain
  std::vector<float> y_;          // of the gradient, its y component
  std::vector<float> strengths_;  // of the gradient, |x| + |y|
  std::vector<Piece> pieces_;
  std::vector<Arc> arcs_;
};

}  // namespace ellipse
