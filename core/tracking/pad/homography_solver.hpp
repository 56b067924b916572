#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

#include "core/tracking/pad/edge_search.hpp"

namespace ellipse {

/// What is known of a change before it is measured.
struct HomographyPrior {
  HomographyChange mean = HomographyChange::Zero();
  HomographyCovariance information = HomographyCovariance::Zero();  ///< Inverse of the covariance.
};

/// A change and how well it is known.
struct HomographyEstimate {
  HomographyChange change = HomographyChange::Zero();
  HomographyCovariance information = HomographyCovariance::Zero();
};

/// How well a change agrees with the samples.
struct HomographySupport {
  int visible = 0;        ///< Samples inside the picture.
  int matched = 0;        ///< Of these, with an edge where it should be.
  double coverage = 0.0;  ///< matched over visible.
  double outline = 0.0;   ///< The same of the outer circle alone; 0 where none of it is in view.
  double weakest = 0.0;   ///< Coverage of the circle with the least.
  double gain = 1.0;      ///< Median contrast over the model's.
};

/// Solves for the change that brings all edges to their matches, weighted by what is known of it:
/// iterated least squares with Tukey's weights, each sample by its candidate next to the
/// prediction.
///
/// @param start     Where to begin.
/// @param reach_px  Of the weights: edges farther off do not count.
/// @param sigma_px  Standard deviation of an edge's place.
/// nullopt where the system is singular. Allocates nothing.
[[nodiscard]] std::optional<HomographyEstimate> solve_homography(
    std::span<const EdgeSample> samples,
    const HomographyPrior& prior,
    const HomographyChange& start,
    double reach_px,
    double sigma_px,
    int iterations);

/// The candidate next to where a change puts the edge; nullptr where none was matched.
[[nodiscard]] const EdgeCandidate* nearest_candidate(const EdgeSample& sample, double predicted_px);

/// The sum of the samples' weights under a change: how much it explains.
[[nodiscard]] double explained(std::span<const EdgeSample> samples,
                               const HomographyChange& change,
                               double reach_px);

[[nodiscard]] HomographySupport support_of(std::span<const EdgeSample> samples,
                                           const HomographyChange& change,
                                           double tolerance_px,
                                           int circles);

}  // namespace ellipse
