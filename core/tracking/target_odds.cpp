// SPDX-License-Identifier: MIT
#include "core/tracking/target_odds.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Measured or chosen in docs/provenance.md, "Evidence over time".
constexpr double kPrior = -0.4;  // log odds of a new target

double bounded(double log_odds) {
  return std::clamp(log_odds, -TargetOdds::kMax, TargetOdds::kMax);
}

}  // namespace

void TargetOdds::start(double log_odds, bool is_known) {
  last_ = bounded(log_odds);
  sum_ = -kMax;
  raise(log_odds, is_known);
}

void TargetOdds::raise(double log_odds, bool is_known) {
  sum_ = std::max(sum_, bounded(bounded(log_odds) + (is_known ? 0.0 : kPrior)));
}

void TargetOdds::add(double log_odds, double elapsed_s) {
  const double correlation = std::exp(-elapsed_s / kCorrelation_s);
  const double now = bounded(log_odds);
  const double news = (now - correlation * last_) / (1.0 + correlation);
  sum_ = bounded(sum_ + news);
  last_ = now;
}

}  // namespace ellipse
