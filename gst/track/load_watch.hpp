#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

/// Keeps the analysis within a time per frame. Three frames that took longer make the search
/// coarser by a factor of two, down to an eighth; three more, and every second frame passes
/// unanalysed, then three of four. Some four seconds' worth of frames in less than half of the time
/// take back one step: what lies between changes nothing. A value without a lock; reads no clock.
class LoadWatch {
 public:
  /// @param processing_time  What an analysed frame took [ns].
  /// @param limit            What it may take [ns]; 0 = any.
  /// @return Whether scale() or skipped_in_a_row() is another from here on.
  bool add(GstClockTime processing_time, GstClockTime limit);

  /// Whether the next frame should pass. Asked once a frame.
  [[nodiscard]] bool takes_a_skip();

  [[nodiscard]] bool is_overloaded() const { return step_ > 0; }
  /// The finest frame scale to search at: 1, 2, 4 or 8.
  [[nodiscard]] int scale() const;
  /// Frames that pass between two that are analysed: 0, 1 or 3.
  [[nodiscard]] int skipped_in_a_row() const;

 private:
  int step_ = 0;
  int score_ = 0;
  int skipped_ = 0;
};
