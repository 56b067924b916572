// SPDX-License-Identifier: MIT
#include "core/edges/perimeter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

constexpr float kMinSquaredCosine = 0.75F;  // 30 degrees
constexpr auto kShift = static_cast<float>(kMaximumShift);

template <class T>
using PerSample = std::array<T, PerimeterProbe::kMaxSamples>;

// Cosines and sines of evenly spaced eccentric anomalies.
struct Circle {
  PerSample<float> x;
  PerSample<float> y;
};

Circle make_circle(std::size_t samples) {
  Circle circle{};
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / double(samples);
    circle.x[i] = static_cast<float>(std::cos(t));
    circle.y[i] = static_cast<float>(std::sin(t));
  }
  return circle;
}

const Circle& circle_of(int samples) {
  static const std::array<Circle, 4> kCircles = {
      make_circle(32), make_circle(64), make_circle(128), make_circle(256)};
  return kCircles[samples <= 32 ? 0 : samples <= 64 ? 1 : samples <= 128 ? 2 : 3];
}

// Samples around a perimeter. Coordinates are relative to the pixel next to the ellipse's centre.
class OutlineSamples {
 public:
  OutlineSamples(const GradientMap& map, const Ellipse& e, int samples, int tolerance_px)
      : circle_(circle_of(samples)),
        origin_x_(static_cast<int>(std::lround(e.cx))),
        origin_y_(static_cast<int>(std::lround(e.cy))),
        stride_(map.stride()) {
    const auto ux = static_cast<float>(std::cos(e.angle_rad));
    const auto uy = static_cast<float>(std::sin(e.angle_rad));
    const auto a = static_cast<float>(e.semi_major);
    const auto b = static_cast<float>(e.semi_minor);
    const auto cx = static_cast<float>(e.cx - origin_x_);
    const auto cy = static_cast<float>(e.cy - origin_y_);
    for (int i = 0; i < samples; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const float c = circle_.x[k];
      const float s = circle_.y[k];
      x[k] = cx + a * c * ux - b * s * uy;
      y[k] = cy + a * c * uy + b * s * ux;
      const float normal_x = b * c * ux - a * s * uy;
      const float normal_y = b * c * uy + a * s * ux;
      speed[k] = std::sqrt(normal_x * normal_x + normal_y * normal_y);
      nx[k] = normal_x / speed[k];
      ny[k] = normal_y / speed[k];
    }
    if (map.lens().is_distorted()) distort(map.lens(), static_cast<std::size_t>(samples));
    const int margin = GradientMap::kBorder + tolerance_px;
    left_ = margin - origin_x_;
    top_ = margin - origin_y_;
    inside_width_ = static_cast<unsigned>(std::max(0, map.width() - 2 * margin));
    inside_height_ = static_cast<unsigned>(std::max(0, map.height() - 2 * margin));
  }

  // The pixel nearest to a sample, from the origin.
  [[nodiscard]] Eigen::Vector2i nearest(std::size_t k) const {
    return {static_cast<int>(std::lrint(x[k])), static_cast<int>(std::lrint(y[k]))};
  }
  [[nodiscard]] bool is_inside(const Eigen::Vector2i& pixel) const {
    return static_cast<unsigned>(pixel.x() - left_) < inside_width_ &&
           static_cast<unsigned>(pixel.y() - top_) < inside_height_;
  }
  [[nodiscard]] std::int32_t index_of(const Eigen::Vector2i& pixel) const {
    return (pixel.y() + origin_y_) * stride_ + pixel.x() + origin_x_;
  }
  [[nodiscard]] int stride() const { return stride_; }
  // Whether the normal is closer to the row than to the column.
  [[nodiscard]] bool is_flat(std::size_t k) const { return std::abs(nx[k]) > std::abs(ny[k]); }
  [[nodiscard]] Eigen::Vector2d anomaly(std::size_t k) const {
    return {circle_.x[k], circle_.y[k]};
  }

  // Pixels of the picture per pixel of the ideal plane, across the perimeter.
  [[nodiscard]] float px_per_ideal(std::size_t k) const {
    return is_distorted_ ? px_per_ideal_[k] : 1.0F;
  }
  // Length per eccentric anomaly in the ideal plane.
  [[nodiscard]] float ideal_speed(std::size_t k) const {
    return is_distorted_ ? ideal_speed_[k] : speed[k];
  }

