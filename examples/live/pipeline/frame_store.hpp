#pragma once  // SPDX-License-Identifier: MIT

#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Where the pipeline leaves its frames for those who look at them: the newest frame, and the JSON
/// lines that were not taken yet. Bounded; whoever does not fetch in time misses the oldest.
///
/// The view can be held: then the newest frame stays what it is, while the pipeline runs on.
class FrameStore {
 public:
  /// @param on_change  Called in the main loop after one or more frames have come.
  explicit FrameStore(std::function<void()> on_change);

  /// Any thread; waits for nothing but a short lock.
  void put(FramePtr frame);

  /// Puts another analysis of the same picture in the place of the newest frame, where that is
  /// still `before`. @return false where it is not. Any thread.
  bool replace(const FramePtr& before, FramePtr after);

  /// The newest frame, null before the first one. Any thread.
  [[nodiscard]] FramePtr newest() const;

  /// The lines since the last call, oldest first. Any thread.
  [[nodiscard]] std::vector<std::string> take_lines();

  /// Before the first frame, that one is still let through.
  void hold();
  void release();
  /// As before the first frame.
  void clear();
  /// Lets one more frame through while the view is held.
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
