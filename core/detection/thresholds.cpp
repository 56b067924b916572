// SPDX-License-Identifier: MIT
#include "core/detection/thresholds.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "core/edges/chains.hpp"

namespace ellipse {
void check_range(const char* field, double value, const Range& range) {
  if (range.contains(value)) return;
  std::ostringstream message;
  message << field << " = " << value << " is not in [" << range.min << ", " << range.max << "]";
  throw std::invalid_argument(message.str());
}

void check_order(const char* min_field, double min, const char* max_field, double max) {
  if (min <= max) return;
  std::ostringstream message;
  message << min_field << " = " << min << " is above " << max_field << " = " << max;
  throw std::invalid_argument(message.str());
}

void Thresholds::validate() const {
  check_range("contour_overlap", contour_overlap, kShareRange);
  check_range("ellipse_overlap", ellipse_overlap, kShareRange);
  check_range("min_probability", min_probability, kShareRange);
  check_range("min_axis_px", min_axis_px, kAxisRangePx);
  check_range("max_axis_px", max_axis_px, kAxisRangePx);
  check_order("min_axis_px", min_axis_px, "max_axis_px", max_axis_px);
  check_range("max_axis_ratio", max_axis_ratio, kAxisRatioRange);
  check_range("min_contour_size", min_contour_size, kContourSizeRangePx);
  check_range("edge_high", edge_high, kEdgeRange);
  check_range("edge_low", edge_low, kEdgeRange);
  if (edge_high > 0.0) check_order("edge_low", edge_low, "edge_high", edge_high);
}

Verdict Thresholds::judge_axes_of(const Ellipse& e) const {
  const Verdict large = at_most(Reason::kTooLarge, 2.0 * e.semi_major, max_axis_px);
  if (!large.is_accepted()) return large;
  const Verdict small = at_least(Reason::kTooSmall, 2.0 * e.semi_minor, min_axis_px);
  if (!small.is_accepted()) return small;
  return at_most(Reason::kTooFlat, e.aspect_ratio(), max_axis_ratio);
}

Thresholds Thresholds::at_scale(int scale) const {
  Thresholds result = *this;
  result.min_axis_px /= scale;
  result.max_axis_px /= scale;
  result.min_contour_size =
      std::max(min_contour_size / scale,
               std::min(min_contour_size, static_cast<int>(ChainTracer::kMinLength)));
  return result;
}

}  // namespace ellipse
