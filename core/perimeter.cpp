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

// One place on the perimeter, and the edge that was met there.
struct Place {
  Eigen::Vector2d foot;
  Eigen::Vector2d normal;
  double speed;        // length per eccentric anomaly
  bool is_inside;      // the picture
  std::int32_t pixel;  // of the edge; -1 where none was met
};

// Calls use(place, sample) all around an ellipse.
template <class Use>
void for_each_place(const GradientMap& map,
                    const Ellipse& e,
                    Polarity polarity,
                    int samples,
                    int tolerance_px,
                    const Use& use) {
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d across(-axis.y(), axis.x());
  const Eigen::Vector2d major = e.semi_major * axis;
  const Eigen::Vector2d minor = e.semi_minor * across;
  const Eigen::Vector2d slope_u = e.semi_minor * axis;
  const Eigen::Vector2d slope_v = e.semi_major * across;
  const double sign = static_cast<int>(polarity);  // dark inside: the gradient points outwards
  const int margin = GradientMap::kBorder + tolerance_px;
  const auto stride = static_cast<std::size_t>(PerimeterProbe::kMostSamples / samples);
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector2d& u = circle_points()[static_cast<std::size_t>(i) * stride];
    Place place{e.center() + u.x() * major + u.y() * minor,
                u.x() * slope_u + u.y() * slope_v,
                0.0,
                false,
                -1};
    place.speed = place.normal.norm();
    place.normal /= place.speed;
    const double x = place.foot.x() + 0.5;
    const double y = place.foot.y() + 0.5;
    place.is_inside =
        x >= margin && y >= margin && x < map.width() - margin && y < map.height() - margin;
    if (place.is_inside) {
      const bool is_flat = std::abs(place.normal.x()) > std::abs(place.normal.y());
      const Crossing crossing{static_cast<int>(y) * map.stride() + static_cast<int>(x),
                              is_flat ? 1 : map.stride()};
      place.pixel = nearest_edge(map, crossing, sign * place.normal, tolerance_px);
    }
    use(place, i);
  }
}

}  // namespace

double perimeter_support(
    const GradientMap& map, const Ellipse& e, Polarity polarity, int samples, int tolerance_px) {
  double inside = 0.0;
  double met = 0.0;
  for_each_place(map, e, polarity, samples, tolerance_px, [&](const Place& place, int /*sample*/) {
    inside += place.is_inside ? place.speed : 0.0;
    met += place.pixel >= 0 ? place.speed : 0.0;
  });
  return inside > 0.0 ? met / inside : 0.0;
}

PerimeterEvidence PerimeterProbe::probe(
    const GradientMap& map, const Ellipse& e, Polarity polarity, int samples, int tolerance_px) {
  hits_.clear();
  PerimeterEvidence evidence;
  const double sign = static_cast<int>(polarity);
  const double spacing = 2.0 * std::numbers::pi / samples;
  double total_px = 0.0;
  double hit_px = 0.0;
  double inside_turn = 0.0;
  double hit_turn = 0.0;
  double gradients = 0.0;
  const auto use = [&](const Place& place, int sample) {
    const double length = place.speed * spacing;
    const double turn = 1.0 / (place.speed * place.speed);  // curvature x length, but for a factor
    total_px += length;
    if (!place.is_inside) return;
    evidence.inside_px += length;
    inside_turn += turn;
    if (place.pixel < 0) return;

    const Gradient& g = map.gradients()[place.pixel];
    const Eigen::Vector2d& normal = place.normal;
    const CrestPoint crest = crest_point(map, place.pixel);
    const double curvature =
        e.semi_major * e.semi_minor / (place.speed * place.speed * place.speed);
    const Eigen::Vector2d edge = crest.point + kCrestShift * curvature * normal;
    EdgeHit hit{edge, place.foot, normal, 0.0, 0.0, length, sample};
    hit.residual_px = normal.dot(edge - place.foot);
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
  };
  for_each_place(map, e, polarity, samples, tolerance_px, use);
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
