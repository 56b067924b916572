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
/// Smoothing draws the two edges of a bar apart, the more, the thinner it is: a bar without width
/// has its gradient maxima two standard deviations of the blur from each other. What lies between
/// them stays in place, and the share of the ring in its radius is the same all around; so one
/// number tells both edges. Edges that are far apart stay as they are. The paint is taken to be as
/// different from what is inside as from what is outside, and the lens to be in focus, as for
/// kMaximumShift.
///
/// Own derivation, see docs/provenance.md. Allocates nothing.
[[nodiscard]] RingEdges without_repulsion(const RingEdges& maxima);

/// Computes the table that without_repulsion() otherwise computes in its first call.
void prepare_repulsion();

/// A ring cannot be thinner than this to be told from a line: inner over outer radius.
inline constexpr double kMaxRingRatio = 0.97;

/// Same centre and shape, another radius, as the two edges of a ring at least this thick.
[[nodiscard]] bool are_partners(const Ellipse& a,
                                const Ellipse& b,
                                double largest_ratio = kMaxRingRatio);

}  // namespace ellipse
