#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>

#include "core/detection/trace_image.hpp"
#include "core/tracking/settings.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// One frame that is to be looked at apart from the pipeline.
struct AnalysisRequest {
  FramePtr frame;
  ellipse::TrackerSettings settings;
  std::optional<ellipse::Stage> stage = {};  ///< Whose picture is wanted.
};

/// Detects in the whole frame, as if nothing were known of the target, and tells what was found,
/// what was refused, and why: a JSON object, see docs/live.md. Any thread.
///
/// Throws std::runtime_error where the frame cannot be read.
[[nodiscard]] std::string analysis_json(const AnalysisRequest& request);

}  // namespace live
