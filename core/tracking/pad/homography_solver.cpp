// SPDX-License-Identifier: MIT
#include "core/tracking/pad/homography_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/edges/noise.hpp"
#include "core/geometry/least_squares.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

constexpr int kIterations = 2;  // with each reach

struct Matches {
  int visible = 0;
  int matched = 0;
};

bool refuted(const Matches& feature) {
  return is_refuted(feature.matched, feature.visible);
}

// Whether it is matched significantly more often than not.
bool is_supported(const Matches& feature) {
  return is_refuted(feature.visible - feature.matched, feature.visible);
}

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
                                                   const MatchLimits& limits) {
  const double max_precision = std::pow(limits.min_sigma_px, -2);
  HomographyEstimate estimate;
  for (int step = 0; step < 2 * kIterations; ++step) {
    const double reach_px = step < kIterations ? limits.first_reach_px : limits.reach_px;
    // Before the change has converged, the residuals contain its error.
    const bool is_scaled = limits.uses_scatter && step == 2 * kIterations - 1;
    LeastSquares<8> matches;
    ResidualSums residuals;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double predicted_px = samples[i].predicted_px(estimate.change);
      const EdgeCandidate* edge = nearest_candidate(samples[i], predicted_px);
      if (edge == nullptr) continue;
      const double residual_px = edge->distance_px - predicted_px;
      const double weight = tukey_weight(residual_px, reach_px);
      if (weight > 0.0) matches.add(samples[i].view.row, edge->distance_px, weight);
      if (is_scaled) residuals.add(static_cast<int>(i), residual_px, reach_px, 1.0);
    }
    const double precision =
        is_scaled ? residuals.independent_precision(limits.min_sigma_px) : max_precision;
    LeastSquares<8> equations(prior.mean, prior.information);
    equations.add(matches, precision);
    const auto change = equations.solve();
    if (!change) return std::nullopt;
    estimate = {*change, equations.information(), precision};
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
  std::array<Matches, kMaxCircles + 1> features{};  // of each circle, then of all lines
  std::array<float, EdgeSearch::kMaxSamples> gains;
  std::array<float, EdgeSearch::kMaxSamples> relative_gains;
  for (const EdgeSample& sample : samples) {
    if (!sample.is_visible) continue;
    const double predicted = sample.predicted_px(change);
    const EdgeCandidate* edge = nearest_candidate(sample, predicted);
    const bool has_edge =
        edge != nullptr && std::abs(edge->distance_px - predicted) <= tolerance_px;
    if (has_edge) {
      const auto i = static_cast<std::size_t>(support.matched);
      gains[i] = edge->contrast / sample.contrast;
      relative_gains[i] = gains[i] / edge->light;
    }
    ++support.visible;
    support.matched += has_edge ? 1 : 0;
    Matches& feature = features[static_cast<std::size_t>(std::min(sample.feature, circles))];
    ++feature.visible;
    feature.matched += has_edge ? 1 : 0;
  }
  if (support.visible == 0) return support;
  const auto share = [](int part, int whole) { return part / static_cast<double>(whole); };
  support.coverage = share(support.matched, support.visible);
  const auto& [outer_visible, outer_matched] = features[0];
  if (outer_visible > 0) support.outer_coverage = share(outer_matched, outer_visible);
  const auto inside = std::span(features).subspan(1);
  const bool is_one_refuted = std::any_of(inside.begin(), inside.begin() + circles - 1, refuted);
  const bool is_one_supported = std::any_of(inside.begin(), inside.end(), is_supported);
  support.has_circles = !refuted(features[0]) && (!is_one_refuted || is_one_supported);
  if (support.matched > 0) {
    const auto matched = static_cast<std::size_t>(support.matched);
    support.gain = median(std::span(gains).first(matched));
    support.relative_gain = median(std::span(relative_gains).first(matched));
  }
  return support;
}

}  // namespace ellipse
