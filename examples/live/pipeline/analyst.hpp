#pragma once  // SPDX-License-Identifier: MIT

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Runs analyses one after the other in its own thread, so that they block neither the pipeline nor
/// the viewers.
class Analyst {
 public:
  /// Called in the main loop. On success `error` is empty.
  using Answer = std::function<void(const std::string& json, const std::string& error)>;

  Analyst();
  ~Analyst();
  Analyst(const Analyst&) = delete;
  Analyst& operator=(const Analyst&) = delete;

  /// Returns JSON or throws. Called in the analyst's thread. Long work returns early on a stop
  /// request.
  using Work = std::function<std::string(const std::stop_token& stop)>;

  /// Main loop only. @return false if too many requests are waiting.
  [[nodiscard]] bool ask(Work work, Answer answer);

 private:
  struct Task {
    Work work;
    Answer answer;
    std::string json = {};
    std::string error = {};
  };

  void run();
  void deliver();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::deque<Task> done_;
  std::stop_source ending_;
  Wakeup wakeup_;
  std::thread thread_;
};

}  // namespace live
