// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/analyst.hpp"

#include <exception>
#include <utility>

namespace live {
namespace {

constexpr std::size_t kMaxWaitingRequests = 8;

}  // namespace

Analyst::Analyst() : wakeup_([this] { deliver(); }), thread_([this] { run(); }) {}

Analyst::~Analyst() {
  {
    const std::lock_guard lock(mutex_);
    ending_.request_stop();
  }
  changed_.notify_one();
  thread_.join();
}

bool Analyst::ask(Work work, Answer answer) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMaxWaitingRequests) return false;
    waiting_.push_back({std::move(work), std::move(answer)});
  }
  changed_.notify_one();
  return true;
}

void Analyst::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_.stop_requested() || !waiting_.empty(); });
    if (ending_.stop_requested()) return;
    Task task = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    try {
      task.json = task.work(ending_.get_token());
    } catch (const std::exception& error) {
      task.error = error.what();
    }
    task.work = nullptr;  // releases its frames
    lock.lock();
    done_.push_back(std::move(task));
    wakeup_.raise();
  }
}

void Analyst::deliver() {
  std::deque<Task> done;
  {
    const std::lock_guard lock(mutex_);
    done.swap(done_);
  }
  for (const Task& task : done) task.answer(task.json, task.error);
}

}  // namespace live
