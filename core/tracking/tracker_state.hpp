#pragma once  // SPDX-License-Identifier: MIT

namespace ellipse {

/// State of the tracker in one frame, see docs/architecture.md. Without edge tracking it is
/// kFollowing in a frame with a target, else kSearching.
enum class TrackerState {
  kSearching,   ///< No target: the detector searches.
  kConfirming,  ///< A hypothesis is tracked, but not reported: its odds are below the limit.
  kFollowing,   ///< The target is tracked and reported.
  kCoasting,    ///< Its matched edges do not determine its position: its prediction is reported.
};

}  // namespace ellipse
