#pragma once  // SPDX-License-Identifier: MIT

#include <atomic>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

#include "examples/live/pipeline/frame.hpp"

namespace live {

/// The last frames of the source, for a client that compares settings on them. Bounded in number
/// and memory: the oldest are dropped. Stores frames only at a client's request, and discards them
/// when no client has used them for ten minutes.
class FrameHistory {
 public:
  struct Limits {
    std::size_t frames = 200;
    std::size_t bytes = std::size_t{256} << 20;  ///< Of their pixels.
  };

  FrameHistory() : FrameHistory(Limits()) {}
  explicit FrameHistory(const Limits& limits);
  ~FrameHistory();
  FrameHistory(const FrameHistory&) = delete;
  FrameHistory& operator=(const FrameHistory&) = delete;

  /// Copies the frame while storing. Thread-safe; call it from the streaming thread.
  void put(const Frame& frame);

  /* Main loop only. */
  /// Discards the stored frames and stores the following ones. No effect while storing.
  void begin();
  /// Stores no further frames.
  void end() { is_storing_ = false; }
  /// Stores no further frames and discards the stored ones.
  void clear();
  /// Restarts the ten minutes until unused frames are discarded.
  void touch() { used_us_ = g_get_monotonic_time(); }

  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] bool is_storing() const { return is_storing_; }
  /// Whether frames have been dropped for newer ones.
  [[nodiscard]] bool is_full() const;
  /// Oldest first.
  [[nodiscard]] std::vector<FramePtr> frames() const;
  /// @param index  Frame::index. @return nullptr if it is not stored.
  [[nodiscard]] FramePtr find(guint64 index) const;

 private:
  static gboolean on_tick(gpointer data);
  [[nodiscard]] std::deque<FramePtr> take_all();

  Limits limits_;
  std::atomic<bool> is_storing_{false};
  mutable std::mutex mutex_;
  std::deque<FramePtr> frames_;
  std::size_t bytes_ = 0;
  bool has_dropped_ = false;
  gint64 used_us_ = 0;
  guint tick_;
};

}  // namespace live
