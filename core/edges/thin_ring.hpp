#pragma once  // SPDX-License-Identifier: MIT

#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// The two edges of a painted ring.
struct RingEdges {
  Ellipse outer;
  Ellipse inner;
};

/// Removes the blur bias that separates a thin ring's two gradient maxima.
///
/// Blur separates the gradient maxima of a bar, more so for thinner bars: at zero width they are
/// two standard deviations of the blur apart. Their middle line stays in place, and the width of
/// the ring is a constant share of its radius, so that one parameter determines both edges. Edges
/// that are far apart are returned unchanged. Assumes equal contrast on both sides of the ring and
/// a lens in focus, as for kSharpVariance.
///
/// Own derivation, see docs/provenance.md. Allocates nothing.
[[nodiscard]] RingEdges without_blur_bias(const RingEdges& maxima);

/// Whether two gradient maxima are so close, all around, that blur displaces them.
[[nodiscard]] bool is_thin(const RingEdges& maxima);

/// Distance of the two gradient maxima of a very thin bar along an axis [px]. The first call of
/// this or of without_blur_bias() computes a table, which takes a few milliseconds.
[[nodiscard]] double min_maxima_distance();

/// Largest ratio of inner to outer radius at which a ring is distinguished from a line.
inline constexpr double kMaxRingRatio = 0.97;

/// Whether two ellipses may be the edges of one ring: concentric, with a ratio of semi-major axes
/// from 1/4 to kMaxRingRatio.
[[nodiscard]] bool are_partners(const Ellipse& a, const Ellipse& b);

}  // namespace ellipse
