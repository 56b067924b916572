#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

#include "core/scene/ground_painter.hpp"

namespace ellipse {

// Grounds without anything round, in grey levels relative to the ground's mean.

void gravel(Painter& painter);
void pavement(cv::Mat& tile, Painter& painter);
void foliage(Painter& painter);
void field(cv::Mat& tile, Painter& painter, std::uint64_t seed);
void page(Painter& painter);
void blades(Painter& painter);

}  // namespace ellipse
