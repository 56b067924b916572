// SPDX-License-Identifier: MIT
#include "examples/evaluate/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace evaluate {

constexpr std::size_t kWidth = 30;

ProgressBar::ProgressBar(std::size_t total)
    : total_(std::max<std::size_t>(total, 1)), is_shown_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) std::fprintf(stderr, "\r\033[K");
}

void ProgressBar::advance(const std::string& what) {
  ++done_;
  if (!is_shown_) return;
  const std::size_t filled = std::min(kWidth, kWidth * done_ / total_);
  std::fprintf(stderr,
               "\r\033[K[%s%s] %zu/%zu %s",
               std::string(filled, '#').c_str(),
               std::string(kWidth - filled, ' ').c_str(),
               done_,
               total_,
               what.c_str());
}

}  // namespace evaluate
