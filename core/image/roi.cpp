// SPDX-License-Identifier: MIT
#include "core/image/roi.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// [center - half, center + half] rounded out to multiples of `scale`, clipped to [0, limit).
struct Span {
  int begin = 0;
  int length = 0;
};

Span covered(double center, double half, int scale, int limit) {
  const double begin = std::clamp(center - half, 0.0, static_cast<double>(limit));
  const double end = std::clamp(center + half + 1.0, 0.0, static_cast<double>(limit));
  const int first = static_cast<int>(begin / scale) * scale;
  const int last = std::min(static_cast<int>(std::ceil(end / scale)) * scale, limit);
  return {first, end > begin ? last - first : 0};
}

}  // namespace

Rect calculate_roi(
    const Ellipse& target, double expansion, int scale, int frame_width, int frame_height) {
  const double margin = (expansion - 1.0) * target.semi_major;
  const Eigen::Vector2d half = half_extent(target).array() + margin;
  const Span columns = covered(target.cx, half.x(), scale, frame_width);
  const Span rows = covered(target.cy, half.y(), scale, frame_height);
  if (columns.length == 0 || rows.length == 0) return {};
  return {columns.begin, rows.begin, columns.length, rows.length};
}

}  // namespace ellipse
