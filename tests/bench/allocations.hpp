#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

namespace bench {

/// Counts heap allocations of all threads and libraries while it exists. A program that links
/// allocations.cpp uses its malloc, calloc, realloc, free, ... in place of glibc's. One meter at a
/// time.
///
/// Freeing a block that was allocated before the meter started lowers the bytes in use.
class HeapMeter {
 public:
  HeapMeter();
  ~HeapMeter();
  HeapMeter(const HeapMeter&) = delete;
  HeapMeter& operator=(const HeapMeter&) = delete;

  /// Allocations since the start. A realloc counts as one.
  [[nodiscard]] std::int64_t allocations() const;
  /// Maximum of the bytes in use above those at the start, by the usable size of each block.
  [[nodiscard]] std::int64_t peak_bytes() const;
};

/// Whether the meter sees the allocations of this program and of its shared libraries. A program
/// checks this before it prints their number.
[[nodiscard]] bool counts_allocations();

}  // namespace bench
