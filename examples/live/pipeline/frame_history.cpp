// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/frame_history.hpp"

#include <algorithm>
#include <utility>

namespace live {
namespace {

constexpr guint kCleanupSeconds = 60;
constexpr gint64 kUnusedUs = 600 * G_USEC_PER_SEC;

std::size_t bytes_of(const Frame& frame) {
  return gst_buffer_get_size(frame.input.get());
}

}  // namespace

FrameHistory::FrameHistory(const Limits& limits)
    : limits_(limits), tick_(g_timeout_add_seconds(kCleanupSeconds, on_tick, this)) {}

FrameHistory::~FrameHistory() {
  g_source_remove(tick_);
}

void FrameHistory::put(const Frame& frame) {
  if (!is_storing_) return;
  FramePtr copy = detached_copy(frame);
  std::vector<FramePtr> dropped;  // released after the lock
  const std::lock_guard lock(mutex_);
  if (!is_storing_) return;
  bytes_ += bytes_of(*copy);
  frames_.push_back(std::move(copy));
  while (frames_.size() > limits_.frames || (bytes_ > limits_.bytes && frames_.size() > 1)) {
    bytes_ -= bytes_of(*frames_.front());
    dropped.push_back(std::move(frames_.front()));
    frames_.pop_front();
    has_dropped_ = true;
  }
}

std::deque<FramePtr> FrameHistory::take_all() {
  const std::lock_guard lock(mutex_);
  bytes_ = 0;
  has_dropped_ = false;
  return std::exchange(frames_, {});
}

void FrameHistory::begin() {
  touch();
  if (is_storing_) return;
  (void)take_all();
  is_storing_ = true;
}

void FrameHistory::clear() {
  is_storing_ = false;
  (void)take_all();
}

bool FrameHistory::is_full() const {
  const std::lock_guard lock(mutex_);
  return has_dropped_;
}

std::vector<FramePtr> FrameHistory::frames() const {
  const std::lock_guard lock(mutex_);
  return {frames_.begin(), frames_.end()};
}

FramePtr FrameHistory::find(guint64 index) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(
      frames_.begin(), frames_.end(), [index](const auto& each) { return each->index == index; });
  return found != frames_.end() ? *found : nullptr;
}

gboolean FrameHistory::on_tick(gpointer data) {
  auto* self = static_cast<FrameHistory*>(data);
  if (g_get_monotonic_time() - self->used_us_ > kUnusedUs) self->clear();
  return G_SOURCE_CONTINUE;
}

}  // namespace live
