// SPDX-License-Identifier: MIT
#include "core/detection/arcs/ellipse_verifier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

constexpr double kBasePx = 1.5;          // deviation of a rigid outline's edges,
constexpr double kDeformation = 0.025;   // plus this share of the radius for deformed outlines
constexpr double kOnOutlinePx = 2.0;     // largest distance of an edge on the outline
constexpr double kOnEllipsePx = 1.0;     // largest distance that counts in the paper's Eq. (1),
constexpr double kOnEllipseRad = 0.3;    // and largest direction error
constexpr double kTukeyOverReach = 1.5;  // an edge at the reach keeps .3 of its weight
constexpr int kMinCorners = 5;           // of the polygons that an outline is compared with
constexpr int kMaxCorners = 8;           // polygons with more are too similar to an ellipse

constexpr std::size_t kSamples = 64;  // of the last step and the final measurement

// Added to features before the logarithm, so that differences below it hardly matter.
struct Floor {
  double direction_error_rad;
  double coverage;
  double deviation;
};
constexpr Floor kFloor{.direction_error_rad = 0.01, .coverage = 0.02, .deviation = 0.002};
constexpr Range kSignalToNoise{1.0, 100.0};  // limits of the feature

// A Gauss-Newton step. For 99 % of the true ellipses of the sources, the log odds grow by at most
// max_growth from this step on.
struct Step {
  std::size_t samples;
  double part_of_reach;
  double max_growth;
};
constexpr std::array<Step, 4> kSteps = {{{kSamples / 2, 1.0, 7.0},
                                         {kSamples / 2, 0.7, 5.0},
                                         {kSamples / 2, 0.5, 2.5},
                                         {kSamples, 0.5, 1.0}}};

// Longest run of samples without an edge, as a share of all samples.
double longest_gap(std::span<const EdgeMeasurement> edges, std::size_t samples) {
  const int count = static_cast<int>(samples);
  int longest = edges.empty() ? count : 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int next = i + 1 < edges.size() ? edges[i + 1].sample : edges.front().sample + count;
    longest = std::max(longest, next - edges[i].sample - 1);
  }
  return static_cast<double>(longest) / count;
}

// Number of neighbouring edges that differ in polarity, as a share of all edges.
double share_of_changes(std::span<const EdgeMeasurement> edges) {
  int changes = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeMeasurement& next = edges[(i + 1) % edges.size()];
    if (edges[i].is_bright_inside != next.is_bright_inside) ++changes;
  }
  return edges.empty() ? 0.0 : changes / static_cast<double>(edges.size());
}

bool is_on_outline(const EdgeMeasurement& edge, double reach_px) {
  return std::abs(edge.offset.distance_px) <= reach_px;
}

// Sums over the edges of an outline.
struct Sums {
  double length = 0.0;
  double length_on_ellipse = 0.0;
  double squares = 0.0;
  double turn = 0.0;
  double turn_in_reach = 0.0;

  void add(const EdgeMeasurement& edge, double reach_px) {
    const double distance_px = std::abs(edge.offset.distance_px);
    length += edge.length_px;
    squares += edge.length_px * distance_px * distance_px;
    turn += edge.turn;
    if (is_on_outline(edge, reach_px)) turn_in_reach += edge.turn;
    const bool is_along = std::abs(edge.direction_error_rad) <= kOnEllipseRad;
    if (distance_px <= kOnEllipsePx && is_along) length_on_ellipse += edge.length_px;
  }
  [[nodiscard]] double share_of_turn() const { return turn > 0.0 ? turn_in_reach / turn : 0.0; }
  [[nodiscard]] double rms_px() const { return length > 0.0 ? std::sqrt(squares / length) : 1e9; }
};

// Along an affine image of a regular polygon with n corners, the direction error per eccentric
// anomaly, in units of the axes, is a sawtooth of amplitude pi / n and period 2 pi / n. Its first
// harmonic has the amplitude 2 / n, and blur hardly reduces it. Returns the measured amplitude over
// 2 / n, for the n with the largest one: 0 along an ellipse, 1 along a polygon.
double turn_in_corners(std::span<const EdgeMeasurement> edges, std::size_t samples) {
  std::array<std::complex<double>, kMaxCorners - kMinCorners + 1> sums{};
  for (const EdgeMeasurement& edge : edges) {
    const double px_per_rad = edge.length_px * static_cast<double>(samples) / kTwoPi;
    const double error = edge.direction_error_rad * px_per_rad / edge.offset.px_per_unit;
    const std::complex<double> anomaly(edge.offset.anomaly.x(), edge.offset.anomaly.y());
    std::complex<double> power = error;
    for (int corners = 1; corners <= kMaxCorners; ++corners) {
      power *= anomaly;
      if (corners >= kMinCorners) sums[std::size_t(corners - kMinCorners)] += power;
    }
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double corners = kMinCorners + static_cast<double>(i);
    largest = std::max(largest, corners * std::abs(sums[i]));
  }
  return largest / static_cast<double>(samples);
}

}  // namespace

