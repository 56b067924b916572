#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Frames by how much of the target's perimeter they show; the last range is that of a target
/// larger than the frame.
inline constexpr std::size_t kVisibleRanges = 6;
inline constexpr std::array<const char*, kVisibleRanges> kVisibleRangeNames = {
    "60 % and more", "30 to 60 %", "15 to 30 %", "5 to 15 %", "up to 5 %", "inside only"};

/// How a method did on the frames of one range.
struct RangeCounts {
  int frames = 0;
  int right = 0;     ///< IoU inside the frame >= 0.8.
  int centre_5 = 0;  ///< The centre within 5 % of the semi-major axis.
  int centre_2 = 0;  ///< Within 2 %.
  int wrong = 0;     ///< Neither right nor the centre within 5 %.
  int none = 0;
};

/// How a method followed its target through whole sequences.
struct TrackingMeasures {
  /// From the first frame on that shows kMinToStart of the perimeter, in each sequence and after
  /// each time that nothing of the target was in view.
  std::array<RangeCounts, kVisibleRanges> ranges;
  int wrong_before = 0;      ///< Wrong answers in the frames before those.
  int empty_frames = 0;      ///< Show nothing of the target; of the whole sequences.
  int locks_on_nothing = 0;  ///< Of these, where a target was reported.
  int given = 0;             ///< Answers that the method was told; counted nowhere else.
  /// One value for each time when kMinToStart of the perimeter is visible again after less, and
  /// the method was meanwhile without its target, or the target out of view: the number of frames
  /// until it is right, 1 = at once, infinity = not before the next such time or the end. Without
  /// those where it was told.
  std::vector<double> returns;
  std::vector<double> centre_errors_px;  ///< Of right answers in the first range.
  std::vector<double> times_ms;          ///< Of all frames.

  [[nodiscard]] int wrong() const;  ///< In all ranges, and before.
};

/// Frames that are not labelled do not count.
[[nodiscard]] TrackingMeasures tracking_measures_of(const Evaluation& evaluation,
                                                    std::size_t method,
                                                    const std::string& dataset);

}  // namespace evaluate
