// SPDX-License-Identifier: MIT
#include "core/tracking/frame_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Sources round time stamps differently.
double whole_microseconds(double seconds) {
  return std::round(1e6 * seconds);
}

}  // namespace

double FrameClock::advance_to(std::int64_t pts_ns) {
  if (pts_ns < 0) {
    now_ns_ += 1e9 * interval_s_;
  } else {
    const auto pts = static_cast<double>(pts_ns);
    const double elapsed_s = 1e-9 * (pts - now_ns_);
    now_ns_ = pts;
    const bool is_later = whole_microseconds(elapsed_s) > 0.0;
    if (elapsed_s >= kLongAbsence_s) return kLongAbsence_s;  // a pause is not repeated
    interval_s_ = is_later ? elapsed_s : kFrame_s;
  }
  return 1e-6 * whole_microseconds(interval_s_);
}

}  // namespace ellipse
