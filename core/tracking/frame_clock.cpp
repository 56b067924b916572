// SPDX-License-Identifier: MIT
#include "core/tracking/frame_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

constexpr double kFrame_ns = 1e9 * kFrame_s;
constexpr double kShortest_ns = 1e3;  // shorter intervals are of equal time stamps
constexpr double kLongestGap_ns = 1e9;

}  // namespace

double FrameClock::advance_to(std::int64_t pts_ns) {
  if (pts_ns < 0) {
    now_ns_ += interval_ns_;
  } else {
    const auto pts = static_cast<double>(pts_ns);
    const double elapsed = pts - now_ns_;
    now_ns_ = pts;
    interval_ns_ = elapsed >= kShortest_ns ? std::min(elapsed, kLongestGap_ns) : kFrame_ns;
  }
  // In whole microseconds, so that sources that round time stamps differently give the same result.
  return std::round(1e-3 * interval_ns_) / (1e-3 * kFrame_ns);
}

}  // namespace ellipse
