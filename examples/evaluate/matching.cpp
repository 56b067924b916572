// SPDX-License-Identifier: MIT
#include "examples/evaluate/matching.hpp"

#include <limits>

namespace evaluate {
namespace {

constexpr double kUnreached = -std::numeric_limits<double>::infinity();
constexpr double kEpsilon = 1e-12;

// A matching that grows by one pair at a time, along the augmenting path with the largest gain.
class Matching {
 public:
  Matching(std::size_t lefts, std::size_t rights, const std::vector<Edge>& edges)
      : edges_(edges), edge_of_left_(lefts), edge_of_right_(rights) {}

  /// Returns false if no further pair can be matched.
  bool grow() {
    reach();
    const auto right = best_free_right();
    if (right) augment(*right);
    return right.has_value();
  }

  [[nodiscard]] std::vector<std::optional<std::size_t>> rights() const {
    std::vector<std::optional<std::size_t>> result;
    for (const auto& edge : edge_of_left_) {
      result.push_back(edge ? std::optional(edges_[*edge].right) : std::nullopt);
    }
    return result;
  }

 private:
  // The largest gain of an alternating path from a free left vertex to each right vertex. Added
  // edges count positively, removed ones negatively. No cycle has a positive gain, because each
  // matching so far is the heaviest of its size.
  void reach() {
    gain_.assign(edge_of_right_.size(), kUnreached);
    last_edge_.assign(edge_of_right_.size(), 0);
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (std::size_t i = 0; i < edges_.size(); ++i) is_changed = relax(i) || is_changed;
    }
  }

  bool relax(std::size_t i) {
    const Edge& edge = edges_[i];
    const auto& taken = edge_of_left_[edge.left];
    if (taken && (*taken == i || gain_[edges_[*taken].right] == kUnreached)) return false;
    const double before = taken ? gain_[edges_[*taken].right] - edges_[*taken].weight : 0.0;
    if (before + edge.weight <= gain_[edge.right] + kEpsilon) return false;
    gain_[edge.right] = before + edge.weight;
    last_edge_[edge.right] = i;
    return true;
  }

  [[nodiscard]] std::optional<std::size_t> best_free_right() const {
    std::optional<std::size_t> best;
    for (std::size_t right = 0; right < gain_.size(); ++right) {
      if (edge_of_right_[right] || gain_[right] == kUnreached) continue;
      if (!best || gain_[right] > gain_[*best]) best = right;
    }
    return best;
  }

  void augment(std::size_t right) {
    for (std::optional<std::size_t> next = right; next;) {
      const std::size_t edge = last_edge_[*next];
      const auto given_up = edge_of_left_[edges_[edge].left];
      edge_of_right_[*next] = edge;
      edge_of_left_[edges_[edge].left] = edge;
      next = given_up ? std::optional(edges_[*given_up].right) : std::nullopt;
    }
  }

  const std::vector<Edge>& edges_;
  std::vector<std::optional<std::size_t>> edge_of_left_;
  std::vector<std::optional<std::size_t>> edge_of_right_;
  std::vector<double> gain_;
  std::vector<std::size_t> last_edge_;
};

}  // namespace

std::vector<std::optional<std::size_t>> match_one_to_one(std::size_t lefts,
                                                         std::size_t rights,
                                                         const std::vector<Edge>& edges) {
  Matching matching(lefts, rights, edges);
  while (matching.grow()) continue;
  return matching.rights();
}

}  // namespace evaluate
