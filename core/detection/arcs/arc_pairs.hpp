#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/detection/arcs/arcs.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {

/// Max number per pass of arcs considered for pairs, of pairs fitted, and of ellipses of single
/// arcs in a target search.
inline constexpr std::size_t kMaxPerPass = 50;

/// Two arcs on one convex curve.
struct ArcPair {
  std::size_t first = 0;  ///< Index of an arc.
  std::size_t second = 0;
  /// Sum of 1 - cos of the angles between the normals of the arcs and those of their ellipse.
  double direction_error = 0.0;
};

/// Finds pairs of arcs that may belong to one ellipse. The arcs may differ in polarity.
class ArcPairs {
 public:
  /// Fits an ellipse to each pair of the best arcs, up to kMaxPerPass pairs.
  /// @param arcs     The best first.
  /// @param is_used  Per arc: whether to leave it out.
  /// @return The pairs whose directions agree best with their ellipse first; valid until the next
  ///         call. Allocates only when pairs outnumber those of every earlier call.
  [[nodiscard]] std::span<const ArcPair> find(std::span<const Arc> arcs,
                                              std::span<const std::uint8_t> is_used);

 private:
  void fit(std::span<const Arc> arcs, std::span<const std::uint8_t> is_used);

  std::vector<ArcPair> pairs_;
};

/// Sum of the moments of arcs; at least one.
[[nodiscard]] Moments moments_of(std::initializer_list<const Arc*> arcs);

}  // namespace ellipse
