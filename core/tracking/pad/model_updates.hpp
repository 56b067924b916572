#pragma once  // SPDX-License-Identifier: MIT

#include <span>

#include "core/geometry/homography.hpp"
#include "core/tracking/pad/edge_search.hpp"
#include "core/tracking/pad/pad_model.hpp"

namespace ellipse {

// Corrections of a pad's model by the matched samples of a frame. They allocate nothing.

/// Moves the inner radii towards their matches; the outer radius is the unit, and given radii stay.
/// @param change    Of the view since the samples were placed.
/// @param share     Of the correction that is applied, 0 to 1.
/// @param reach_px  Of Tukey's weights.
void update_radii(PadModel& model,
                  std::span<const EdgeSample> samples,
                  const HomographyChange& change,
                  double share,
                  double reach_px);

/// Counts the matches of the lines, and removes those that are unmatched significantly more often
/// than not, such as edges of shadows or occluders.
/// @param change  Of the view since the samples were placed.
/// @param max_px  Max distance of a match from its expected position.
void drop_refuted_lines(PadModel& model,
                        std::span<const EdgeSample> samples,
                        const HomographyChange& change,
                        double max_px);

}  // namespace ellipse
