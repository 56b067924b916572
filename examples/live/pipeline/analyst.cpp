// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/analyst.hpp"

#include <exception>
#include <utility>

namespace live {
namespace {

constexpr std::size_t kMaxWaiting = 8;

}  // namespace

Analyst::Analyst() : wakeup_([this] { deliver(); }), thread_([this] { work(); }) {}

Analyst::~Analyst() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool Analyst::ask(AnalysisRequest request, Answer answer) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMaxWaiting) return false;
    waiting_.push_back({std::move(request), std::move(answer)});
  }
  changed_.notify_one();
  return true;
}

void Analyst::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
    if (is_ending_) return;
    Task task = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    try {
      task.json = analysis_json(task.request);
    } catch (const std::exception& error) {
      task.error = error.what();
    }
    task.request.frame.reset();
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
