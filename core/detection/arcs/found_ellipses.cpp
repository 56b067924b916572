// SPDX-License-Identifier: MIT
#include "core/detection/arcs/found_ellipses.hpp"

#include <algorithm>

#include "core/detection/detection_trace.hpp"
#include "core/detection/evidence.hpp"

namespace ellipse {
namespace {

constexpr double kSame = 0.05;  // tolerance for duplicates, share of the semi-major axis

bool are_duplicates(const FoundEllipse& a, const FoundEllipse& b) {
  return may_agree(a.measured.polarity, b.measured.polarity) &&
         are_one_ellipse(a.measured.ellipse, b.measured.ellipse, std::max(a.scale, b.scale));
}

}  // namespace

bool may_agree(Polarity a, Polarity b) {
  return a == b || a == Polarity::kMixed || b == Polarity::kMixed;
}

bool are_one_ellipse(const Ellipse& a, const Ellipse& b, double tolerance_px) {
  return is_same(a, b, {tolerance_px, kSame});
}

void FoundEllipses::begin(DetectionTrace* trace) {
  all_.clear();
  trace_ = trace;
}

void FoundEllipses::add(const FoundEllipse& found) {
  for (FoundEllipse& known : all_) {
    const bool is_comparable = known.scale == found.scale ||
                               is_certain(found.measured.probability) ||
                               is_certain(known.measured.probability);
    if (!is_comparable || !are_duplicates(known, found)) continue;
    merge(found, known);
    return;
  }
  all_.push_back(found);
}

bool FoundEllipses::has_certain(const Ellipse& guess, Polarity polarity, int scale) const {
  return std::any_of(all_.begin(), all_.end(), [&](const FoundEllipse& known) {
    const MeasuredEllipse& one = known.measured;
    return known.scale == scale && is_certain(one.probability) &&
           may_agree(one.polarity, polarity) && are_one_ellipse(one.ellipse, guess, scale);
  });
}

void FoundEllipses::merge_duplicates() {
  auto end = all_.begin();
  for (const FoundEllipse& found : all_) {
    const auto known = std::find_if(
        all_.begin(), end, [&](const FoundEllipse& other) { return are_duplicates(other, found); });
    if (known == end) {
      *end++ = found;
    } else {
      merge(found, *known);
    }
  }
  all_.erase(end, all_.end());
}

void FoundEllipses::merge(const FoundEllipse& found, FoundEllipse& known) {
  const bool is_better = found.measured.probability > known.measured.probability;
  reject(is_better ? known : found, {Reason::kKnown});
  if (is_better) known = found;
}

void FoundEllipses::reject(const FoundEllipse& found, const Verdict& verdict) {
  if (trace_ != nullptr) trace_->revise(found.measured.candidate, verdict);
}

}  // namespace ellipse
