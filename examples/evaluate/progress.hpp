#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <string>

namespace evaluate {

/// Progress bar, shown if standard error is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Advances by one item. @param what  Its name.
  void advance(const std::string& what);

 private:
  std::size_t total_;
  std::size_t done_ = 0;
  bool is_shown_;
};

}  // namespace evaluate
