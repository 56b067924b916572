// SPDX-License-Identifier: MIT
#include "core/tracking/pad/model_updates.hpp"

#include <cstddef>
#include <vector>

#include "core/geometry/robust.hpp"
#include "core/tracking/pad/homography_solver.hpp"

namespace ellipse {
namespace {

// Weighted mean distance of a circle's matches from its expected positions, outwards [radii]; 0
// without matches.
double mean_error(const PadCircle& circle,
                  int feature,
                  std::span<const EdgeSample> samples,
                  const HomographyChange& change,
                  double reach_px) {
  const double sign = circle.is_bright_outside ? 1.0 : -1.0;
  double sum = 0.0;
  double weights = 0.0;
  for (const EdgeSample& sample : samples) {
    if (sample.feature != feature) continue;
    const EdgeCandidate* edge = nearest_candidate(sample, sample.predicted_px(change));
    if (edge == nullptr) continue;
    const double beside_px = edge->distance_px - sample.predicted_px(change);
    const double px = sample.view.px_per_unit;
    const double weight = tukey_weight(beside_px, reach_px) * px * px;
    sum += weight * sign * beside_px / px;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace

void update_radii(PadModel& model,
                  std::span<const EdgeSample> samples,
                  const HomographyChange& change,
                  double share,
                  double reach_px) {
  for (std::size_t i = 1; i < model.circles.size(); ++i) {
    PadCircle& circle = model.circles[i];
    if (circle.is_given) continue;
    circle.radius += share * mean_error(circle, static_cast<int>(i), samples, change, reach_px);
  }
}

void drop_refuted_lines(PadModel& model,
                        std::span<const EdgeSample> samples,
                        const HomographyChange& change,
                        double max_px) {
  for (const EdgeSample& sample : samples) {
    PadLine* line = line_of(model, sample.feature);
    if (line == nullptr || !sample.is_visible) continue;
    ++line->visible;
    line->matched += is_matched(sample, change, max_px) ? 1 : 0;
  }
  std::erase_if(model.lines,
                [](const PadLine& line) { return is_refuted(line.matched, line.visible); });
}

}  // namespace ellipse
