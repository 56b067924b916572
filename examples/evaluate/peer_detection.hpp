#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <vector>

#include "core/detection/detector.hpp"

namespace evaluate {

/// The ellipse with these semi-axes [px], a along angle_rad and b across; either may be the longer
/// one. nullopt if a number is not finite or a semi-axis is not above 0. Thread-safe.
[[nodiscard]] std::optional<ellipse::Ellipse> ellipse_of_axes(
    double cx, double cy, double a, double b, double angle_rad);

/// A detection scored by its perimeter, for peers that report no evidence.
[[nodiscard]] ellipse::Detection scored_by_perimeter(const ellipse::Ellipse& e);

}  // namespace evaluate
