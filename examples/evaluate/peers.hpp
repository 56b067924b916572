#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <span>
#include <string_view>

#include "core/detection/detector.hpp"

namespace evaluate {

/// The packaged ways to find ellipses that the tracker's own detector is measured against:
/// "edge-drawing", "hough-circles", "canny-fit" and "randomized-hough".
[[nodiscard]] std::span<const char* const> peer_names();

/// One of them. Each looks for every ellipse of a picture, keeps those within min_axis_px,
/// max_axis_px and max_axis_ratio, and reads no other threshold; both overlaps of its detections
/// are 0. Throws std::invalid_argument that names the peer, where it is unknown.
///
/// No content of a picture throws. One object serves one thread at a time.
[[nodiscard]] std::unique_ptr<ellipse::Detector> make_peer(std::string_view name);

}  // namespace evaluate
