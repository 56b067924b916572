#pragma once  // SPDX-License-Identifier: MIT

#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Passes frames from the pipeline to the main loop: the newest frame, and the JSON lines that have
/// not been fetched. Bounded: the oldest lines are dropped.
///
/// While the view is held, the newest frame does not change and the pipeline continues.
class FrameStore {
 public:
  /// @param on_change  Called in the main loop after new frames. Several frames may share one call.
  explicit FrameStore(std::function<void()> on_change);

  /// Thread-safe; blocks only for a short lock.
  void put(FramePtr frame);

  /// Replaces the newest frame by another analysis of the same picture. Thread-safe. @return false
  /// if the newest frame is no longer `before`.
  bool replace(const FramePtr& before, FramePtr after);

  /// The newest frame; nullptr before the first one. Thread-safe.
  [[nodiscard]] FramePtr newest() const;

  /// The lines since the last call, oldest first. Thread-safe.
  [[nodiscard]] std::vector<std::string> take_lines();

  /// Holds the view. If there is no frame yet, the first one is still accepted.
  void hold();
  void release();
  /// Holds the view at another frame.
  void show(FramePtr frame);
  /// Discards the newest frame and releases the view.
  void clear();
  /// Accepts one more frame while the view is held.
  void step();
  [[nodiscard]] bool is_held() const;

 private:
  static constexpr std::size_t kMaxLines = 64;
  FramePtr take(FramePtr frame);

  mutable std::mutex mutex_;
  FramePtr newest_;
  std::deque<std::string> lines_;
  bool is_held_ = false;
  int steps_ = 0;
  Wakeup wakeup_;
};

}  // namespace live
