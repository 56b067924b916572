#pragma once  // SPDX-License-Identifier: MIT

#include "core/detection/verdict.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Valid range of a setting, bounds included. NaN is in no range.
struct Range {
  double min = 0.0;
  double max = 0.0;

  [[nodiscard]] constexpr bool contains(double value) const { return value >= min && value <= max; }
};

inline constexpr Range kShareRange{0.0, 1.0};
inline constexpr Range kAxisRangePx{1.0, 32768.0};
inline constexpr Range kAxisRatioRange{1.0, 100.0};
inline constexpr Range kContourSizeRangePx{5.0, 2147483647.0};
inline constexpr Range kEdgeRange{0.0, 1e4};

/// Throws std::invalid_argument that names field, value and range if the value is outside.
void check_range(const char* field, double value, const Range& range);

/// Throws std::invalid_argument that names both fields and values if `min` is above `max`.
void check_order(const char* min_field, double min, const char* max_field, double max);

/// Thresholds of a detector, with the names and the defaults of [Keipour2021] Table I and III.A
/// (detecting), except max_axis_px, which is 700 px there and has no limit here.
struct Thresholds {
  double contour_overlap = 0.95;          ///< Eq. (1), smallest accepted share, 0 to 1.
  double ellipse_overlap = 0.95;          ///< Eq. (2), smallest accepted share, 0 to 1.
  double min_axis_px = 5.0;               ///< mnAxSize: smallest accepted minor axis, full length.
  double max_axis_px = kAxisRangePx.max;  ///< mxAxSize: largest accepted major axis, full length.
  double max_axis_ratio = 5.0;            ///< maxAxisRatio: largest accepted major / minor axis.
  int min_contour_size = 50;              ///< minContourSize: shortest accepted contour [px].
  double edge_low = 0.0;   ///< Canny's lower threshold [grey levels / px]; 0 = adaptive.
  double edge_high = 0.0;  ///< Canny's upper threshold [grey levels / px]; 0 = adaptive.
  /// Smallest accepted, if the detector has one; 0 to 1. At 1 none is accepted, and `arcs` measures
  /// every candidate, for calibration.
  double min_probability = 0.5;
  bool wants_all = false;  ///< Report all ellipses, not only those that may be a target.

  [[nodiscard]] bool accepts_any() const { return min_probability < 1.0; }
  /// Tests both axes and their ratio against the limits: too large, too small, too flat, in this
  /// order.
  [[nodiscard]] Verdict judge_axes_of(const Ellipse& e) const;
  [[nodiscard]] bool accepts_axes(const Ellipse& e) const { return judge_axes_of(e).is_accepted(); }

  /// The thresholds for a picture reduced by `scale`: lengths are divided by it.
  /// min_contour_size is not reduced below ChainTracer::kMinLength.
  [[nodiscard]] Thresholds at_scale(int scale) const;

  bool operator==(const Thresholds&) const = default;
};

}  // namespace ellipse
