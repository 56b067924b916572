#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <cstddef>
#include <optional>

#include "core/tracking/tracker.hpp"

/// Why a frame passed without analysis.
enum class Skip {
  kInterval,  ///< Not an n-th frame.
  kLate,      ///< The sink was late (QoS).
  kLoad,      ///< Analyses exceed max-processing-time.
  kRegion,    ///< The search region was empty.
  kFailed,    ///< It could not be read or analysed.
};

/// The name of a cause in the field "skipped-...".
[[nodiscard]] const gchar* nick_of(Skip reason);

/// Counts the frames of a stream by outcome. Not thread-safe: the element's lock guards it.
class TrackStats {
 public:
  void add_skipped(Skip reason);
  /// Counts a followed target as lost.
  void reset_target();
  /// @param processing_time  [ns]
  void add_analysed(const std::optional<ellipse::Target>& target, GstClockTime processing_time);

  /// Latency of the analysis in a live pipeline [ns]: the 99th percentile of the processing times
  /// without the longest, because the first frame runs with cold caches; rounded up to whole ms, so
  /// that it rarely changes. 0 before the second frame.
  [[nodiscard]] GstClockTime latency() const;

  /// Counts, and times [ns] over the last kWindow analysed frames; fields: docs/elements.md.
  /// (transfer full)
  [[nodiscard]] GstStructure* to_structure() const;

 private:
  static constexpr std::size_t kWindow = 1024;

  void follow(std::optional<guint64> id);
  [[nodiscard]] GstClockTime quantile(double q, std::size_t left_out = 0) const;

  guint64 analysed_ = 0;
  std::array<guint64, 5> skipped_{};  // by Skip
  guint64 detected_ = 0;
  guint64 tracked_ = 0;
  guint64 predicted_ = 0;
  guint64 lost_ = 0;
  std::optional<guint64> followed_;  // id of the target in the frame before
  std::array<GstClockTime, kWindow> times_{};
};
