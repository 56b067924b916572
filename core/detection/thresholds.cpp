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
