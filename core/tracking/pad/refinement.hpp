#pragma once  // SPDX-License-Identifier: MIT

#include <span>

namespace ellipse {

/// What makes a followed ellipse exact.
enum class Refinement {
  kNone,         ///< Nothing: where the edges that it is followed by put it.
  kEdges,        ///< The gradient maxima along the outer edge.
  kPhotometric,  ///< The brightness of all pixels along it; gradient maxima where the ring is too
                 ///< thin.
};

/// Their nicks, in their order.
[[nodiscard]] std::span<const char* const> refinement_nicks();

}  // namespace ellipse
