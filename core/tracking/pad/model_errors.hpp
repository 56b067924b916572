#pragma once  // SPDX-License-Identifier: MIT

#include <span>

#include "core/geometry/homography.hpp"
#include "core/tracking/pad/edge_search.hpp"
#include "core/tracking/pad/homography_filter.hpp"
#include "core/tracking/pad/pad_model.hpp"

namespace ellipse {

// An error of an edge in a pad's model is common to all samples of the edge and to all frames, so
// that averaging does not reduce it. The functions below compute its effect on the tracked view: a
// consider covariance [Schmidt1966]. They allocate nothing.

/// Correction of a view by the matched samples of a frame.
struct ViewCorrection {
  const HomographyChange& change;  ///< Since the samples were placed.
  const HomographyCovariance& covariance;
  const HomographyCovariance& prior_information;  ///< 0 = the prior does not depend on the model.
  double reach_px = 0.0;                          ///< Of Tukey's weights.
  double precision = 0.0;                         ///< See HomographyEstimate.
};

/// Updates the sensitivities of the model's edges: the prior carries the effect of their errors
/// from the last frame, and the samples add to it.
void propagate_model_errors(PadModel& model,
                            std::span<const EdgeSample> samples,
                            const ViewCorrection& correction);

/// Updates the sensitivities after a measurement of the outer edge, which does not depend on the
/// model, has corrected the view.
/// @param gain  See HomographyFilter::correct_by_ring().
void reduce_model_errors(PadModel& model, const RingGain& gain);

/// Covariance of the view by the model's errors alone.
[[nodiscard]] HomographyCovariance model_error_covariance(const PadModel& model);

}  // namespace ellipse
