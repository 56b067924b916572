#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

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

/// Whether a target that is followed is left for another: for an edge of the same one farther out,
/// or for a better set of concentric ellipses.
///
/// @param detections  Of the frame that shows both; the one that is followed need not be among
/// them. Deterministic, thread-safe, allocates nothing; O(N).
[[nodiscard]] bool is_better_target(const Ellipse& chosen,
                                    const Ellipse& followed,
                                    std::span<const Detection> detections);

}  // namespace ellipse
