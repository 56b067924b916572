// SPDX-License-Identifier: MIT
#include "gst/track/track_stats.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

const gchar* nick_of(Skip reason) {
  static constexpr const gchar* kNicks[] = {"interval", "late", "load", "region", "failed"};
  return kNicks[static_cast<std::size_t>(reason)];
}

void TrackStats::add_skipped(Skip reason) {
  ++skipped_[static_cast<std::size_t>(reason)];
}

// Counts the target of the frame before as lost unless it has this id.
void TrackStats::follow(std::optional<guint64> id) {
  if (followed_ && followed_ != id) ++lost_;
  followed_ = id;
}

void TrackStats::reset_target() {
  follow(std::nullopt);
}

void TrackStats::add_analysed(const std::optional<ellipse::Target>& target,
                              GstClockTime processing_time) {
  times_[analysed_ % kWindow] = processing_time;
  ++analysed_;
  follow(target ? std::optional<guint64>(target->id) : std::nullopt);
  if (!target) return;
  switch (target->state) {
    case ellipse::TargetState::kDetected:
      ++detected_;
      break;
    case ellipse::TargetState::kTracked:
      ++tracked_;
      break;
    case ellipse::TargetState::kPredicted:
      ++predicted_;
      break;
  }
}

// @param left_out  Number of longest times to ignore.
GstClockTime TrackStats::quantile(double q, std::size_t left_out) const {
  std::array<GstClockTime, kWindow> sorted = times_;
  const std::size_t count = std::min<std::size_t>(analysed_, kWindow);
  if (count <= left_out) return 0;
  const std::ptrdiff_t rank = std::min(std::lround(q * static_cast<double>(count - 1)),
                                       static_cast<long>(count - 1 - left_out));
  std::nth_element(
      sorted.begin(), sorted.begin() + rank, sorted.begin() + static_cast<std::ptrdiff_t>(count));
  return sorted[static_cast<std::size_t>(rank)];
}

GstClockTime TrackStats::latency() const {
  return (quantile(0.99, 1) + GST_MSECOND - 1) / GST_MSECOND * GST_MSECOND;
}

GstStructure* TrackStats::to_structure() const {
  const guint64 skipped = std::accumulate(skipped_.begin(), skipped_.end(), guint64{0});
  const auto skipped_for = [this](Skip reason) {
    return skipped_[static_cast<std::size_t>(reason)];
  };
  // clang-format off
  return gst_structure_new("ellipse-stats",
                           "frames", G_TYPE_UINT64, analysed_ + skipped,
                           "analysed", G_TYPE_UINT64, analysed_,
                           "skipped", G_TYPE_UINT64, skipped,
                           "skipped-interval", G_TYPE_UINT64, skipped_for(Skip::kInterval),
                           "skipped-late", G_TYPE_UINT64, skipped_for(Skip::kLate),
                           "skipped-load", G_TYPE_UINT64, skipped_for(Skip::kLoad),
                           "skipped-region", G_TYPE_UINT64, skipped_for(Skip::kRegion),
                           "skipped-failed", G_TYPE_UINT64, skipped_for(Skip::kFailed),
                           "detected", G_TYPE_UINT64, detected_,
                           "tracked", G_TYPE_UINT64, tracked_,
                           "predicted", G_TYPE_UINT64, predicted_,
                           "lost", G_TYPE_UINT64, lost_,
                           "processing-time-median", GST_TYPE_CLOCK_TIME, quantile(0.5),
                           "processing-time-p99", GST_TYPE_CLOCK_TIME, quantile(0.99),
                           "processing-time-max", GST_TYPE_CLOCK_TIME, quantile(1.0),
                           "latency", GST_TYPE_CLOCK_TIME, latency(),
                           nullptr);
  // clang-format on
}
