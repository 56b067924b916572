#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <limits>

namespace ellipse {

inline constexpr double kFrame_s = 1.0 / 30.0;  ///< Assumed time between frames if unknown.

/// Longest time without a match after which a target is still the same.
inline constexpr double kMemory_s = 0.3;

/// Without frames: the longest interval that counts. Without a target: the time after which full
/// searches are periodic.
inline constexpr double kLongAbsence_s = 1.0;

/// Time between frames. Depacketizers and decoders omit some time stamps: a frame without one
/// repeats the previous interval.
class FrameClock {
 public:
  /// @param pts_ns  Time stamp of a frame; negative if it has none.
  /// @return Time since the previous frame [s], at most 1, a whole number of microseconds; kFrame_s
  ///         if unknown: at the first frame, in a stream without time stamps, and where time stamps
  ///         do not increase.
  double advance_to(std::int64_t pts_ns);

 private:
  double now_ns_ = std::numeric_limits<double>::quiet_NaN();
  double interval_s_ = kFrame_s;
};

}  // namespace ellipse
