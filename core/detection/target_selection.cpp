// SPDX-License-Identifier: MIT
#include "core/detection/target_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/detection/detection_trace.hpp"

namespace ellipse {
namespace {

// Largest difference of two fits to the two sides of one edge.
constexpr Tolerance kOneEdge{1.5, 0.01};

// Largest ratio of the major axes in two successive frames.
constexpr double kMaxGrowth = 2.0;

constexpr double kMinShareOfBestScore = 0.25;

// Minimum advantage of a new target: ratio of the scores.
constexpr double kMuchBetter = 1.5;

// A factor below 1 reduces a score, one above increases it, although log odds may be negative.
double scaled(double score, double factor) {
  return score + (factor - 1.0) * std::abs(score);
}

// Evidence of all detections that are concentric with one ellipse.
struct ConcentricSet {
  double probability = 0.0;  // the largest; all are 1 without probabilities
  bool has_two_edges = false;
  double score = 0.0;
  double best_score = -std::numeric_limits<double>::infinity();

  bool operator<(const ConcentricSet& other) const {
    return std::tie(probability, has_two_edges, score) <
           std::tie(other.probability, other.has_two_edges, other.score);
  }
};

// Whether the circle inside the outer ellipse contains the circle around the inner one: then the
// outer ellipse contains the inner one.
bool encloses(const Ellipse& outer, const Ellipse& inner) {
  return (inner.center() - outer.center()).norm() + inner.semi_major < outer.semi_minor;
}

// The ellipse itself need not be one of the detections.
ConcentricSet set_around(const Ellipse& ellipse, std::span<const Detection> detections) {
  ConcentricSet set;
  for (const Detection& other : detections) {
    if (!other.as_target.is_accepted() || !are_concentric(ellipse, other.ellipse)) continue;
    set.has_two_edges = set.has_two_edges || !is_same(other.ellipse, ellipse, kOneEdge);
    set.probability = std::max(set.probability, other.probability);
    set.score += other.score;
    set.best_score = std::max(set.best_score, other.score);
  }
  return set;
}

Verdict judge_as_same_target(const Ellipse& candidate, const Ellipse& last) {
  const double apart = (candidate.center() - last.center()).norm();
  const Verdict distance = at_most(Reason::kTooFarFromLast, apart, last.semi_major);
  if (!distance.is_accepted()) return distance;
  const double axis = 2.0 * candidate.semi_major;
  const double last_axis = 2.0 * last.semi_major;
  const Verdict shrunk = at_least(Reason::kOtherSize, axis, last_axis / kMaxGrowth);
  if (!shrunk.is_accepted()) return shrunk;
  return at_most(Reason::kOtherSize, axis, last_axis * kMaxGrowth);
}

// Compares two members of one set. The better score wins on the same edge, the larger ellipse
// otherwise.
Verdict judge_beside(const Detection& member, const Detection& other) {
  const bool is_edge = is_same(other.ellipse, member.ellipse, kOneEdge);
  const double own = is_edge ? member.score : 2.0 * member.ellipse.semi_major;
  const double others = is_edge ? other.score : 2.0 * other.ellipse.semi_major;
  if (own > others) return {};
  return {is_edge ? Reason::kSameEdge : Reason::kInnerEdge, own, others};
}

// Why a set that is not the best is rejected.
Verdict judge_set(const ConcentricSet& set, const ConcentricSet& best) {
  if (set.probability < best.probability) {
    return {Reason::kWeakerSet, log_odds(set.probability), log_odds(best.probability)};
  }
  if (set.has_two_edges != best.has_two_edges) return {Reason::kSingle};
  return {Reason::kWeakerSet, set.score, best.score};
}

// Independent of the other detections.
Verdict judge_alone(const Detection& detection, const std::optional<Ellipse>& last_target) {
  if (!detection.as_target.is_accepted() || !last_target) return detection.as_target;
  return judge_as_same_target(detection.ellipse, *last_target);
}

void reject(const Detection& detection, const Verdict& verdict, DetectionTrace* trace) {
  if (trace != nullptr) trace->revise(detection.candidate, verdict);
}

// The first member of the best set; nullptr if no detection can be the target.
const Detection* seed_of_best_set(std::span<const Detection> detections,
                                  const std::optional<Ellipse>& last_target,
                                  DetectionTrace* trace) {
  const Detection* seed = nullptr;
  ConcentricSet best;
  for (const Detection& detection : detections) {
    const Verdict alone = judge_alone(detection, last_target);
    if (!alone.is_accepted()) {
      reject(detection, alone, trace);
      continue;
    }
    const ConcentricSet set = set_around(detection.ellipse, detections);
    if (seed == nullptr || best < set) {
      seed = &detection;
      best = set;
    }
  }
  return seed;
}

}  // namespace

std::optional<Detection> select_target(std::span<const Detection> detections,
                                       const std::optional<Ellipse>& last_target,
                                       DetectionTrace* trace) {
  const Detection* seed = seed_of_best_set(detections, last_target, trace);
  if (seed == nullptr) return std::nullopt;
  const ConcentricSet best = set_around(seed->ellipse, detections);
  const Detection* target = nullptr;
  for (const Detection& member : detections) {
    if (!judge_alone(member, last_target).is_accepted()) continue;
    if (!are_concentric(seed->ellipse, member.ellipse)) {
      reject(member, judge_set(set_around(member.ellipse, detections), best), trace);
      continue;
    }
    const double min_score = scaled(best.best_score, kMinShareOfBestScore);
    Verdict verdict = at_least(Reason::kWeakInSet, member.score, min_score);
    if (verdict.is_accepted() && target != nullptr) verdict = judge_beside(member, *target);
    if (verdict.is_accepted()) {
      if (target != nullptr) reject(*target, judge_beside(*target, member), trace);
      target = &member;
    } else {
      reject(member, verdict, trace);
    }
  }
  if (target == nullptr) target = seed;
  if (trace != nullptr) trace->choose(target->candidate);
  return *target;
}

bool is_better_target(const Ellipse& chosen,
                      const KnownTarget& followed,
                      std::span<const Detection> detections) {
  const auto& [known, has_two_edges, score] = followed;
  // A concentric edge farther out: an inner edge of the same target was tracked.
  if (are_concentric(chosen, known) && chosen.semi_major > known.semi_major &&
      !is_same(chosen, known, kSameTarget)) {
    return true;
  }
  const ConcentricSet other = set_around(chosen, detections);
  ConcentricSet own = set_around(known, detections);
  own.has_two_edges = own.has_two_edges || has_two_edges;
  if (score) {
    own.score = std::max(own.score, *score);
    own.probability = std::max(own.probability, probability_of(*score));
  }
  if (own.has_two_edges != other.has_two_edges) return other.has_two_edges && own < other;
  if (encloses(chosen, known)) return own < other;
  return own < other && other.score > scaled(own.score, kMuchBetter);
}

}  // namespace ellipse
