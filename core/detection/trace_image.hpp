#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detection/detection_trace.hpp"

namespace ellipse {

/// The stage of a pass to draw.
enum class Stage {
  kLuma,        ///< The input picture.
  kEdges,       ///< The thinned edges.
  kChains,      ///< Contours or chains, one colour each; contours too short in grey.
  kArcs,        ///< The arcs used for candidates, one colour each, over all chains in grey.
  kCandidates,  ///< All ellipses over the dimmed luma: rejected, found, the target.
};

/// Nicks in the order of Stage. Static lifetime; thread-safe.
[[nodiscard]] std::span<const char* const> stage_nicks();

/// Red, green and blue with 8 bits each, row by row without padding.
struct RgbPicture {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  std::vector<std::uint8_t> pixels;
};

/// Draws one stage of a pass, in pixels of the pass.
/// @param pass  Index of the pass; the picture is empty if it does not exist.
/// Thread-safe; allocates the picture.
[[nodiscard]] RgbPicture draw_stage(const DetectionTrace& trace, std::size_t pass, Stage stage);

}  // namespace ellipse
