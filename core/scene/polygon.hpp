#pragma once  // SPDX-License-Identifier: MIT

#include <opencv2/core.hpp>
#include <span>

namespace ellipse {

/// Units of polygon corners per pixel.
inline constexpr int kPolygonUnitsPerPx = 16;

/// Fills a polygon, its border included, in integer arithmetic: the same pixels on every machine
/// and with every version of OpenCV, whose fillPoly() changed between 4.6 and 4.10.
///
/// @param tile     One float per pixel. The polygon is clipped to it.
/// @param corners  In order, in 1 / kPolygonUnitsPerPx px. May cross itself: even-odd.
void fill_polygon(cv::Mat& tile, std::span<const cv::Point> corners, float level);

}  // namespace ellipse
