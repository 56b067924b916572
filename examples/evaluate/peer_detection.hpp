#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <vector>

#include "core/detection/detector.hpp"

namespace evaluate {

/// The ellipse with these semi-axes [px], a along angle_rad and b across, whichever is longer.
/// nullopt where a number is not finite or a semi-axis not above 0. Thread-safe.
[[nodiscard]] std::optional<ellipse::Ellipse> ellipse_of_axes(
    double cx, double cy, double a, double b, double angle_rad);

/// What a peer found, where the peer itself says nothing of its evidence: scored by its perimeter.
[[nodiscard]] ellipse::Detection scored_by_perimeter(const ellipse::Ellipse& e);

}  // namespace evaluate
