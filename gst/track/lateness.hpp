#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

/// Which frames are too late to be worth an analysis, from what the sink says (QoS). A value
/// without a lock of its own.
class Lateness {
 public:
  /// @param timestamp  Running time of a frame [ns], as in the QoS event; may be NONE.
  /// @param jitter     By how much it was late [ns]; negative where it was early.
  void observe(GstClockTime timestamp, GstClockTimeDiff jitter);

  /// Whether the frame of this running time should be skipped. Skipping helps where the analysis is
  /// what is late. Where another element is, the target must not be out of sight for good: after
  /// four late frames in a row one is analysed all the same.
  [[nodiscard]] bool takes_a_skip(GstClockTime running_time);

 private:
  GstClockTime earliest_time_ = GST_CLOCK_TIME_NONE;
  guint skipped_ = 0;  // in a row
};