  PerSample<float> x;
  PerSample<float> y;
  PerSample<float> nx;  // the normal, outwards
  PerSample<float> ny;
  PerSample<float> speed;  // length per eccentric anomaly

 private:
  // From the ideal plane to the picture.
  void distort(const LensView& lens, std::size_t samples) {
    is_distorted_ = true;
    PerSample<float> along;
    lens.distort(
        Eigen::Vector2d(origin_x_, origin_y_),
        {samples, x.data(), y.data(), nx.data(), ny.data(), px_per_ideal_.data(), along.data()});
    for (std::size_t k = 0; k < samples; ++k) {
      ideal_speed_[k] = speed[k];
      speed[k] *= along[k];
    }
  }

  bool is_distorted_ = false;
  PerSample<float> ideal_speed_;
  PerSample<float> px_per_ideal_;
  const Circle& circle_;
  int origin_x_;
  int origin_y_;
  int stride_;
  int left_ = 0;
  int top_ = 0;
  unsigned inside_width_ = 0;
  unsigned inside_height_ = 0;
};

constexpr int kNone = 1000;

// How many steps away from a pixel the nearest chained gradient maximum is whose gradient agrees
// with the normal (nx, ny) from dark to bright; kNone where none is.
int nearest_edge(const std::uint8_t* maxima,
                 const Gradient* gradients,
                 std::ptrdiff_t step,
                 float nx,
                 float ny,
                 int tolerance_px) {
  for (int k = 0; k <= 2 * tolerance_px; ++k) {
    const int offset = (k & 1) != 0 ? (k + 1) / 2 : -(k / 2);
    if ((maxima[offset * step] & maximum::kChained) == 0) continue;
    const Gradient& g = gradients[offset * step];
    const float gx = g.x;
    const float gy = g.y;
    const float along = gx * nx + gy * ny;
    if (along > 0.0F && along * along >= kMinSquaredCosine * (gx * gx + gy * gy)) return offset;
  }
  return kNone;
}

// The edge of a sample.
struct MatchedEdge {
  float residual_px;
  float direction_error_rad;
  float strength;
  float sharpness;
};

// @param here    The gradient of the edge's pixel, `offset` steps beside the sample.
// @param sign    1 where the inside is dark, else -1.
// @param axes    Product of the semi-axes [px^2 of the ideal plane].
MatchedEdge match_edge(const OutlineSamples& outline,
                       std::size_t k,
                       const Gradient* here,
                       int offset,
                       float sign,
                       float axes) {
  const bool is_flat = outline.is_flat(k);
  const float nx = outline.nx[k];
  const float ny = outline.ny[k];
  const float speed = outline.speed[k];
  const SubpixelMaximum vertex = subpixel_maximum(here, is_flat ? 1 : outline.stride());
  const Eigen::Vector2i pixel = outline.nearest(k);
  const float along = static_cast<float>(offset) + vertex.offset_px;
  const float dx = static_cast<float>(pixel.x()) + (is_flat ? along : 0.0F) - outline.x[k];
  const float dy = static_cast<float>(pixel.y()) + (is_flat ? 0.0F : along) - outline.y[k];
  const float gx = here->x;
  const float gy = here->y;
  const float strength = std::sqrt(gx * gx + gy * gy);
  const float sine = sign * (gy * nx - gx * ny) / strength;
  const float curvature = axes / (speed * speed) / outline.ideal_speed(k) * outline.px_per_ideal(k);
  // Beside its foot the perimeter falls back behind its tangent.
  const float aside = dy * nx - dx * ny;
  return {dx * nx + dy * ny + curvature * (0.5F * aside * aside + kShift),
          sine * (1.0F + sine * sine / 6.0F),  // below 30 degrees within .003
          strength,
          vertex.sharpness};
}

// Sums around a perimeter; lengths per eccentric anomaly.
struct Tally {
  float total = 0.0F;
  float inside = 0.0F;
  float matched = 0.0F;
  float inside_turn = 0.0F;  // curvature x length, but for a factor
  float matched_turn = 0.0F;
  float gradients = 0.0F;
  float sharpness = 0.0F;
  std::array<float, 4> levels{};

  void add_inside(float speed) {
    inside += speed;
    inside_turn += 1.0F / (speed * speed);
  }

