#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

namespace ellipse {

/// A platform-independent hash: SplitMix64 [Steele2014].
[[nodiscard]] constexpr std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Platform-independent random numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(hash(seed)) {}

  /// In [0, 1).
  [[nodiscard]] double unit() {
    return static_cast<double>(hash(state_++) >> 11U) / static_cast<double>(1ULL << 53U);
  }
  /// In [low, high).
  [[nodiscard]] double between(double low, double high) { return low + (high - low) * unit(); }
  /// 0 to count - 1.
  [[nodiscard]] int below(int count) { return static_cast<int>(unit() * count); }

 private:
  std::uint64_t state_;
};

}  // namespace ellipse
