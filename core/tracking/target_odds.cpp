// SPDX-License-Identifier: MIT
#include "core/tracking/target_odds.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Measured or chosen in docs/provenance.md, "Evidence over time".
constexpr double kMemory_s = 0.3;    // correlation time of the evidence
constexpr double kPrior = -0.4;      // log odds of a new target
constexpr double kMaxOfFrame = 5.0;  // log odds: single frames are not calibrated beyond

double of_frame(double log_odds) {
  return std::clamp(log_odds, -kMaxOfFrame, kMaxOfFrame);
}

}  // namespace

void TargetOdds::start(double log_odds, bool is_known) {
  last_ = of_frame(log_odds);
  sum_ = std::clamp(last_ + (is_known ? 0.0 : kPrior), -kMax, kMax);
}

void TargetOdds::add(double log_odds, double elapsed_s) {
  const double correlation = std::exp(-elapsed_s / kMemory_s);
  const double now = of_frame(log_odds);
  const double news = (now - correlation * last_) / (1.0 + correlation);
  sum_ = std::clamp(sum_ + news, -kMax, kMax);
  last_ = now;
}

}  // namespace ellipse
