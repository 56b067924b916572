// SPDX-License-Identifier: MIT
#include "gst/track/lateness.hpp"

static constexpr guint kMaxSkipped = 4;

void Lateness::observe(GstClockTime timestamp, GstClockTimeDiff jitter) {
  // Twice the lateness, as in GStreamer's base classes, so that the next frame is in time again.
  earliest_time_ = GST_CLOCK_TIME_IS_VALID(timestamp) && jitter > 0
                       ? timestamp + 2 * static_cast<GstClockTime>(jitter)
                       : GST_CLOCK_TIME_NONE;
}

bool Lateness::skips_next(GstClockTime running_time) {
  const bool is_late = GST_CLOCK_TIME_IS_VALID(running_time) &&
                       GST_CLOCK_TIME_IS_VALID(earliest_time_) && running_time <= earliest_time_;
  skipped_ = is_late && skipped_ < kMaxSkipped ? skipped_ + 1 : 0;
  return skipped_ > 0;
}
