// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/frame_store.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace live {

FrameStore::FrameStore(std::function<void()> on_change) : wakeup_(std::move(on_change)) {}

void FrameStore::put(FramePtr frame) {
  FramePtr old;  // released after the lock
  {
    const std::lock_guard lock(mutex_);
    if (is_held_ && steps_ == 0 && newest_) return;
    steps_ = std::max(0, steps_ - 1);
    old = take(std::move(frame));
  }
  wakeup_.raise();
}

bool FrameStore::replace(const FramePtr& before, FramePtr after) {
  FramePtr old;
  {
    const std::lock_guard lock(mutex_);
    if (newest_ != before) return false;
    old = take(std::move(after));
  }
  wakeup_.raise();
  return true;
}

// Requires the lock. @return The previous newest frame.
FramePtr FrameStore::take(FramePtr frame) {
  if (lines_.size() == kMaxLines) lines_.pop_front();
  lines_.push_back(frame->line);
  return std::exchange(newest_, std::move(frame));
}

FramePtr FrameStore::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::vector<std::string> FrameStore::take_lines() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines(std::make_move_iterator(lines_.begin()),
                                 std::make_move_iterator(lines_.end()));
  lines_.clear();
  return lines;
}

void FrameStore::hold() {
  const std::lock_guard lock(mutex_);
  is_held_ = true;
  steps_ = 0;
}

void FrameStore::release() {
  const std::lock_guard lock(mutex_);
  is_held_ = false;
}

void FrameStore::show(FramePtr frame) {
  FramePtr old;
  {
    const std::lock_guard lock(mutex_);
    is_held_ = true;
    steps_ = 0;
    old = take(std::move(frame));
  }
  wakeup_.raise();
}

void FrameStore::clear() {
  FramePtr old;  // released after the lock
  const std::lock_guard lock(mutex_);
  is_held_ = false;
  old = std::move(newest_);
}

void FrameStore::step() {
  const std::lock_guard lock(mutex_);
  if (is_held_) ++steps_;
}

bool FrameStore::is_held() const {
  const std::lock_guard lock(mutex_);
  return is_held_;
}

}  // namespace live
