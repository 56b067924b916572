// SPDX-License-Identifier: MIT
#include "core/perimeter.hpp"

#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

constexpr double kLeastSquaredCosine = 0.75;  // 30 degrees

// Cosine and sine of evenly spaced eccentric anomalies.
const std::array<Eigen::Vector2d, PerimeterProbe::kMostSamples>& circle_points() {
  static const auto kPoints = [] {
    std::array<Eigen::Vector2d, PerimeterProbe::kMostSamples> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / points.size();
      points[i] = {std::cos(t), std::sin(t)};
    }
    return points;
  }();
  return kPoints;
}

// The pixel nearest to a place on the perimeter, and the way across the perimeter.
struct Crossing {
  std::int32_t pixel;
  int step;
};

// A chained crest near the crossing whose gradient agrees with the normal; -1 where none is.
std::int32_t nearest_edge(const GradientMap& map,
                          const Crossing& at,
                          const Eigen::Vector2d& inward_to_bright,
                          int tolerance_px) {
  for (int k = 0; k <= 2 * tolerance_px; ++k) {
    const int offset = (k & 1) != 0 ? (k + 1) / 2 : -(k / 2);
    const std::int32_t pixel = at.pixel + offset * at.step;
    if ((map.crests()[pixel] & crest::kChained) == 0) continue;
    const Gradient& g = map.gradients()[pixel];
    const double along = g.x * inward_to_bright.x() + g.y * inward_to_bright.y();
    const double squared = static_cast<double>(g.x) * g.x + static_cast<double>(g.y) * g.y;
    if (along > 0.0 && along * along >= kLeastSquaredCosine * squared) return pixel;
  }
  return -1;
}

}  // namespace

PerimeterEvidence PerimeterProbe::probe(
    const GradientMap& map, const Ellipse& e, Polarity polarity, int samples, int tolerance_px) {
  hits_.clear();
  PerimeterEvidence evidence;
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d across(-axis.y(), axis.x());
  const double sign = static_cast<int>(polarity);  // dark inside: the gradient points outwards
  const int margin = GradientMap::kBorder + tolerance_px;
  const double spacing = 2.0 * std::numbers::pi / samples;
  double total_px = 0.0;
  double hit_px = 0.0;
  double inside_turn = 0.0;
  double hit_turn = 0.0;
  double gradients = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector2d& u =
        circle_points()[static_cast<std::size_t>(i * (kMostSamples / samples))];
    const Eigen::Vector2d foot =
        e.center() + e.semi_major * u.x() * axis + e.semi_minor * u.y() * across;
    Eigen::Vector2d normal = e.semi_minor * u.x() * axis + e.semi_major * u.y() * across;
    const double speed = normal.norm();
    normal /= speed;
    const double length = speed * spacing;
    total_px += length;
    const double x = foot.x() + 0.5;
    const double y = foot.y() + 0.5;
    if (!(x >= margin && y >= margin && x < map.width() - margin && y < map.height() - margin)) {
      continue;
    }
    evidence.inside_px += length;
    const double turn = 1.0 / (speed * speed);  // curvature times length, but for a factor
    inside_turn += turn;
    const bool is_flat = std::abs(normal.x()) > std::abs(normal.y());
    const Crossing crossing{static_cast<int>(y) * map.stride() + static_cast<int>(x),
                            is_flat ? 1 : map.stride()};
    const std::int32_t pixel = nearest_edge(map, crossing, sign * normal, tolerance_px);
    if (pixel < 0) continue;

    const Gradient& g = map.gradients()[pixel];
    const CrestPoint crest = crest_point(map, pixel);
    const double curvature = e.semi_major * e.semi_minor / (speed * speed * speed);
    const Eigen::Vector2d edge = crest.point + kCrestShift * curvature * normal;
    EdgeHit hit{edge, foot, normal, 0.0, 0.0, length, i};
    hit.residual_px = normal.dot(edge - foot);
    const double strength =
        std::sqrt(static_cast<double>(g.x) * g.x + static_cast<double>(g.y) * g.y);
    const double sine = sign * (g.y * normal.x() - g.x * normal.y()) / strength;
    hit.direction_error_rad = sine * (1.0 + sine * sine / 6.0);  // below 30 degrees within .003
    hits_.push_back(hit);
    hit_px += length;
    hit_turn += turn;
    gradients += strength;
    evidence.sharpness += crest.sharpness;
    for (std::size_t k = 0; k < kDistanceLevels.size(); ++k) {
      if (std::abs(hit.residual_px) < kDistanceLevels[k] &&
          std::abs(hit.direction_error_rad) < kDirectionLevels[k]) {
        evidence.levels[k] += length;
      }
    }
  }
  if (!(evidence.inside_px > 0.0)) return evidence;
  evidence.inside_fraction = evidence.inside_px / total_px;
  evidence.support = hit_px / evidence.inside_px;
  evidence.turn_support = hit_turn / inside_turn;
  for (double& level : evidence.levels) level /= evidence.inside_px;
  if (hits_.empty()) return evidence;
  const auto hits = static_cast<double>(hits_.size());
  evidence.signal_to_noise = gradients / hits / map.noise();
  evidence.sharpness /= hits;
  return evidence;
}

}  // namespace ellipse
