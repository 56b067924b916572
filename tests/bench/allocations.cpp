// SPDX-License-Identifier: MIT
#include "tests/bench/allocations.hpp"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <opencv2/core/mat.hpp>

// glibc also exports its functions under these names, which this file does not replace.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}

namespace {

// Constant-initialised: they must be valid before the program's first allocation.
constinit std::atomic<bool> is_counting{false};
constinit std::atomic<std::int64_t> allocations{0};
constinit std::atomic<std::int64_t> bytes_in_use{0};
constinit std::atomic<std::int64_t> peak_bytes{0};

void* counted(void* block) {
  if (block == nullptr || !is_counting.load(std::memory_order_relaxed)) return block;
  allocations.fetch_add(1, std::memory_order_relaxed);
  const auto size = static_cast<std::int64_t>(malloc_usable_size(block));
  const std::int64_t now = bytes_in_use.fetch_add(size, std::memory_order_relaxed) + size;
  std::int64_t peak = peak_bytes.load(std::memory_order_relaxed);
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
  }
  return block;
}

void discount(void* block) {
  if (block == nullptr || !is_counting.load(std::memory_order_relaxed)) return;
  const auto size = static_cast<std::int64_t>(malloc_usable_size(block));
  bytes_in_use.fetch_sub(size, std::memory_order_relaxed);
}

}  // namespace

// Replacements of glibc's functions; operator new of libstdc++ and g_malloc of GLib call them.
extern "C" {

void* malloc(std::size_t size) noexcept {
  return counted(__libc_malloc(size));
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  return counted(__libc_calloc(count, size));
}

void* realloc(void* block, std::size_t size) noexcept {
  discount(block);
  return counted(__libc_realloc(block, size));
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return counted(__libc_memalign(alignment, size));
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return counted(__libc_memalign(alignment, size));
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* made = counted(__libc_memalign(alignment, size));
  if (made == nullptr) return ENOMEM;
  *block = made;
  return 0;
}

void free(void* block) noexcept {
  discount(block);
  __libc_free(block);
}

}  // extern "C"

namespace bench {
namespace {

template <class Allocate>
bool is_counted(const Allocate& allocate) {
  constexpr std::int64_t kBytes = 4096;
  const HeapMeter meter;
  allocate(std::size_t{kBytes});
  return meter.allocations() > 0 && meter.peak_bytes() >= kBytes;
}

}  // namespace

HeapMeter::HeapMeter() {
  ::allocations = 0;
  ::bytes_in_use = 0;
  ::peak_bytes = 0;
  ::is_counting = true;
}

HeapMeter::~HeapMeter() {
  ::is_counting = false;
}

std::int64_t HeapMeter::allocations() const {
  return ::allocations;
}

std::int64_t HeapMeter::peak_bytes() const {
  return ::peak_bytes;
}

bool counts_allocations() {
  // Volatile: the compiler may otherwise remove an unused pair of malloc and free.
  const bool counts_malloc = is_counted([](std::size_t bytes) {
    void* volatile block = std::malloc(bytes);
    std::free(block);
  });
  const bool counts_new = is_counted([](std::size_t bytes) {
    char* volatile block = new char[bytes];
    delete[] block;
  });
  const bool counts_libraries = is_counted(
      [](std::size_t bytes) { const cv::Mat picture(1, static_cast<int>(bytes), CV_8UC1); });
  const bool counts_after_the_end = [] {
    { const HeapMeter meter; }
    const std::int64_t before = ::allocations;
    void* volatile block = std::malloc(1);
    std::free(block);
    return ::allocations != before;
  }();
  return counts_malloc && counts_new && counts_libraries && !counts_after_the_end;
}

}  // namespace bench
