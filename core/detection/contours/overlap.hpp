#pragma once  // SPDX-License-Identifier: MIT

#include <opencv2/core/types.hpp>
#include <span>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Largest distance of a pixel that counts as on an ellipse [px]: half the width of its 3 x 3
/// neighbourhood.
inline constexpr double kOverlapTolerancePx = 1.5;

/// ContourOverlap: the share of the contour's pixels that lie on the ellipse, 0 to 1.
/// [Keipour2021] Eq. (1). Counts a pixel once per visit of the contour. 0 when empty.
/// Thread-safe, allocates nothing; O(pixels).
[[nodiscard]] double contour_overlap(std::span<const cv::Point> contour, const Ellipse& e);

/// Length of an ellipse's perimeter on edges.
struct PerimeterSupport {
  double inside_px = 0.0;   ///< Length of the perimeter inside the picture.
  double on_edge_px = 0.0;  ///< Length of this part on edges.

  /// EllipseOverlap: the share of the perimeter on edges, 0 to 1. [Keipour2021] Eq. (2). Only the
  /// perimeter inside the picture counts. 0 if none is inside.
  [[nodiscard]] double ellipse_overlap() const {
    return inside_px > 0.0 ? on_edge_px / inside_px : 0.0;
  }
};

/// @param thick_edges  Edge map, nonzero on edges, already dilated by 3 x 3.
/// Thread-safe, allocates nothing; O(perimeter).
[[nodiscard]] PerimeterSupport perimeter_support(const Ellipse& e, const ImageView& thick_edges);

}  // namespace ellipse
