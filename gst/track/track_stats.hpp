#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <cstddef>
#include <optional>

#include "core/tracking/tracker.hpp"

/// Why a frame passed without analysis.
enum class Skip {
  kInterval,  ///< It was not its turn.
  kLate,      ///< The sink was late (QoS).
  kLoad,      ///< Analyses take longer than they may.
  kRegion,    ///< Nothing of it was to be searched.
  kFailed,    ///< It could not be read or analysed.
};

/// Its name in the field "skipped-...".
[[nodiscard]] const gchar* nick_of(Skip reason);

/// Counts what becomes of the frames of a stream. Not thread-safe: the element's lock guards it.
class TrackStats {
 public:
  void add_skipped(Skip reason);
  /// Whatever was followed counts as lost.
  void forget_target();
  /// @param processing_time  [ns]
  void add_analysed(const std::optional<ellipse::Target>& target, GstClockTime processing_time);

  /// What the analysis adds to a live pipeline's latency [ns]: the 99th percentile of the
  /// processing times, but not the longest, for the first frame finds the caches cold; in whole ms
  /// from above, so that it seldom changes. 0 before the second frame.
  [[nodiscard]] GstClockTime latency() const;

  /// Counts, and times [ns] over the last kWindow analysed frames; docs/elements.md names the
  /// fields. (transfer full)
  [[nodiscard]] GstStructure* to_structure() const;

 private:
  static constexpr std::size_t kWindow = 1024;

  [[nodiscard]] GstClockTime quantile(double q, std::size_t left_out = 0) const;

  guint64 analysed_ = 0;
  std::array<guint64, 5> skipped_{};  // by Skip
  guint64 detected_ = 0;
  guint64 tracked_ = 0;
  guint64 predicted_ = 0;
  guint64 lost_ = 0;
  bool had_target_ = false;
  std::array<GstClockTime, kWindow> times_{};
};
