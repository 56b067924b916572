#pragma once  // SPDX-License-Identifier: MIT

#include <span>

namespace ellipse {

/// Refinement of a tracked ellipse.
enum class Refinement {
  kNone,         ///< None: the ellipse follows from the match of all edges.
  kEdges,        ///< Fit to the gradient maxima along the outer edge.
  kPhotometric,  ///< Fit to the brightness of all pixels along it; kEdges for thin rings and
                 ///< distorted lenses.
};

/// The nicks, in enum order.
[[nodiscard]] std::span<const char* const> refinement_nicks();

}  // namespace ellipse
