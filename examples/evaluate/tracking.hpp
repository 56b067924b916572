#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Ranges of the visible fraction of the target's perimeter. In the last range the target encloses
/// the frame.
inline constexpr std::size_t kVisibleRanges = 6;
inline constexpr std::array<const char*, kVisibleRanges> kVisibleRangeNames = {
    "60 % and more", "30 to 60 %", "15 to 30 %", "5 to 15 %", "up to 5 %", "inside only"};

/// A method's results on the frames of one range.
struct RangeCounts {
  int frames = 0;
  int right = 0;     ///< IoU inside the frame >= 0.8.
  int centre_5 = 0;  ///< Centre error within 5 % of the semi-major axis.
  int centre_2 = 0;  ///< Within 2 %.
  int wrong = 0;     ///< Neither right nor centre_5.
  int none = 0;
};

/// A method's tracking results over whole sequences.
struct TrackingMeasures {
  /// Counted from the first frame that shows kMinToStart of the perimeter, in each sequence and
  /// after each time out of view.
  std::array<RangeCounts, kVisibleRanges> ranges;
  int wrong_before = 0;      ///< Wrong answers before that frame.
  int empty_frames = 0;      ///< Frames without any part of the target, in the whole sequences.
  int locks_on_nothing = 0;  ///< Of these, frames with an answer.
  int given = 0;  ///< Answers that initialized the method with the truth; counted nowhere else.
  /// Frames until the method is right again after kMinToStart of the perimeter returns to view: 1 =
  /// immediately, infinity = not before the next return or the end. Counts returns after which the
  /// method had lost the target or the target was out of view. Excludes returns where the method
  /// was initialized with the truth.
  std::vector<double> returns;
  std::vector<double> centre_errors_px;  ///< Of right answers in the first range.
  std::vector<double> times_ms;          ///< Of all frames.

  [[nodiscard]] int wrong() const;  ///< In all ranges, and before.
};

/// Ignores frames that are not labelled.
[[nodiscard]] TrackingMeasures tracking_measures_of(const Evaluation& evaluation,
                                                    std::size_t method,
                                                    const std::string& dataset);

}  // namespace evaluate
