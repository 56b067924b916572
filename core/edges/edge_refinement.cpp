// SPDX-License-Identifier: MIT
#include "core/edges/edge_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

constexpr std::array<double, 2> kTukeyReach = {2.0, 1.0};  // of each step [px]

// The errors of five parameters follow Student's t with n - 5 degrees of freedom if the variance is
// estimated from n independent residuals; its covariance is the sum of their squares over n - 7.
double share_of_freedom(double independent) {
  return std::max(1.0, independent - 7.0) / independent;
}

}  // namespace

std::optional<FittedEllipse> refined_on_picture(const Picture& picture,
                                                const Ellipse& e,
                                                Polarity polarity,
                                                const EdgeLimits& limits,
                                                std::size_t samples) {
  EdgeMeasurer measurer;
  const OutlineSupport found = measurer.measure(picture, e, polarity, samples, limits.min_gradient);
  if (found.support < limits.min_support) return std::nullopt;
  return fitted_to_edges(measurer, picture.lens, e);
}

std::optional<FittedEllipse> fitted_to_edges(const EdgeMeasurer& measurer,
                                             const LensView& lens,
                                             const Ellipse& e) {
  const std::span<const EdgeMeasurement> edges = measurer.edges();
  if (edges.size() < kMinEdgesOfEllipse) return std::nullopt;
  FittedEllipse refined{e, {}};
  std::array<Eigen::Vector2d, OutlineSamples::kMaxSamples> ideal;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ideal[i] = lens.approximate_ideal(measurer.origin() + edges[i].point.cast<double>());
  }
  for (const double reach_px : kTukeyReach) {
    GeometricFit fit(refined.ellipse);
    double squares = kVertexError * kVertexError;  // a prior of weight 1
    double weights = 1.0;
    double length_px = 0.0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      PerimeterOffset offset = fit.offset_of(ideal[i]);
      offset.distance_px *= edges[i].px_per_ideal;
      offset.px_per_unit *= edges[i].px_per_ideal;
      const double precision = std::pow(kVertexError / edges[i].sigma_px, 2);
      const double weight =
          edges[i].length_px * precision * tukey_weight(offset.distance_px, reach_px);
      if (!(weight > 0.0)) continue;
      fit.add(offset, weight);
      squares += weight * offset.distance_px * offset.distance_px;
      weights += weight;
      length_px += edges[i].length_px;
    }
    const double independent_px =
        std::max(kIndependentPx, length_px / static_cast<double>(edges.size()));
    const auto better = fit.solve();
    if (!better) return std::nullopt;
    refined.ellipse = *better;
    const double scale =
        weights / squares * share_of_freedom(length_px / independent_px) / independent_px;
    refined.uncertainty = {image_from_pad(*better), scale * fit.information()};
  }
  return refined;
}

}  // namespace ellipse
