#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>
#include <tuple>

#include "core/detection/detector.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Chooses the target among the ellipses of a picture: SelectTarget of [Keipour2021] Algorithm 3.
///
/// 0. While a target is being tracked, only an ellipse that can be the same one counts: its centre
///    at most a semi-major axis away, its major axis between half and twice the last one.
/// 1. A painted ring shows two concentric ellipses, so while any two concentric ellipses of
///    different size are there, single ones are ignored ([Keipour2021] II.4).
/// 2. Among the sets that remain, the one with the largest sum of scores wins.
/// 3. Its outermost ellipse is the target, of those with at least a quarter of its best score.
///    Where both sides of one edge were found, the better scored of the two.
///
/// @param last_target  The target of the frame before, in the same pixels; nullopt = not tracking.
/// @param trace        Of the detections, if there is one: is told why each of them is not it.
/// Deterministic, thread-safe, allocates nothing; O(N^2).
[[nodiscard]] std::optional<Detection> select_target(std::span<const Detection> detections,
                                                     const std::optional<Ellipse>& last_target = {},
                                                     DetectionTrace* trace = nullptr);

/// What is known of the set of all ellipses that are concentric with one.
struct ConcentricSet {
  double probability = 0.0;  ///< The largest; the same of all where a detector does not say.
  bool has_two_edges = false;
  double score = 0.0;
  double best_score = 0.0;

  bool operator<(const ConcentricSet& other) const {
    return std::tie(probability, has_two_edges, score) <
           std::tie(other.probability, other.has_two_edges, other.score);
  }
};

/// The set around an ellipse, which need not be one of the detections.
[[nodiscard]] ConcentricSet set_around(const Ellipse& ellipse,
                                       std::span<const Detection> detections);

}  // namespace ellipse
