// SPDX-License-Identifier: MIT
#include "core/tracking/target_memory.hpp"

#include "core/detection/evidence.hpp"

namespace ellipse {
namespace {

constexpr double kNewPrior = -0.4;  // prior log odds of a new target

// Of a target's ellipses before and after it was lost for up to kMemory_s.
constexpr Tolerance kShortLoss{0.0, 0.5};

}  // namespace

void TargetMemory::advance(double elapsed_s) {
  absence_s_ += elapsed_s;
  since_certain_s_ += elapsed_s;
}

void TargetMemory::remember(const Target& target) {
  ellipse_ = target.ellipse;
  id_ = target.id;
  absence_s_ = 0.0;
  if (is_certain(target.probability)) since_certain_s_ = 0.0;
}

bool TargetMemory::was_near(const Ellipse& e) const {
  return absence_s_ < kMemory_s && is_near(ellipse_, e);
}

bool TargetMemory::was_certain_as(const Ellipse& e) const {
  return was_certain() && is_same(e, ellipse_, kShortLoss);
}

double TargetMemory::prior_of(const Ellipse& e) const {
  if (was_certain_as(e)) return kLostPrior;
  return was_near(e) ? 0.0 : kNewPrior;
}

bool is_near(const Ellipse& e, const Ellipse& other) {
  return (e.center() - other.center()).norm() < other.semi_major;
}

}  // namespace ellipse
