#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

/// Keeps the analysis within a time per frame. Three frames over the limit, with none under half of
/// it between them, make the search coarser by a factor of two, down to an eighth; after that every
/// second frame passes without analysis, then three of four. 128 frames under half the limit, about
/// four seconds, undo one step; times in between change nothing. A value type without a lock; reads
/// no clock.
class LoadWatch {
 public:
  /// @param processing_time  Processing time of an analysed frame [ns].
  /// @param limit            Its maximum [ns]; 0 = no limit.
  /// @return Whether scale() or skipped_in_a_row() has changed.
  bool add(GstClockTime processing_time, GstClockTime limit);

  /// Counts a frame. @return Whether it passes without analysis.
  [[nodiscard]] bool skips_next();

  [[nodiscard]] bool is_overloaded() const { return step_ > 0; }
  /// Finest frame scale to search: 1, 2, 4 or 8.
  [[nodiscard]] int scale() const;
  /// Number of frames that pass between two analysed ones: 0, 1 or 3.
  [[nodiscard]] int skipped_in_a_row() const;

 private:
  int step_ = 0;
  int score_ = 0;
  int skipped_ = 0;
};
