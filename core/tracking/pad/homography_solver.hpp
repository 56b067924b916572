#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

#include "core/tracking/pad/edge_search.hpp"

namespace ellipse {

/// Gaussian prior of a change.
struct HomographyPrior {
  HomographyChange mean = HomographyChange::Zero();
  HomographyCovariance information = HomographyCovariance::Zero();  ///< Inverse of the covariance.
};

/// A change and its inverse covariance.
struct HomographyEstimate {
  HomographyChange change = HomographyChange::Zero();
  HomographyCovariance information = HomographyCovariance::Zero();
  /// Weight of a match before Tukey's [1 / px^2]: the inverse variance of its position.
  double precision = 0.0;
};

/// Whether an edge is unmatched significantly more often than not.
[[nodiscard]] bool is_refuted(int matched, int visible);

/// How well a change agrees with the samples.
struct HomographySupport {
  int visible = 0;              ///< Visible samples.
  int matched = 0;              ///< Of these, with an edge within the tolerance.
  double coverage = 0.0;        ///< matched over visible.
  double outer_coverage = 0.0;  ///< The same of the outer circle alone; 0 if none of it is visible.
  double gain = 1.0;            ///< Median ratio of image contrast to model contrast.
  double relative_gain = 0.0;   ///< The same of relative contrast [1 / grey level].
  /// No visible circle is refuted; or only inner ones are, while another one or the lines are
  /// matched significantly more often than not. An inner one may be in shadow, or another pattern
  /// that looks like a circle from afar.
  bool has_circles = false;
};

/// Which matches solve_homography() accepts, and their weight over the prior's.
struct MatchLimits {
  double first_reach_px = 0.0;  ///< Residual from which weights are 0, in the first iterations.
  double reach_px = 0.0;        ///< The same in the last iterations.
  double min_sigma_px = 1.0;    ///< Min standard deviation of a match.
  /// Whether the standard deviation follows from the scatter of all matches, see
  /// ResidualSums::independent_precision(): matches by chance have little weight.
  bool uses_scatter = false;
};

/// Solves for the maximum a posteriori change that moves all edges to their matches: iteratively
/// reweighted least squares with Tukey's weights, on each sample's candidate nearest to the
/// prediction.
/// @return nullopt if the system is singular. Allocates nothing.
[[nodiscard]] std::optional<HomographyEstimate> solve_homography(
    std::span<const EdgeSample> samples, const HomographyPrior& prior, const MatchLimits& limits);

/// The candidate nearest to the predicted edge; nullptr if there is none.
[[nodiscard]] const EdgeCandidate* nearest_candidate(const EdgeSample& sample, double predicted_px);

/// Whether a sample has a candidate within max_px of its predicted edge.
[[nodiscard]] bool is_matched(const EdgeSample& sample,
                              const HomographyChange& change,
                              double max_px);

/// @param circles  Of the model; at least one.
[[nodiscard]] HomographySupport support_of(std::span<const EdgeSample> samples,
                                           const HomographyChange& change,
                                           double tolerance_px,
                                           int circles);

}  // namespace ellipse
