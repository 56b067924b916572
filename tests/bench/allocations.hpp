#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

namespace bench {

/// Counts what is asked of the heap while it lives, by all threads and all libraries: a program
/// that contains allocations.cpp has its malloc, calloc, realloc, free, ... in place of glibc's.
/// One at a time.
///
/// Memory that was there before and is freed meanwhile lowers the bytes in use.
class HeapMeter {
 public:
  HeapMeter();
  ~HeapMeter();
  HeapMeter(const HeapMeter&) = delete;
  HeapMeter& operator=(const HeapMeter&) = delete;

  /// Since the start. A realloc counts as one.
  [[nodiscard]] std::int64_t allocations() const;
  /// The most bytes in use at a time beyond those at the start; as large as the heap made them.
  [[nodiscard]] std::int64_t peak_bytes() const;
};

/// Whether allocations of this program and of its shared libraries reach the meter. A program that
/// prints their number first makes sure of it.
[[nodiscard]] bool counts_allocations();

}  // namespace bench
