// SPDX-License-Identifier: MIT
#include "core/detection/arcs/arc_pairs.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace ellipse {
namespace {

// Whether b lies on the inner side of a's tangents, as arcs of one convex curve do.
bool is_inside_of(const Arc& b, const Arc& a) {
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    for (const Eigen::Vector2d& point : b.points) {
      if (!((point - a.points[i]).dot(a.inwards[i]) >= 0.0)) return false;  // also NaN
    }
  }
  return true;
}

double direction_error(std::initializer_list<const Arc*> arcs, const Ellipse& e) {
  const Eigen::Rotation2Dd rotation(-e.angle_rad);
  const Eigen::Vector2d axes(e.semi_major, e.semi_minor);
  double sum = 0.0;
  for (const Arc* arc : arcs) {
    for (std::size_t i = 0; i < arc->points.size(); ++i) {
      const Eigen::Vector2d point = rotation * (arc->points[i] - e.center());
      const Eigen::Vector2d outwards = point.cwiseQuotient(axes.cwiseAbs2()).normalized();
      sum += 1.0 + outwards.dot(rotation * arc->inwards[i]);
    }
  }
  return sum;
}

}  // namespace

Moments moments_of(std::initializer_list<const Arc*> arcs) {
  Moments sum = (*arcs.begin())->moments;
  for (const Arc* other : std::span(arcs).subspan(1)) sum.add(other->moments);
  return sum;
}

std::span<const ArcPair> ArcPairs::find(std::span<const Arc> arcs,
                                        std::span<const std::uint8_t> is_used) {
  pairs_.clear();
  fit(arcs, is_used);
  const auto agrees_better = [](const ArcPair& a, const ArcPair& b) {
    return a.direction_error < b.direction_error;
  };
  std::sort(pairs_.begin(), pairs_.end(), agrees_better);
  return pairs_;
}

// In ascending sum of ranks, so that the best arcs come first.
void ArcPairs::fit(std::span<const Arc> arcs, std::span<const std::uint8_t> is_used) {
  const std::size_t n = std::min(arcs.size(), kMaxPerPass);
  for (std::size_t sum = 1; sum < 2 * n; ++sum) {
    for (std::size_t i = sum >= n ? sum - n + 1 : 0; 2 * i < sum; ++i) {
      const std::size_t k = sum - i;
      const Arc& a = arcs[i];
      const Arc& b = arcs[k];
      if (is_used[i] != 0 || is_used[k] != 0) continue;
      if (!is_inside_of(a, b) || !is_inside_of(b, a)) continue;
      const auto ellipse = fit_ellipse(moments_of({&a, &b}));
      if (ellipse) pairs_.push_back({i, k, direction_error({&a, &b}, *ellipse)});
      if (pairs_.size() == kMaxPerPass) return;
    }
  }
}

}  // namespace ellipse