double EllipseVerifier::deformation_px(const Ellipse& e) {
  return kBasePx + kDeformation * mean_radius_px(e);
}

Verdict EllipseVerifier::judge_shape(const Ellipse& e,
                                     const GradientMap& map,
                                     const Thresholds& thresholds) {
  const Verdict axes = thresholds.judge_axes_of(e);
  if (!axes.is_accepted()) return axes;
  const auto check_position = [](double center, int size) {
    return at_most(Reason::kFarOutside, std::abs(center / size - 0.5) - 0.5, 1.0);
  };
  const Verdict column = check_position(e.cx, map.width());
  return column.is_accepted() ? check_position(e.cy, map.height()) : column;
}

// Gauss-Newton steps with a narrowing reach.
Verdict EllipseVerifier::approach(const GradientMap& map,
                                  const Thresholds& thresholds,
                                  const EvidenceTable& table,
                                  MeasuredEllipse& measured) {
  const double widest_px = std::max(2.0 * kBasePx, deformation_px(measured.ellipse));
  for (const Step& step : kSteps) {
    const double reach_px = std::max(kOnOutlinePx, step.part_of_reach * widest_px);
    (void)measure(map, step.samples, reach_px, measured);
    const Verdict prospect = judge_prospect(step.max_growth, thresholds, table, measured);
    if (!prospect.is_accepted()) return prospect;
    const auto better = nearer_to_edges(measured.ellipse, reach_px);
    if (!better) return {Reason::kNoEllipse};
    const Verdict shape = judge_shape(*better, map, thresholds);
    if (!shape.is_accepted()) return shape;
    measured.ellipse = *better;
  }
  return {};
}

Verdict EllipseVerifier::judge_edges() const {
  const auto edges = static_cast<double>(measurer_.edges().size());
  return at_least(Reason::kTooFewEdges, edges, double(kMinEdgesOfEllipse));
}

// Rejects a candidate that is unlikely to reach the minimum probability in the remaining steps. If
// none is accepted, all are measured.
Verdict EllipseVerifier::judge_prospect(double max_growth,
                                        const Thresholds& thresholds,
                                        const EvidenceTable& table,
                                        const MeasuredEllipse& measured) const {
  const Verdict enough = judge_edges();
  if (!enough.is_accepted()) return enough;
  const double required = thresholds.min_probability;
  const double reachable = table.log_odds(measured.features) + max_growth;
  if (!thresholds.accepts_any() || reachable >= log_odds(required)) return {};
  return at_least(Reason::kUnlikely, table.probability(measured.features), required);
}

// Least squares with Tukey's weights.
std::optional<Ellipse> EllipseVerifier::nearer_to_edges(const Ellipse& e, double reach_px) const {
  const double tukey_px = kTukeyOverReach * reach_px;
  GeometricFit fit(e);
  for (const EdgeMeasurement& edge : measurer_.edges()) {
    const double weight = edge.length_px * tukey_weight(edge.offset.distance_px, tukey_px);
    if (weight > 0.0) fit.add(edge.offset, weight);
  }
  return fit.solve();
}

// @param samples   Minimum; doubled while too few are inside the picture.
// @param reach_px  Largest distance of an edge on the outline.
// @return          Number of samples.
std::size_t EllipseVerifier::measure(const GradientMap& map,
                                     std::size_t samples,
                                     double reach_px,
                                     MeasuredEllipse& measured) {
  const Ellipse& e = measured.ellipse;
  const int tolerance_px = static_cast<int>(std::lround(std::max(reach_px, deformation_px(e))));
  OutlineSupport found = measurer_.measure(map, e, measured.polarity, samples, tolerance_px);
  while (samples < OutlineSamples::kMaxSamples &&
         found.inside_fraction * static_cast<double>(samples) < 2.0 * kMinEdgesOfEllipse) {
    samples *= 2;
    found = measurer_.measure(map, e, measured.polarity, samples, tolerance_px);
  }
  measured.support = found.support;
  measured.matched_px = found.inside_px * found.support;
  measured.gradient = measurer_.mean_contrast();
  set_features(found, samples, reach_px, map.texture(), measured);
  return samples;
}

