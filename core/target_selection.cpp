// SPDX-License-Identifier: MIT
#include "core/target_selection.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// A circle's centre and its ring's centres part under perspective, and small fits are uncertain.
constexpr double kConcentricRelative = 0.1;
constexpr double kConcentricPx = 2.0;
constexpr double kFlatnessTolerance = 0.15;

// Two fits to one edge, from its two sides, differ by less than this.
constexpr double kSameEdgeRelative = 0.01;
constexpr double kSameEdgePx = 1.5;

// From frame to frame.
constexpr double kLargestGrowth = 2.0;

constexpr double kLeastShareOfBestScore = 0.25;

bool are_concentric(const Ellipse& a, const Ellipse& b) {
  const double largest = std::max(a.semi_major, b.semi_major);
  const double apart = (a.center() - b.center()).norm();
  const double flatness = std::abs(a.semi_minor / a.semi_major - b.semi_minor / b.semi_major);
  return apart <= kConcentricRelative * largest + kConcentricPx && flatness <= kFlatnessTolerance;
}

bool are_one_edge(const Ellipse& a, const Ellipse& b) {
  const double tolerance = kSameEdgePx + kSameEdgeRelative * a.semi_major;
  return std::abs(a.semi_major - b.semi_major) <= tolerance &&
         std::abs(a.semi_minor - b.semi_minor) <= tolerance;
}

bool can_be_same_target(const Ellipse& candidate, const Ellipse& last) {
  return (candidate.center() - last.center()).norm() <= last.semi_major &&
         candidate.semi_major >= last.semi_major / kLargestGrowth &&
         candidate.semi_major <= last.semi_major * kLargestGrowth;
}

// Better than another member of the same set, both with enough of the set's best score.
bool is_better(const Detection& a, const Detection& b) {
  return are_one_edge(a.ellipse, b.ellipse) ? a.score > b.score
                                            : a.ellipse.semi_major > b.ellipse.semi_major;
}

}  // namespace

ConcentricSet set_around(const Ellipse& ellipse, std::span<const Detection> detections) {
  ConcentricSet set;
  for (const Detection& other : detections) {
    if (!are_concentric(ellipse, other.ellipse)) continue;
    set.has_two_edges = set.has_two_edges || !are_one_edge(ellipse, other.ellipse);
    set.score += other.score;
    set.best_score = std::max(set.best_score, other.score);
  }
  return set;
}

std::optional<Detection> select_target(std::span<const Detection> detections,
                                       const std::optional<Ellipse>& last_target) {
  const auto is_possible = [&](const Detection& detection) {
    return !last_target || can_be_same_target(detection.ellipse, *last_target);
  };
  const Detection* seed = nullptr;
  ConcentricSet best;
  for (const Detection& detection : detections) {
    if (!is_possible(detection)) continue;
    const ConcentricSet set = set_around(detection.ellipse, detections);
    if (seed == nullptr || best < set) {
      seed = &detection;
      best = set;
    }
  }
  if (seed == nullptr) return std::nullopt;

  const Detection* target = nullptr;
  for (const Detection& member : detections) {
    const bool counts = is_possible(member) && are_concentric(seed->ellipse, member.ellipse) &&
                        member.score >= kLeastShareOfBestScore * best.best_score;
    if (counts && (target == nullptr || is_better(member, *target))) target = &member;
  }
  return target != nullptr ? *target : *seed;
}

}  // namespace ellipse
