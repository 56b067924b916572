// SPDX-License-Identifier: MIT
#include "core/detection/arcs/ellipse_verifier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

using Levels = std::array<double, 4>;

// Found by experiment, see docs/provenance.md.
constexpr double kFirstSupport = 0.76;   // of the wanted support, before the first step
constexpr double kSecondSupport = 0.91;  // after the first step
constexpr std::size_t kMinHits = 16;
constexpr std::size_t kMinHitsOfStep = 8;
constexpr double kFirstScore = 0.7;           // of the least, on the way
constexpr double kScoreOfPart = 1.94;         // of the least, where little of it is inside
constexpr double kPart = 0.35;                // of the perimeter
constexpr double kContourSizeOfLength = 0.9;  // pixels of a contour per pixel of length

constexpr double kDeformationRelative = 0.025;
constexpr double kMaxDeformationPx = 8.0;
constexpr double kMinDeformedRadius = 12.0;
constexpr double kDeformedSupport = 0.6;
constexpr int kSmoothingDegrees = 8;

int samples_for(const Ellipse& e) {
  const double length = std::numbers::pi * (e.semi_major + e.semi_minor);
  return length < 100.0 ? 32 : length < 600.0 ? 64 : 128;
}

// The mean of chance agreement is p, the observed share s, of n independent samples: n times the
// Kullback-Leibler divergence bounds -ln of the binomial tail [Hoeffding1963].
double significance(double n, double s, double p) {
  s = std::min(s, 0.999);
  if (s <= p) return 0.0;
  return n * (s * std::log(s / p) + (1.0 - s) * std::log((1.0 - s) / (1.0 - p)));
}

// Edges about three pixels apart along the perimeter are independent.
double best_significance(const Levels& shares,
                         double inside_px,
                         double edge_density,
                         double wider_px,
                         double max_chance) {
  double best = 0.0;
  const double crowded = std::max(0.1, 5.0 * edge_density);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double chance =
        std::min(max_chance, crowded * (kDistanceLevels[k] + wider_px) * kDirectionLevels[k]);
    best = std::max(best, significance(inside_px / 3.0, shares[k], chance));
  }
  return best;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double radius_of(const Ellipse& e) {
  return std::sqrt(e.semi_major * e.semi_minor);
}

// Directions are known within .055 rad, and worse by the noise.
double direction_limit(double base, double per_noise, double signal_to_noise) {
  return base + per_noise / std::max(1.0, signal_to_noise);
}

// @param levels  Shares of the inside perimeter that agree within each tolerance.
VerifiedEllipse described(const Ellipse& e,
                          Polarity polarity,
                          const PerimeterEvidence& found,
                          const Levels& levels,
                          double score) {
  VerifiedEllipse result;
  result.ellipse = e;
  result.polarity = polarity;
  result.inside_fraction = found.inside_fraction;
  result.support = found.support;
  result.turn_support = found.turn_support;
  result.on_ellipse = std::min(1.0, levels[3] / found.support);
  result.covered = found.inside_fraction * levels[1];
  result.score = score;
  return result;
}

Verdict judge_length(const PerimeterEvidence& evidence, const Thresholds& thresholds) {
  const double length_px = kContourSizeOfLength * evidence.inside_px * evidence.support;
  return at_least(Reason::kContourTooShort, length_px, thresholds.min_contour_size);
}

// Before all steps of the fit are taken, a part of the wanted support is enough.
Verdict judge_support(double support, double wanted, double part = 1.0) {
  if (support >= part * wanted) return {};
  return below_setting(Reason::kEllipseOverlap, support / part, wanted);
}

Verdict judge_count(std::span<const EdgeHit> hits, std::size_t least) {
  return at_least(
      Reason::kTooFewEdges, static_cast<double>(hits.size()), static_cast<double>(least));
}

}  // namespace

struct EllipseVerifier::Request {
  const GradientMap& map;
  Caution caution;
  Ellipse guess;
  Polarity polarity;
  const Thresholds& thresholds;
};

// How well a smooth curve describes the edge's distance from the ellipse.
struct EllipseVerifier::Smoothness {
  Levels levels{};               // shares of the inside perimeter, as PerimeterEvidence::levels
  double deviation_px = 1e9;     // RMS of the curve
  double direction_error = 9.0;  // median, against the curve's slope [rad]
};

