// SPDX-License-Identifier: MIT
#include "core/tracking/frame_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

constexpr double kLongestGap = 30.0;  // [1/30 s]

}  // namespace

double FrameClock::advance_to(std::int64_t pts_ns) {
  if (pts_ns < 0) {
    now_ns_ += interval_ * (1e9 * kFrame_s);
    return interval_;
  }
  const auto pts = static_cast<double>(pts_ns);
  // In whole microseconds, so that sources that round time stamps differently give the same result.
  const double elapsed = std::round((pts - now_ns_) * 1e-3) / (1e6 * kFrame_s);
  now_ns_ = pts;
  interval_ = elapsed > 0.0 ? std::min(elapsed, kLongestGap) : 1.0;
  return interval_;
}

}  // namespace ellipse