  void add_matched(const MatchedEdge& edge, float speed) {
    matched += speed;
    matched_turn += 1.0F / (speed * speed);
    gradients += edge.strength;
    sharpness += edge.sharpness;
    for (std::size_t l = 0; l < levels.size(); ++l) {
      const bool is_within =
          std::abs(edge.residual_px) < static_cast<float>(kDistanceLevels[l]) &&
          std::abs(edge.direction_error_rad) < static_cast<float>(kDirectionLevels[l]);
      levels[l] += is_within ? speed : 0.0F;
    }
  }

  [[nodiscard]] PerimeterEvidence evidence(float spacing, std::size_t hits, double noise) const {
    PerimeterEvidence evidence;
    if (!(inside > 0.0F)) return evidence;
    evidence.inside_px = inside * spacing;
    evidence.inside_fraction = inside / total;
    evidence.support = matched / inside;
    evidence.turn_support = matched_turn / inside_turn;
    for (std::size_t l = 0; l < levels.size(); ++l) evidence.levels[l] = levels[l] / inside;
    if (hits == 0) return evidence;
    const auto count = static_cast<double>(hits);
    evidence.signal_to_noise = gradients / count / noise;
    evidence.sharpness = sharpness / count;
    return evidence;
  }
};

}  // namespace

double perimeter_support(const GradientMap& map,
                         const Ellipse& e,
                         Polarity polarity,
                         int samples,
                         int tolerance_px,
                         double least) {
  const OutlineSamples outline(map, e, samples, tolerance_px);
  const auto sign = static_cast<float>(polarity);  // dark inside: the gradient points outwards
  float inside = 0.0F;
  float matched = 0.0F;
  // Every other sample first: where these match less than half of what is wanted, the rest is
  // skipped.
  for (const std::size_t first : {0U, 1U}) {
    for (std::size_t k = first; k < static_cast<std::size_t>(samples); k += 2) {
      const Eigen::Vector2i pixel = outline.nearest(k);
      if (!outline.is_inside(pixel)) continue;
      inside += outline.speed[k];
      const std::int32_t at = outline.index_of(pixel);
      const std::ptrdiff_t step = outline.is_flat(k) ? 1 : map.stride();
      const int offset = nearest_edge(map.maxima() + at,
                                      map.gradients() + at,
                                      step,
                                      sign * outline.nx[k],
                                      sign * outline.ny[k],
                                      tolerance_px);
      if (offset != kNone) matched += outline.speed[k];
    }
    if (matched < 0.5F * static_cast<float>(least) * inside) break;
  }
  return inside > 0.0F ? static_cast<double>(matched / inside) : 0.0;
}

PerimeterEvidence PerimeterProbe::probe(
    const GradientMap& map, const Ellipse& e, Polarity polarity, int samples, int tolerance_px) {
  hits_.clear();
  const OutlineSamples outline(map, e, samples, tolerance_px);
  const auto sign = static_cast<float>(polarity);
  const auto spacing = static_cast<float>(2.0 * std::numbers::pi / samples);
  const auto axes_product = static_cast<float>(e.semi_major * e.semi_minor);
  const auto cx = static_cast<float>(e.cx - std::round(e.cx));
  const auto cy = static_cast<float>(e.cy - std::round(e.cy));
  Tally tally;
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples); ++k) {
    const float speed = outline.speed[k];
    tally.total += speed;
    const Eigen::Vector2i pixel = outline.nearest(k);
    if (!outline.is_inside(pixel)) continue;
    tally.add_inside(speed);
    const float nx = outline.nx[k];
    const float ny = outline.ny[k];
    const std::ptrdiff_t step = outline.is_flat(k) ? 1 : map.stride();
    const Gradient* here = map.gradients() + outline.index_of(pixel);
    const int offset = nearest_edge(
        map.maxima() + outline.index_of(pixel), here, step, sign * nx, sign * ny, tolerance_px);
    if (offset == kNone) continue;
    const MatchedEdge edge =
        match_edge(outline, k, here + offset * step, offset, sign, axes_product);
    tally.add_matched(edge, speed);
    hits_.push_back({static_cast<int>(k),
                     {outline.x[k] - cx, outline.y[k] - cy},
                     {nx, ny},
                     {outline.anomaly(k),
                      axes_product / outline.ideal_speed(k) * outline.px_per_ideal(k),
                      edge.residual_px},
                     edge.direction_error_rad,
                     speed * spacing});
  }
  return tally.evidence(spacing, hits_.size(), map.noise());
}

}  // namespace ellipse
