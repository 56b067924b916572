// SPDX-License-Identifier: MIT
#include "core/detection/arcs/ellipse_verifier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kMinHits = 8;     // 5 parameters, and edges to judge them by
constexpr double kMinPromise = 0.4;     // share of the perimeter that has edges near
constexpr double kBasePx = 1.5;         // an edge of a rigid outline is this near,
constexpr double kDeformation = 0.025;  // one of a deformed outline this share of the radius more
constexpr double kMaxDeformationPx = 8.0;
constexpr double kOnOutlinePx = 2.0;
constexpr double kTurnWindow = 0.2;           // [rad] of the outline's turn, to both sides
constexpr double kStraightSlope = -0.5;       // halfway between an ellipse's 0 and a line's -1
constexpr double kContourSizeOfLength = 0.9;  // pixels of a contour per pixel of length

// A Gauss-Newton step: its reach, and by how much the log odds of an ellipse grow at most from
// here on, in 99.5 % of the ellipses of the sources.
struct Step {
  int samples;
  double part_of_reach;
  double max_growth;
};
constexpr std::array<Step, 4> kSteps = {{{32, 1.0, 7.0}, {32, 0.7, 5.0}, {32, 0.5, 2.5}, {64, 0.5, 1.0}}};

double radius_of(const Ellipse& e) {
  return std::sqrt(e.semi_major * e.semi_minor);
}

int samples_for(const Ellipse& e) {
  const double length = std::numbers::pi * (e.semi_major + e.semi_minor);
  return length < 100.0 ? 64 : 128;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double longest_gap(std::span<const EdgeHit> hits, int samples) {
  int longest = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const int next = i + 1 < hits.size() ? hits[i + 1].sample : hits.front().sample + samples;
    longest = std::max(longest, next - hits[i].sample - 1);
  }
  return static_cast<double>(longest) / samples;
}

double turn_of(const EdgeHit& hit) {
  return 1.0 / (hit.weight * hit.weight);  // but for a factor
}

}  // namespace

double EllipseVerifier::deformation_px(const Ellipse& e) {
  return std::min(kMaxDeformationPx, kBasePx + kDeformation * radius_of(e));
}

Verdict EllipseVerifier::judge_shape(const Ellipse& e,
                                     const GradientMap& map,
                                     const Thresholds& thresholds) {
  const Verdict axes = thresholds.judge_axes_of(e);
  if (!axes.is_accepted()) return axes;
  const auto judge_place = [](double center, int size) {
    return at_most(Reason::kFarOutside, std::abs(center / size - 0.5) - 0.5, 1.0);
  };
  const Verdict column = judge_place(e.cx, map.width());
  return column.is_accepted() ? judge_place(e.cy, map.height()) : column;
}

Verdict EllipseVerifier::judge_promise(const GradientMap& map,
                                       const Ellipse& guess,
                                       Polarity polarity) {
  const int tolerance_px = static_cast<int>(std::lround(deformation_px(guess) + kBasePx));
  const double support = perimeter_support(map, guess, polarity, 32, tolerance_px, kMinPromise);
  return at_least(Reason::kTooFewEdges, support, kMinPromise);
}

// Gauss-Newton steps with Tukey's weights and a narrowing reach.
Verdict EllipseVerifier::approach(const GradientMap& map,
                                  const Thresholds& thresholds,
                                  const EvidenceTable& table,
                                  MeasuredEllipse& measured) {
  Ellipse& e = measured.ellipse;
  const double widest_px = std::max(3.0, deformation_px(e));
  const double wanted = std::log(thresholds.min_probability / (1.0 - thresholds.min_probability));
  for (const Step& step : kSteps) {
    const double reach_px = std::max(kOnOutlinePx, step.part_of_reach * widest_px);
    measure(map, step.samples, reach_px, measured);
    const Verdict promise = at_least(Reason::kTooFewEdges, measured.support, kMinPromise);
    if (!promise.is_accepted()) return promise;
    const Verdict enough =
        at_least(Reason::kTooFewEdges, double(probe_.hits().size()), static_cast<double>(kMinHits));
    if (!enough.is_accepted()) return enough;
    if (thresholds.min_probability < 1.0) {
      const double reachable = table.log_odds(measured.features) + step.max_growth;
      if (reachable < wanted) {
        return at_least(
            Reason::kUnlikely, table.probability(measured.features), thresholds.min_probability);
      }
    }
    GeometricFit fit(e);
    for (const EdgeHit& hit : probe_.hits()) {
      const double weight = hit.weight * tukey_weight(hit.offset.distance_px, 1.5 * reach_px);
      if (weight > 0.0) fit.add(hit.offset, weight);
    }
    const auto better = fit.solve();
    if (!better) return {Reason::kNoEllipse};
    const Verdict shape = judge_shape(*better, map, thresholds);
    if (!shape.is_accepted()) return shape;
    e = *better;
  }
  return {};
}