double EllipseVerifier::deformation_px(const Ellipse& e) {
  return std::min(kMaxDeformationPx, 1.5 + kDeformationRelative * radius_of(e));
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

// One Gauss-Newton step with Tukey's weights over the hits of the last probe.
Verdict EllipseVerifier::improve(const Request& request, Ellipse& e, double reach_px) const {
  Verdict verdict = judge_count(probe_.hits(), kMinHitsOfStep);
  if (!verdict.is_accepted()) return verdict;
  GeometricFit fit(e);
  for (const EdgeHit& hit : probe_.hits()) {
    const double weight = hit.weight * tukey_weight(hit.offset.distance_px, reach_px);
    if (weight > 0.0) fit.add(hit.offset, weight);
  }
  const auto better = fit.solve();
  if (!better) return {Reason::kNoEllipse};
  verdict = judge_shape(*better, request.map, request.thresholds);
  if (verdict.is_accepted()) e = *better;
  return verdict;
}

// From the guess to the edges, with a narrowing reach.
Verdict EllipseVerifier::approach(const Request& request, Ellipse& e) {
  const int samples = samples_for(e);
  const double wanted = request.thresholds.ellipse_overlap;
  const auto probe = [&](int tolerance_px) {
    return probe_.probe(request.map, e, request.polarity, samples, tolerance_px);
  };
  Verdict verdict = judge_support(probe(3).support, wanted, kSecondSupport);
  if (verdict.is_accepted()) verdict = improve(request, e, 4.0);
  if (!verdict.is_accepted()) return verdict;
  const PerimeterEvidence evidence = probe(2);
  verdict = judge_support(evidence.support, wanted);
  if (verdict.is_accepted()) verdict = improve(request, e, 2.5);
  if (!verdict.is_accepted()) return verdict;
  const double score = best_significance(
      evidence.levels, evidence.inside_px, request.caution.edge_density, 0.0, 0.5);
  verdict = at_least(Reason::kUnlikely, score, kFirstScore * request.caution.min_score);
  if (!verdict.is_accepted()) return verdict;
  (void)probe(2);
  return improve(request, e, 2.0);
}

double EllipseVerifier::median_residual() {
  values_.clear();
  for (const EdgeHit& hit : probe_.hits()) values_.push_back(std::abs(hit.offset.distance_px));
  return median(values_);
}

double EllipseVerifier::median_direction_error() {
  values_.clear();
  for (const EdgeHit& hit : probe_.hits()) values_.push_back(std::abs(hit.direction_error_rad));
  return median(values_);
}

Verdict EllipseVerifier::verify_exact(const Request& request, VerifiedEllipse& result) {
  Ellipse e = request.guess;
  Verdict verdict = approach(request, e);
  if (!verdict.is_accepted()) return verdict;
  const PerimeterEvidence found =
      probe_.probe(request.map, e, request.polarity, std::min(256, 2 * samples_for(e)), 1);
  verdict = judge_support(found.support, request.thresholds.ellipse_overlap);
  if (verdict.is_accepted()) verdict = judge_count(probe_.hits(), kMinHits);
  if (!verdict.is_accepted()) return verdict;
  const double score =
      best_significance(found.levels, found.inside_px, request.caution.edge_density, 0.0, 0.5);
  const double part = found.inside_fraction < kPart ? kScoreOfPart : 1.0;
  verdict = at_least(Reason::kUnlikely, score, part * request.caution.min_score);
  if (!verdict.is_accepted()) return verdict;
  verdict = at_most(Reason::kWrongDirection,
                    median_direction_error(),
                    direction_limit(0.055, 0.55, found.signal_to_noise));
  if (!verdict.is_accepted()) return verdict;
  // 1.48 medians are a standard deviation. Blurred edges are less certain.
  const double spread_limit = direction_limit(0.10, 2.0, found.signal_to_noise) +
                              3.0 * std::max(0.0, 0.42 - found.sharpness);
  if (found.levels[1] < 0.9) {
    verdict = at_most(Reason::kScattered, 1.48 * median_residual(), spread_limit);
    if (!verdict.is_accepted()) return verdict;
  }
  verdict = judge_length(found, request.thresholds);
  if (verdict.is_accepted()) result = described(e, request.polarity, found, found.levels, score);
  return verdict;
}

// The residual along the perimeter is fitted by a line over a few degrees to both sides of each
// hit: what is left must be small, and the edge's direction that of the line.
EllipseVerifier::Smoothness EllipseVerifier::smoothness(int samples,
                                                        const PerimeterEvidence& evidence) {
  const std::span<const EdgeHit> hits = probe_.hits();
  hit_of_sample_.assign(static_cast<std::size_t>(samples), -1);
  double hit_px = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hit_of_sample_[static_cast<std::size_t>(hits[i].sample)] = static_cast<int>(i);
    hit_px += hits[i].weight;
  }
  const int half_width = std::max(2, kSmoothingDegrees * samples / 360);
  const double direction_slack = std::min(0.1, 0.25 / std::max(1.0, evidence.signal_to_noise));
  Smoothness result;
  double squares = 0.0;
  slopes_.clear();
  for (const EdgeHit& hit : hits) {
    double n = 0.0, t1 = 0.0, t2 = 0.0, r1 = 0.0, rt = 0.0;
    for (int k = -half_width; k <= half_width; ++k) {
      const int other =
          hit_of_sample_[static_cast<std::size_t>((hit.sample + k + samples) % samples)];
      if (other < 0) continue;
      const EdgeHit& near = hits[static_cast<std::size_t>(other)];
      const Eigen::Vector2f tangent(-hit.normal.y(), hit.normal.x());
      const double t = tangent.dot(near.foot - hit.foot);
      if (std::abs(near.offset.distance_px - hit.offset.distance_px) > 1.0 + 0.35 * std::abs(t)) {
        continue;
      }
      n += 1.0;
      t1 += t;
      t2 += t * t;
      r1 += near.offset.distance_px;
      rt += near.offset.distance_px * t;
    }
    const double determinant = n * t2 - t1 * t1;
    if (n < half_width || determinant < 1e-9) continue;
    const double curve = (t2 * r1 - t1 * rt) / determinant;
    const double slope = (n * rt - t1 * r1) / determinant;
    const double left_over = std::abs(hit.offset.distance_px - curve);
    const double direction_error = std::abs(hit.direction_error_rad + std::atan(slope));
    squares += curve * curve;
    slopes_.push_back(direction_error);
    for (std::size_t k = 0; k < kDistanceLevels.size(); ++k) {
      const bool is_within =
          left_over < kDistanceLevels[k] && direction_error < kDirectionLevels[k] + direction_slack;
      if (is_within) result.levels[k] += hit.weight;
    }
  }
  if (slopes_.empty()) return result;
  for (double& level : result.levels) level *= evidence.support / hit_px;
  result.deviation_px = std::sqrt(squares / static_cast<double>(slopes_.size()));
  result.direction_error = median(slopes_);
  return result;
}

