#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <span>
#include <vector>

#include "core/edges/gradient_map.hpp"

namespace ellipse {

/// Neighbouring gradient maxima, one after the other along their edge: bright on the same side all
/// the way.
struct Chain {
  std::span<const std::int32_t> pixels;  ///< Indices into the maps.
  bool is_closed = false;                ///< Its end is where its begin is.
};

/// Links gradient maxima to chains. Each gradient maximum is in one chain at most.
class ChainTracer {
 public:
  static constexpr std::size_t kMinLength = 14;  ///< Of a chain [pixels].

  /// Makes room for as many chains. Without it there is as much as there ever were.
  void reserve(std::size_t chains);

  /// Marks the gradient maxima of chains with maximum::kChained. Allocates only when the picture
  /// grows, or has more chains than there is room for. A picture with more gradient maxima than a
  /// quarter of its pixels keeps the chains of its upper part.
  void trace(GradientMap& map);

  [[nodiscard]] std::size_t size() const { return begins_.empty() ? 0 : begins_.size() - 1; }
  [[nodiscard]] Chain chain(std::size_t i) const;
  /// All pixels of all chains, chain after chain.
  [[nodiscard]] std::span<const std::int32_t> pixels() const { return {pixels_.data(), count_}; }

 private:
  class Walk;

  void add_chain(std::int32_t seed, std::uint8_t* maxima, const Walk& against, const Walk& along);

  int stride_ = 0;
  std::vector<std::int32_t> pixels_;
  std::size_t count_ = 0;
  std::vector<std::size_t> begins_;
  std::vector<std::uint8_t> is_closed_;
};

}  // namespace ellipse
