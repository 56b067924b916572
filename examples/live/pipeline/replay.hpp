#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/tracking/settings.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Stored frames to analyse with other settings.
struct ReplayRequest {
  std::vector<FramePtr> frames;  ///< In the order of the stream.
  ellipse::TrackerSettings settings;
  std::optional<ellipse::Rect> region = {};  ///< Search region; none = the whole frame.
  bool is_single = false;                    ///< Analyse each frame alone, without tracking.
};

/// Runs a new tracker over the frames. Returns a JSON object with the target of each frame and, for
/// single frames, all detected ellipses; docs/live.md describes it. Thread-safe.
///
/// Throws std::runtime_error if a frame cannot be mapped or a stop is requested.
[[nodiscard]] std::string replay_json(const ReplayRequest& request, const std::stop_token& stop);

}  // namespace live