// Computes the features from the measured edges.
void EllipseVerifier::set_features(const OutlineSupport& found,
                                   std::size_t samples,
                                   double reach_px,
                                   double texture,
                                   MeasuredEllipse& measured) {
  const std::span<const EdgeMeasurement> edges = measurer_.edges();
  Sums sums;
  direction_errors_.clear();
  for (const EdgeMeasurement& edge : edges) {
    sums.add(edge, reach_px);
    if (!is_on_outline(edge, reach_px)) continue;
    direction_errors_.push_back(std::abs(edge.direction_error_rad));
  }
  measured.on_ellipse = sums.length > 0.0 ? sums.length_on_ellipse / sums.length : 0.0;
  const double turn_support = found.turn_support * sums.share_of_turn();
  const double largest_error = std::acos(std::sqrt(kMinSquaredCosine));
  const double error =
      direction_errors_.empty() ? largest_error : median(std::span(direction_errors_));
  // A long ellipse whose ends are outside has short gaps, but shows little of its turn.
  const double coverage =
      turn_support * std::min(1.0 - longest_gap(edges, samples), found.inside_turn_fraction);
  const double deviation = std::min(1.0, sums.rms_px() / mean_radius_px(measured.ellipse));
  const double signal_to_noise =
      std::clamp(measured.gradient / texture, kSignalToNoise.min, kSignalToNoise.max);
  const auto set = [&](Feature feature, double value) {
    measured.features[static_cast<std::size_t>(feature)] = value;
  };
  set(Feature::kTurnSupport, turn_support);
  set(Feature::kDirectionError, std::log(kFloor.direction_error_rad + error));
  set(Feature::kCoverage, std::log(kFloor.coverage + coverage));
  set(Feature::kLength, std::log1p(found.inside_px));
  set(Feature::kDeviation, std::log(kFloor.deviation + deviation));
  set(Feature::kChanges, share_of_changes(edges));
  set(Feature::kContrast, std::log(signal_to_noise));
  set(Feature::kCorners,
      0.0);  // measured last; its weight is negative: no corners are the best case
}

Polarity EllipseVerifier::better_polarity(const GradientMap& map, const Ellipse& e) {
  const auto support_of = [&](Polarity polarity) {
    return measurer_.measure(map, e, polarity, kSamples, static_cast<int>(kOnOutlinePx)).support;
  };
  return support_of(Polarity::kDarkInside) >= support_of(Polarity::kBrightInside)
             ? Polarity::kDarkInside
             : Polarity::kBrightInside;
}

Verdict EllipseVerifier::verify(const GradientMap& map,
                                const Ellipse& guess,
                                Polarity polarity,
                                const Thresholds& thresholds,
                                const EvidenceTable& table,
                                MeasuredEllipse& measured) {
  measured.ellipse = guess;
  measured.polarity = polarity;
  Verdict verdict = approach(map, thresholds, table, measured);
  if (!verdict.is_accepted()) return verdict;
  const std::size_t samples = measure(map, kSamples, kOnOutlinePx, measured);
  if (verdict = judge_edges(); !verdict.is_accepted()) return verdict;
  measured.features[static_cast<std::size_t>(Feature::kCorners)] =
      turn_in_corners(measurer_.edges(), samples);
  measured.probability = table.probability(measured.features);
  verdict = at_least(Reason::kUnlikely, measured.probability, thresholds.min_probability);
  if (!verdict.is_accepted()) return verdict;
  verdict = at_least(Reason::kEllipseOverlap, measured.support, thresholds.ellipse_overlap);
  if (!verdict.is_accepted()) return verdict;
  verdict = at_least(Reason::kContourOverlap, measured.on_ellipse, thresholds.contour_overlap);
  if (!verdict.is_accepted()) return verdict;
  // Contour pixels per pixel of length: mean of max(|cos|, |sin|) over all directions.
  const double contour_px = 2.0 * std::numbers::sqrt2 / std::numbers::pi * measured.matched_px;
  measured.as_target = at_least(Reason::kContourTooShort, contour_px, thresholds.min_contour_size);
  return thresholds.wants_all ? Verdict{} : measured.as_target;
}

}  // namespace ellipse
