#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

/// Decides from the QoS events of the sink which frames are too late for an analysis. A value type
/// without a lock.
class Lateness {
 public:
  /// @param timestamp  Running time of a frame [ns], as in the QoS event; may be NONE.
  /// @param jitter     Its lateness [ns]; negative if it was early.
  void observe(GstClockTime timestamp, GstClockTimeDiff jitter);

  /// Counts a frame. @return Whether to skip it. Skipping helps if the analysis causes the
  /// lateness. Another element may cause it: after four skipped frames in a row one is analysed
  /// anyway, so that the target is not lost for good.
  [[nodiscard]] bool skips_next(GstClockTime running_time);

 private:
  GstClockTime earliest_time_ = GST_CLOCK_TIME_NONE;
  guint skipped_ = 0;  // in a row
};
