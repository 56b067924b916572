#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <optional>
#include <vector>

namespace evaluate {

/// A possible pair.
struct Edge {
  std::size_t left = 0;
  std::size_t right = 0;
  double weight = 0.0;  ///< 0 to 1.
};

/// Matches left to right one to one: the largest number of pairs, and among those matchings one
/// with the largest sum of weights. Successive longest augmenting paths; O(pairs x edges x left).
///
/// @return The right index of each left vertex; nullopt if unmatched.
[[nodiscard]] std::vector<std::optional<std::size_t>> match_one_to_one(
    std::size_t lefts, std::size_t rights, const std::vector<Edge>& edges);

}  // namespace evaluate
