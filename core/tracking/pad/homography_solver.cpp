// SPDX-License-Identifier: MIT
#include "core/tracking/pad/homography_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/edges/noise.hpp"
#include "core/geometry/least_squares.hpp"

namespace ellipse {
namespace {

constexpr int kIterations = 2;  // with each reach

}  // namespace

const EdgeCandidate* nearest_candidate(const EdgeSample& sample, double predicted_px) {
  const EdgeCandidate* best = nullptr;
  for (int k = 0; k < sample.count; ++k) {
    const EdgeCandidate& candidate = sample.candidates[static_cast<std::size_t>(k)];
    if (best == nullptr || std::abs(candidate.distance_px - predicted_px) <
                               std::abs(best->distance_px - predicted_px)) {
      best = &candidate;
    }
  }
  return best;
}

std::optional<HomographyEstimate> solve_homography(std::span<const EdgeSample> samples,
                                                   const HomographyPrior& prior,
                                                   double first_reach_px,
                                                   double reach_px,
                                                   double sigma_px) {
  HomographyEstimate estimate;
  for (int step = 0; step < 2 * kIterations; ++step) {
    const double reach = step < kIterations ? first_reach_px : reach_px;
    LeastSquares<8> equations(prior.mean, prior.information);
    for (const EdgeSample& sample : samples) {
      const double predicted = sample.predicted_px(estimate.change);
      const EdgeCandidate* edge = nearest_candidate(sample, predicted);
      if (edge == nullptr) continue;
      const double weight =
          tukey_weight(edge->distance_px - predicted, reach) / (sigma_px * sigma_px);
      if (weight > 0.0) equations.add(sample.view.row, edge->distance_px, weight);
    }
    const auto change = equations.solve();
    if (!change) return std::nullopt;
    estimate = {*change, equations.information()};
  }
  return estimate;
}

bool is_refuted(int matched, int visible) {
  const double sigma = 0.5 * std::sqrt(visible);  // of the matches, if half are expected
  return matched + kUnlikelySigmas * sigma < kMajority * visible;
}

bool is_matched(const EdgeSample& sample, const HomographyChange& change, double max_px) {
  const double predicted = sample.predicted_px(change);
  const EdgeCandidate* edge = nearest_candidate(sample, predicted);
  return edge != nullptr && std::abs(edge->distance_px - predicted) <= max_px;
}

HomographySupport support_of(std::span<const EdgeSample> samples,
                             const HomographyChange& change,
                             double tolerance_px,
                             int circles) {
  HomographySupport support;
  std::array<int, kMaxCircles> visible{};
  std::array<int, kMaxCircles> matched{};
  std::array<float, EdgeSearch::kMaxSamples> gains;
  for (const EdgeSample& sample : samples) {
    if (!sample.is_visible) continue;
    const double predicted = sample.predicted_px(change);
    const EdgeCandidate* edge = nearest_candidate(sample, predicted);
    const bool has_edge =
        edge != nullptr && std::abs(edge->distance_px - predicted) <= tolerance_px;
    if (has_edge)
      gains[static_cast<std::size_t>(support.matched)] = edge->contrast / sample.contrast;
    ++support.visible;
    support.matched += has_edge ? 1 : 0;
    if (sample.feature >= circles) continue;
    const auto circle = static_cast<std::size_t>(sample.feature);
    ++visible[circle];
    matched[circle] += has_edge ? 1 : 0;
  }
  if (support.visible == 0) return support;
  support.coverage = static_cast<double>(support.matched) / support.visible;
  if (visible[0] > 0) support.outline = static_cast<double>(matched[0]) / visible[0];
  support.has_all_circles = true;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    support.has_all_circles &= !is_refuted(matched[i], visible[i]);
  }
  if (support.matched > 0) {
    const auto middle = gains.begin() + support.matched / 2;
    std::nth_element(gains.begin(), middle, gains.begin() + support.matched);
    support.gain = *middle;
  }
  return support;
}

}  // namespace ellipse
