#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>

#include "core/detection/trace_image.hpp"
#include "core/tracking/settings.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// A frame to analyse outside the pipeline.
struct AnalysisRequest {
  FramePtr frame;
  ellipse::TrackerSettings settings;
  std::optional<ellipse::Stage> stage = {};  ///< Stage to draw; none = no picture.
};

/// Runs the detector on the whole frame, without prior knowledge of the target. Returns a JSON
/// object with the passes and all candidates, accepted or rejected, with the reasons; docs/live.md
/// describes it. Thread-safe.
///
/// Throws std::runtime_error if the frame cannot be mapped.
[[nodiscard]] std::string analysis_json(const AnalysisRequest& request);

}  // namespace live