// Along a polygon's side the gradient keeps its direction while the outline's normal turns: the
// direction error falls by a radian per radian of turn. Along an ellipse it stays. A line through
// the errors in a window of the turn tells the two apart.
double EllipseVerifier::straight_share() {
  const std::span<const EdgeHit> hits = probe_.hits();
  const std::size_t n = hits.size();
  angles_.resize(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = std::atan2(hits[i].normal.y(), hits[i].normal.x());
    angles_[i] = i == 0 ? angle : angles_[i - 1] + std::remainder(angle - angles_[i - 1], kTwoPi);
  }
  for (std::size_t i = 0; i < n; ++i) angles_[n + i] = angles_[i] + kTwoPi;
  double straight = 0.0;
  double judged = 0.0;
  std::size_t first = 0;
  std::size_t last = 0;
  double sum = 0.0, x1 = 0.0, x2 = 0.0, y1 = 0.0, xy = 0.0;
  const auto add = [&](std::size_t i, double sign) {
    const double x = angles_[i] - angles_[n / 2];
    const double y = hits[i % n].direction_error_rad;
    sum += sign;
    x1 += sign * x;
    x2 += sign * x * x;
    y1 += sign * y;
    xy += sign * x * y;
  };
  for (std::size_t i = n / 2; i < n / 2 + n; ++i) {
    while (last < 2 * n && angles_[last] <= angles_[i] + kTurnWindow) add(last++, 1.0);
    while (angles_[first] < angles_[i] - kTurnWindow) add(first++, -1.0);
    const double determinant = sum * x2 - x1 * x1;
    if (sum < 4.0 || determinant < 1e-6) continue;
    const double weight = hits[i % n].weight;
    judged += weight;
    if (sum * xy - x1 * y1 < kStraightSlope * determinant) straight += weight;
  }
  return judged > 0.0 ? straight / judged : 1.0;
}

// @param reach_px  Edges this near are on the outline.
void EllipseVerifier::measure(const GradientMap& map,
                              int samples,
                              double reach_px,
                              MeasuredEllipse& measured) {
  const Ellipse& e = measured.ellipse;
  const int tolerance_px = static_cast<int>(std::lround(std::max(reach_px, deformation_px(e))));
  const PerimeterEvidence found = probe_.probe(map, e, measured.polarity, samples, tolerance_px);
  const std::span<const EdgeHit> hits = probe_.hits();
  double turn = 0.0;
  double turn_on_outline = 0.0;
  double squares = 0.0;
  double length = 0.0;
  values_.clear();
  for (const EdgeHit& hit : hits) {
    const double distance = hit.offset.distance_px;
    turn += turn_of(hit);
    squares += hit.weight * distance * distance;
    length += hit.weight;
    if (std::abs(distance) > reach_px) continue;
    turn_on_outline += turn_of(hit);
    values_.push_back(std::abs(hit.direction_error_rad));
  }
  measured.inside_fraction = found.inside_fraction;
  measured.support = found.support;
  measured.on_ellipse = found.support > 0.0 ? std::min(1.0, found.levels[2] / found.support) : 0.0;
  const auto set = [&](Feature feature, double value) {
    measured.features[static_cast<std::size_t>(feature)] = value;
  };
  const double radius = radius_of(e);
  const double deviation = length > 0.0 ? std::sqrt(squares / length) / radius : 1.0;
  const double turn_support = turn > 0.0 ? found.turn_support * turn_on_outline / turn : 0.0;
  const double longest = hits.empty() ? 1.0 : longest_gap(hits, samples);
  set(Feature::kTurnSupport, turn_support);
  set(Feature::kDirectionError, std::log(0.01 + (values_.empty() ? 0.5 : median(values_))));
  set(Feature::kCoverage, std::log(0.02 + turn_support * (1.0 - longest)));
  set(Feature::kLength, std::log1p(found.inside_px));
  set(Feature::kDeviation, std::log(0.002 + std::min(1.0, deviation)));
  set(Feature::kRadius, std::log(radius));
  set(Feature::kContrast, std::log(std::clamp(found.signal_to_noise, 1.0, 100.0)));
  set(Feature::kStraight, 0.0);
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
  measure(map, samples_for(measured.ellipse), kOnOutlinePx, measured);
  if (probe_.hits().size() < kMinHits) return {Reason::kTooFewEdges};
  measured.features[static_cast<std::size_t>(Feature::kStraight)] = straight_share();
  measured.probability = table.probability(measured.features);
  verdict = at_least(Reason::kUnlikely, measured.probability, thresholds.min_probability);
  if (!verdict.is_accepted()) return verdict;
  verdict = at_least(Reason::kEllipseOverlap, measured.support, thresholds.ellipse_overlap);
  if (!verdict.is_accepted()) return verdict;
  verdict = at_least(Reason::kContourOverlap, measured.on_ellipse, thresholds.contour_overlap);
  if (!verdict.is_accepted()) return verdict;
  const Ellipse& e = measured.ellipse;
  const double visible_px = perimeter_px(e) * visible_fraction(e, map.width(), map.height());
  return at_least(Reason::kContourTooShort,
                  kContourSizeOfLength * visible_px * measured.support,
                  thresholds.min_contour_size);
}

}  // namespace ellipse
