#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <span>
#include <string_view>

#include "core/detection/detector.hpp"

namespace evaluate {

/// Names of the packaged ellipse detectors used for comparison: "edge-drawing", "hough-circles",
/// "canny-fit" and "randomized-hough".
[[nodiscard]] std::span<const char* const> peer_names();

/// Creates a peer. It detects all ellipses of a picture and keeps those within min_axis_px,
/// max_axis_px and max_axis_ratio; other thresholds have no effect, and both overlaps of its
/// detections are 0. Throws std::invalid_argument that names an unknown peer.
///
/// No picture throws. Not thread-safe.
[[nodiscard]] std::unique_ptr<ellipse::Detector> make_peer(std::string_view name);

}  // namespace evaluate
