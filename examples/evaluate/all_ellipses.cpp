// SPDX-License-Identifier: MIT
#include "examples/evaluate/all_ellipses.hpp"

#include <algorithm>
#include <cmath>

#include "examples/evaluate/matching.hpp"

namespace evaluate {
namespace {

// Ellipses whose centres are farther apart than the larger semi-axis have an IoU below kMinIou.
bool can_match(const ellipse::Ellipse& a, const ellipse::Ellipse& b) {
  return (a.center() - b.center()).norm() < std::max(a.semi_major, b.semi_major);
}

std::vector<Edge> edges_between(std::span<const ellipse::Ellipse> found,
                                const std::vector<TrueEllipse>& truths,
                                const FrameSize& frame) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t k = 0; k < truths.size(); ++k) {
      if (!can_match(found[i], truths[k].ellipse)) continue;
      const double iou = iou_of(found[i], truths[k].ellipse, frame);
      if (iou >= kMinIou) edges.push_back({i, k, iou});
    }
  }
  return edges;
}

void add_match(AllResult& result, const ellipse::Ellipse& found, const ellipse::Ellipse& truth) {
  ++result.counts.right;
  result.centre_errors_px.push_back((found.center() - truth.center()).norm());
  result.axis_errors_px.push_back(std::max(std::abs(found.semi_major - truth.semi_major),
                                           std::abs(found.semi_minor - truth.semi_minor)));
}

}  // namespace

AllResult compare_all(std::span<const ellipse::Ellipse> found,
                      const Truth& truth,
                      const FrameSize& frame) {
  AllResult result;
  if (!truth.is_labelled) return result;
  result.counts.judged = 1;
  const std::vector<TrueEllipse> truths = ellipses_of(truth);
  const auto matches =
      match_one_to_one(found.size(), truths.size(), edges_between(found, truths, frame));
  std::vector<bool> is_matched(truths.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (matches[i]) is_matched[*matches[i]] = true;
    if (!matches[i]) {
      ++result.counts.mistaken;
    } else if (visible_part(truths[*matches[i]], frame) >= kMinVisible) {
      add_match(result, found[i], truths[*matches[i]].ellipse);
    }
  }
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const bool counts = visible_part(truths[k], frame) >= kMinVisible;
    if (counts && !is_matched[k]) ++result.counts.missed;
  }
  return result;
}

}  // namespace evaluate
