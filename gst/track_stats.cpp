// SPDX-License-Identifier: MIT
#include "gst/track_stats.hpp"

#include <algorithm>

void TrackStats::add_skipped() {
  ++skipped_;
}

void TrackStats::forget_target() {
  if (had_target_) ++lost_;
  had_target_ = false;
}

void TrackStats::add_analysed(const std::optional<ellipse::Target>& target,
                              GstClockTime processing_time) {
  times_[analysed_ % kWindow] = processing_time;
  ++analysed_;
  if (had_target_ && !target) ++lost_;
  had_target_ = target.has_value();
  if (!target) return;
  ++(target->state == ellipse::TargetState::kDetected ? detected_ : tracked_);
}

GstClockTime TrackStats::quantile(double q) const {
  std::array<GstClockTime, kWindow> sorted = times_;
  const std::size_t count = std::min<std::size_t>(analysed_, kWindow);
  if (count == 0) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(count - 1) + 0.5);
  std::nth_element(
      sorted.begin(), sorted.begin() + rank, sorted.begin() + static_cast<std::ptrdiff_t>(count));
  return sorted[static_cast<std::size_t>(rank)];
}

GstStructure* TrackStats::to_structure() const {
  // clang-format off
  return gst_structure_new("ellipse-stats",
                           "frames", G_TYPE_UINT64, analysed_ + skipped_,
                           "analysed", G_TYPE_UINT64, analysed_,
                           "skipped", G_TYPE_UINT64, skipped_,
                           "detected", G_TYPE_UINT64, detected_,
                           "tracked", G_TYPE_UINT64, tracked_,
                           "lost", G_TYPE_UINT64, lost_,
                           "processing-time-median", GST_TYPE_CLOCK_TIME, quantile(0.5),
                           "processing-time-p99", GST_TYPE_CLOCK_TIME, quantile(0.99),
                           nullptr);
  // clang-format on
}
