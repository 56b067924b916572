// SPDX-License-Identifier: MIT
#include "core/tracking/target_odds.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

double bounded(double log_odds) {
  return std::clamp(log_odds, -TargetOdds::kMax, TargetOdds::kMax);
}

}  // namespace

void TargetOdds::start(double log_odds, double prior) {
  last_ = bounded(log_odds);
  sum_ = -kMax;
  raise(log_odds, prior);
}

void TargetOdds::raise(double log_odds, double prior) {
  sum_ = std::max(sum_, bounded(bounded(log_odds) + prior));
}

void TargetOdds::add(double log_odds, double elapsed_s) {
  const double correlation = std::exp(-elapsed_s / kCorrelation_s);
  const double now = bounded(log_odds);
  const double innovation = (now - correlation * last_) / (1.0 + correlation);
  sum_ = bounded(sum_ + innovation);
  last_ = now;
}

}  // namespace ellipse
