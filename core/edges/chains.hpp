#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <span>
#include <vector>

#include "core/edges/gradient_map.hpp"

namespace ellipse {

/// Links gradient maxima into chains, in order along their edge, with the bright side on the left.
/// Each gradient maximum is in at most one chain.
class ChainTracer {
 public:
  static constexpr std::size_t kMinLength = 14;  ///< Shortest chain kept [pixels].

  /// Reserves capacity for chains. Otherwise capacity grows to the largest count so far.
  void reserve(std::size_t chains);

  /// Marks the gradient maxima of chains with maximum::kChained. Allocates only when the picture
  /// grows or its chains exceed the capacity. Stops once the chains hold a quarter of the pixels,
  /// which leaves out the lower part of the picture.
  void trace(GradientMap& map);

  [[nodiscard]] std::size_t size() const { return begins_.empty() ? 0 : begins_.size() - 1; }
  /// Indices into the maps.
  [[nodiscard]] std::span<const std::int32_t> chain(std::size_t i) const;
  /// All pixels of all chains, chain after chain.
  [[nodiscard]] std::span<const std::int32_t> pixels() const { return {pixels_.data(), count_}; }

 private:
  class Walk;

  void add_chain(std::int32_t seed, std::uint8_t* maxima, const Walk& against, const Walk& along);

  std::vector<std::int32_t> pixels_;
  std::size_t capacity_ = 0;  // for this picture
  std::size_t count_ = 0;
  std::vector<std::size_t> begins_;
};

}  // namespace ellipse
