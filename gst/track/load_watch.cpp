// SPDX-License-Identifier: MIT
#include "gst/track/load_watch.hpp"

#include <algorithm>

namespace {

constexpr int kCoarsestStep = 3;
constexpr int kLastStep = 5;
// One frame over the limit counts as much as eight frames under half of it, because the periodic
// search makes about every sixth frame slow while a target is followed at 30 frames per second.
constexpr int kOver = 8;
constexpr int kTooMuch = 3 * kOver;
constexpr int kEnoughRest = -128;

}  // namespace

bool LoadWatch::add(GstClockTime processing_time, GstClockTime limit) {
  const int before = step_;
  if (limit == 0) {
    *this = LoadWatch();
    return before != 0;
  }
  if (processing_time > limit) score_ = std::max(score_, 0) + kOver;
  if (processing_time < limit / 2) --score_;
  if (score_ >= kTooMuch) step_ = std::min(step_ + 1, kLastStep);
  if (score_ <= kEnoughRest) step_ = std::max(step_ - 1, 0);
  if (score_ >= kTooMuch || score_ <= kEnoughRest) score_ = 0;
  return step_ != before;
}

bool LoadWatch::skips_next() {
  skipped_ = skipped_ < skipped_in_a_row() ? skipped_ + 1 : 0;
  return skipped_ > 0;
}

int LoadWatch::scale() const {
  return 1 << std::min(step_, kCoarsestStep);
}

int LoadWatch::skipped_in_a_row() const {
  return (1 << std::max(step_ - kCoarsestStep, 0)) - 1;
}
