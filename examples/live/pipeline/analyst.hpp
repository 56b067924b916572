#pragma once  // SPDX-License-Identifier: MIT

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "examples/live/pipeline/analysis.hpp"
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

  /// Main loop only. @return false if too many requests are waiting.
  [[nodiscard]] bool ask(AnalysisRequest request, Answer answer);

 private:
  struct Task {
    AnalysisRequest request;
    Answer answer;
    std::string json = {};
    std::string error = {};
  };

  void work();
  void deliver();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::deque<Task> done_;
  bool is_ending_ = false;
  Wakeup wakeup_;
  std::thread thread_;
};

}  // namespace live
