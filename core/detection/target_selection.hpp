#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

#include "core/detection/detector.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Chooses the target among the ellipses of a picture: SelectTarget of [Keipour2021] Algorithm 3.
///
/// 0. While tracking, only ellipses that may be the last target count: centre at most a semi-major
///    axis away, major axis between half and twice the last one.
/// 1. Concentric sets rank by their largest probability, then by having two different edges: a
///    painted ring shows two, so sets precede single ellipses ([Keipour2021] II.4).
/// 2. Among equal sets, the one with the largest sum of scores wins.
/// 3. The target is its outermost ellipse with at least a quarter of its best score. Of two fits
///    to one edge, the one with the better score counts.
///
/// @param last_target  The target of the last frame, in the same pixels; nullopt = not tracking.
/// @param trace        Trace of the detections, or nullptr: receives why each is not the target.
/// Deterministic, thread-safe, allocates nothing; O(N^2).
[[nodiscard]] std::optional<Detection> select_target(std::span<const Detection> detections,
                                                     const std::optional<Ellipse>& last_target = {},
                                                     DetectionTrace* trace = nullptr);

/// What the tracker knows of its target besides the detections.
struct KnownTarget {
  Ellipse ellipse;
  bool has_two_edges = false;        ///< Whether it has inner edges.
  std::optional<double> score = {};  ///< Of its outline in this frame, as Detection::score.
};

/// Whether to switch from the tracked target (`followed`) to `chosen`: to an edge farther out of
/// the same target, or to a better set of concentric ellipses elsewhere. A set with two edges
/// replaces a single edge that is not more probable; a single edge never replaces two. Between
/// equals the sum of scores must be 1.5 times as large; one that encloses `followed`, which may be
/// a detail of it, need only be better, as without tracking.
///
/// @param detections  Of the frame that shows both. A search that ends at a reduced size may miss
///                    edges of `followed`.
/// Deterministic, thread-safe, allocates nothing; O(N).
[[nodiscard]] bool is_better_target(const Ellipse& chosen,
                                    const KnownTarget& followed,
                                    std::span<const Detection> detections);

}  // namespace ellipse
