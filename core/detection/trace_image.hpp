#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detection/detection_trace.hpp"

namespace ellipse {

/// What of a pass is drawn.
enum class Stage {
  kLuma,        ///< What was looked at.
  kEdges,       ///< The thinned edges.
  kChains,      ///< Contours or chains, each in a colour of its own; contours too short in grey.
  kArcs,        ///< What guesses are made of, each in a colour of its own, before the rest in grey.
  kCandidates,  ///< All ellipses over the luma: found, the target, refused.
};

/// Their nicks, in their order. Valid for ever; thread-safe.
[[nodiscard]] std::span<const char* const> stage_nicks();

/// 8 bits each of red, green and blue, row by row without gaps.
struct RgbPicture {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  std::vector<std::uint8_t> pixels;
};

/// Draws one stage of a pass, in pixels of the pass.
/// @param pass  Its number; empty picture where there is none.
/// Thread-safe; allocates the picture.
[[nodiscard]] RgbPicture draw_stage(const DetectionTrace& trace, std::size_t pass, Stage stage);

}  // namespace ellipse
