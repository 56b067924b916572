#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <cstddef>
#include <optional>

#include "core/tracker.hpp"

/// Counts what becomes of the frames of a stream. Not thread-safe: the element's lock guards it.
class TrackStats {
 public:
  void add_skipped();
  /// Whatever was followed counts as lost.
  void forget_target();
  void add_analysed(const std::optional<ellipse::Target>& target, GstClockTime processing_time);

  /// frames, analysed, skipped, detected, tracked, lost; median and 99th percentile of the
  /// processing times [ns] of the last kWindow analysed frames. (transfer full)
  [[nodiscard]] GstStructure* to_structure() const;

 private:
  static constexpr std::size_t kWindow = 1024;

  [[nodiscard]] GstClockTime quantile(double q) const;

  guint64 analysed_ = 0;
  guint64 skipped_ = 0;
  guint64 detected_ = 0;
  guint64 tracked_ = 0;
  guint64 lost_ = 0;
  bool had_target_ = false;
  std::array<GstClockTime, kWindow> times_{};
};
