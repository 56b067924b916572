#pragma once  // SPDX-License-Identifier: MIT

#include <sys/mman.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace support {

/// Memory that records the order in which its pages are read: only the last page read is
/// accessible, and access to another one faults. One at a time.
class PageWatch {
 public:
  static constexpr std::size_t kPage = 4096;

  explicit PageWatch(std::size_t pages) : pages_(pages) {
    data_ = static_cast<std::uint8_t*>(
        mmap(nullptr, pages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  }
  ~PageWatch() {
    if (watching_ == this) stop();
    munmap(data_, pages_ * kPage);
  }
  PageWatch(const PageWatch&) = delete;
  PageWatch& operator=(const PageWatch&) = delete;

  [[nodiscard]] std::uint8_t* data() const { return data_; }

  void start() {
    visit_count_ = 0;
    last_ = pages_;
    watching_ = this;
    struct sigaction action {};
    action.sa_sigaction = &on_fault;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigaction(SIGSEGV, &action, &previous_);
    mprotect(data_, pages_ * kPage, PROT_NONE);
  }

  /// @return The pages in the order of their accesses.
  std::vector<std::size_t> stop() {
    mprotect(data_, pages_ * kPage, PROT_READ | PROT_WRITE);
    sigaction(SIGSEGV, &previous_, nullptr);
    watching_ = nullptr;
    return {visits_.begin(), visits_.begin() + static_cast<std::ptrdiff_t>(visit_count_)};
  }

 private:
  static void on_fault(int /*signal*/, siginfo_t* info, void* /*context*/) {
    const auto at = static_cast<const std::uint8_t*>(info->si_addr) - watching_->data_;
    const bool is_ours = at >= 0 && static_cast<std::size_t>(at) < watching_->pages_ * kPage;
    if (is_ours) {
      watching_->enter(static_cast<std::size_t>(at) / kPage);
    } else {
      std::signal(SIGSEGV, SIG_DFL);
    }
  }

  void enter(std::size_t page) {
    if (last_ < pages_) mprotect(data_ + last_ * kPage, kPage, PROT_NONE);
    mprotect(data_ + page * kPage, kPage, PROT_READ | PROT_WRITE);
    last_ = page;
    if (visit_count_ < visits_.size()) visits_[visit_count_++] = page;
  }

  static inline PageWatch* watching_ = nullptr;
  std::size_t pages_;
  std::uint8_t* data_;
  std::size_t last_ = 0;
  struct sigaction previous_ {};
  std::array<std::size_t, 16384> visits_{};  // a signal handler must not allocate
  std::size_t visit_count_ = 0;
};

}  // namespace support