std::optional<VerifiedEllipse> EllipseVerifier::verify_deformed(const Request& request) {
  Ellipse e = request.guess;
  if (radius_of(e) < kMinDeformedRadius) return std::nullopt;
  const double reach_px = deformation_px(e);
  const int tolerance_px = static_cast<int>(std::lround(reach_px));
  const int samples = samples_for(e);
  const auto probe = [&](int n) {
    return probe_.probe(request.map, e, request.polarity, n, tolerance_px);
  };
  const double wanted = request.thresholds.ellipse_overlap;
  if (probe(std::max(32, samples / 2)).support < wanted) return std::nullopt;
  if (!improve(request, e, 1.6 * reach_px).is_accepted()) return std::nullopt;
  for (int step = 0; step < 2; ++step) {
    if (probe(samples).support < std::max(kDeformedSupport, wanted)) return std::nullopt;
    if (!improve(request, e, 1.4 * reach_px).is_accepted()) return std::nullopt;
  }
  const int fine = std::min(256, 2 * samples);
  const PerimeterEvidence found = probe(fine);
  if (found.support < std::max(kDeformedSupport, wanted)) return std::nullopt;
  if (probe_.hits().size() < kMinHits || !judge_length(found, request.thresholds).is_accepted()) {
    return std::nullopt;
  }
  const Smoothness smooth = smoothness(fine, found);
  const double score = best_significance(
      smooth.levels, found.inside_px, request.caution.edge_density, 0.5 * reach_px, 0.6);
  VerifiedEllipse result = described(e, request.polarity, found, smooth.levels, score);
  result.is_deformed = true;
  const double deviation = smooth.deviation_px / radius_of(e);
  const auto has = [&](double inside, double level, double most, double direction, double least) {
    return found.inside_fraction >= inside && smooth.levels[1] >= level && deviation < most &&
           smooth.direction_error < direction_limit(direction, 0.3, found.signal_to_noise) &&
           score >= least;
  };
  const bool is_strong = has(0.45, 0.65, 0.014, 0.045, 80.0) && result.covered >= 0.4 &&
                         e.semi_minor >= 0.33 * e.semi_major;
  result.needs_partner = !is_strong;
  if (is_strong || has(0.2, 0.45, 0.016, 0.055, 50.0)) return result;
  return std::nullopt;
}

Verdict EllipseVerifier::judge_promise(const GradientMap& map,
                                       const Ellipse& guess,
                                       Polarity polarity,
                                       const Thresholds& thresholds) {
  const double wanted = thresholds.ellipse_overlap;
  const int samples = std::max(32, samples_for(guess) / 2);
  const double first = kFirstSupport * wanted;
  const double support = perimeter_support(map, guess, polarity, samples, 2, first);
  const Verdict exact = judge_support(support, wanted, kFirstSupport);
  if (exact.is_accepted()) return exact;
  const double reach_px = deformation_px(guess);
  if (reach_px < 2.2) return exact;
  const int tolerance_px = static_cast<int>(std::lround(reach_px));
  const double deformed = perimeter_support(map, guess, polarity, 32, tolerance_px, wanted);
  return deformed >= wanted ? Verdict{} : exact;
}

Verdict EllipseVerifier::verify(const GradientMap& map,
                                const Caution& caution,
                                const Ellipse& guess,
                                Polarity polarity,
                                const Thresholds& thresholds,
                                VerifiedEllipse& found) {
  const Request request{map, caution, guess, polarity, thresholds};
  const Verdict exact = verify_exact(request, found);
  if (exact.is_accepted()) return exact;
  const auto deformed = verify_deformed(request);
  if (!deformed) return exact;
  found = *deformed;
  return {};
}

}  // namespace ellipse
