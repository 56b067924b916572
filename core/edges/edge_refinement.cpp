// SPDX-License-Identifier: MIT
#include "core/edges/edge_refinement.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/edges/noise.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

using Points = std::array<Eigen::Vector2d, OutlineSamples::kMaxSamples>;

// Standard deviation of an edge over that of a sharp one.
double spread_of(const EdgeMeasurement& edge) {
  return edge.sigma_px / kVertexError;
}

// One Gauss-Newton step of the ellipse to the edges, at these points of the ideal plane.
// Its distances are relative to the spread of each edge.
std::optional<FittedEllipse> stepped(const Ellipse& e,
                                     std::span<const EdgeMeasurement> edges,
                                     const Points& ideal) {
  GeometricFit fit(e);
  std::array<PerimeterOffset, OutlineSamples::kMaxSamples> offsets;
  std::array<WeightedDistance, OutlineSamples::kMaxSamples> distances;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    // Outside the lens's range there is no ideal point.
    if (!ideal[i].allFinite()) {
      offsets[i].distance_px = std::numeric_limits<double>::infinity();
      distances[i] = {offsets[i].distance_px, 0.0};
      continue;
    }
    offsets[i] = fit.offset_of(ideal[i]);
    offsets[i].distance_px *= edges[i].px_per_ideal;
    offsets[i].px_per_unit *= edges[i].px_per_ideal;
    const double spread = spread_of(edges[i]);
    distances[i] = {offsets[i].distance_px / spread, edges[i].length_px / (spread * spread)};
  }
  std::array<WeightedDistance, OutlineSamples::kMaxSamples> sorted = distances;
  const double scatter_px = robust_sigma(std::span(sorted).first(edges.size()));
  const double reach_px = std::max(double{kPixelError}, kAllSigmas * scatter_px);
  ResidualSums residuals;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [distance_px, precision] = distances[i];
    const double weight = precision * tukey_weight(distance_px, reach_px);
    if (weight > 0.0) fit.add(offsets[i], weight);
    const double reach_of_edge = spread_of(edges[i]) * reach_px;
    residuals.add(edges[i].sample, offsets[i].distance_px, reach_of_edge, precision);
  }
  if (residuals.samples() < kMinEdgesOfEllipse) return std::nullopt;
  const auto better = fit.solve();
  if (!better) return std::nullopt;
  const double factor = residuals.information_factor(RingMatrix::RowsAtCompileTime, kVertexError);
  return FittedEllipse{*better, {image_from_pad(*better), factor * fit.information()}};
}

}  // namespace

std::optional<FittedEllipse> refined_on_picture(const Picture& picture,
                                                const Ellipse& e,
                                                Polarity polarity,
                                                double min_gradient) {
  EdgeMeasurer measurer;
  (void)measurer.measure(picture, e, polarity, kRefinementSamples, min_gradient);
  return fitted_to_edges(measurer, picture.lens, e);
}

// Two steps, since the scatter around the given ellipse contains its own error.
std::optional<FittedEllipse> fitted_to_edges(const EdgeMeasurer& measurer,
                                             const LensView& lens,
                                             const Ellipse& e) {
  const std::span<const EdgeMeasurement> edges = measurer.edges();
  if (edges.size() < kMinEdgesOfEllipse) return std::nullopt;
  Points ideal;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ideal[i] = lens.approximate_ideal(measurer.origin() + edges[i].point.cast<double>());
  }
  const auto nearer = stepped(e, edges, ideal);
  return nearer ? stepped(nearer->ellipse, edges, ideal) : std::nullopt;
}

}  // namespace ellipse
