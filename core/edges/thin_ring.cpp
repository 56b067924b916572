// SPDX-License-Identifier: MIT
#include "core/edges/thin_ring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/edges/blurred_bar.hpp"
#include "core/edges/noise.hpp"

namespace ellipse {
namespace {

constexpr double kMinRingRatio = 0.25;  // a smaller disc inside is a pattern, not the inner edge
constexpr double kBlurBiasShare = 0.2;  // sigma of the correction, share of it

using PerDirection = std::array<double, kBarDirections>;

// Distances of an ellipse's tangents from a point.
PerDirection tangents(const Ellipse& e, const Eigen::Vector2d& from) {
  const Eigen::Matrix2d shape = shape_matrix(e);
  PerDirection distances;
  for (std::size_t i = 0; i < kBarDirections; ++i) {
    const Eigen::Vector2d normal = bar_normals()[i];
    distances[i] = normal.dot(e.center() - from) + std::sqrt(normal.dot(shape * normal));
  }
  return distances;
}

// The ellipse with tangents at these distances, by least squares. The n directions are evenly
// spread, so that their sum of d d^T (d^T Q d) is n / 8 (tr(Q) I + 2 Q).
std::optional<Ellipse> ellipse_of(const PerDirection& tangents, const Eigen::Vector2d& from) {
  Eigen::Vector2d center(0.0, 0.0);
  for (std::size_t i = 0; i < kBarDirections; ++i) {
    center += 2.0 / kBarDirections * tangents[i] * bar_normals()[i];
  }
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < kBarDirections; ++i) {
    const Eigen::Vector2d normal = bar_normals()[i];
    sum += std::pow(tangents[i] - normal.dot(center), 2) * normal * normal.transpose();
  }
  sum *= 4.0 / kBarDirections;
  return from_shape(from + center, sum - 0.25 * sum.trace() * Eigen::Matrix2d::Identity());
}

// Zero of a function that falls from one end to the other, or the end nearer to it. False position
// method; an end that stays counts half [DowellJarratt1971].
template <class Function>
double falling_zero(double low, double high, double tolerance, const Function& f) {
  double at_low = f(low);
  if (!(at_low > 0.0)) return low;
  double at_high = f(high);
  if (!(at_high < 0.0)) return high;
  double last = low;
  int side = 0;
  for (int step = 0; step < 30; ++step) {
    const double x = std::lerp(low, high, at_low / (at_low - at_high));
    if (std::abs(x - last) < tolerance) return x;
    last = x;
    const double at_x = f(x);
    const int next = at_x > 0.0 ? 1 : -1;
    if (next > 0) {
      low = x;
      at_low = at_x;
      if (side == next) at_high *= 0.5;
    } else {
      high = x;
      at_high = at_x;
      if (side == next) at_low *= 0.5;
    }
    side = next;
  }
  return last;
}

double mean_of(const PerDirection& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / kBarDirections;
}

// The middle line of a ring's gradient maxima, and the gaps between them.
class MiddleLine {
 public:
  explicit MiddleLine(const RingEdges& maxima)
      : center_(0.5 * (maxima.outer.center() + maxima.inner.center())) {
    const Eigen::Vector2d apart = maxima.outer.center() - maxima.inner.center();
    const PerDirection outer = tangents(maxima.outer, center_);
    const PerDirection inner = tangents(maxima.inner, center_);
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      radii_px_[i] = 0.5 * (outer[i] + inner[i]);
      gaps_px_[i] = outer[i] - inner[i];
      nearer_px_[i] = apart.dot(bar_normals()[i]);
    }
  }

  [[nodiscard]] double min_gap_px() const {
    return *std::min_element(gaps_px_.begin(), gaps_px_.end());
  }

  // Width of the ring over its radius; the predicted gaps grow with it.
  [[nodiscard]] double width(const BlurredBars& bars) const {
    if (min_gap_px() > bars.widest_px()) return mean_of(gaps_px_) / mean_of(radii_px_);
    return width_by(0, 1, bars);
  }

  // The same in the directions closest to the normal of a motion, which does not blur them.
  [[nodiscard]] double width_across(const Eigen::Vector2d& motion, const BlurredBars& bars) const {
    std::size_t across = 0;
    for (std::size_t i = 1; i < kBarDirections / 2; ++i) {
      const bool is_closer =
          std::abs(motion.dot(bar_normals()[i])) < std::abs(motion.dot(bar_normals()[across]));
      if (is_closer) across = i;
    }
    return width_by(across, kBarDirections / 2, bars);
  }

  // Whether gap and sharpness show the width. Bars thinner than the gap of a bar without width,
  // two standard deviations of the blur, all have nearly the same product of squared gap and
  // sharpness.
  [[nodiscard]] bool shows_width(double width, const BlurredBars& bars) const {
    return width * mean_of(radii_px_) >= bars.maxima(0.0, 0).distance_px;
  }

  // Mean sharpness of the edges of a ring of this width.
  [[nodiscard]] double sharpness(const BlurredBars& bars, double width) const {
    PerDirection sharpness;
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      sharpness[i] = bars.maxima(width_px(width, i), i).sharpness;
    }
    return mean_of(sharpness);
  }

  // The defocus of a ring with these gaps: the more there is, the less sharp are its edges.
  [[nodiscard]] double defocus_at(double sharpness) const {
    return falling_zero(0.0, BlurredBars::max_defocus(), 1e-3, [&](double defocus) {
      const BlurredBars bars(defocus);
      return this->sharpness(bars, width(bars)) - sharpness;
    });
  }

  // The defocus at which the maxima of a ring of this width are as far apart as measured.
  [[nodiscard]] double defocus_of(double width) const {
    return falling_zero(0.0, BlurredBars::max_defocus(), 1e-3, [&](double defocus) {
      const BlurredBars bars(defocus);
      double too_far_px = 0.0;
      for (std::size_t i = 0; i < kBarDirections; ++i) {
        too_far_px += gaps_px_[i] - bars.maxima(width_px(width, i), i).distance_px;
      }
      return too_far_px;
    });
  }

  // The ring of this width.
  [[nodiscard]] RingEdges edges(const RingEdges& maxima, double width) const {
    PerDirection widths_px;
    for (std::size_t i = 0; i < kBarDirections; ++i) widths_px[i] = width_px(width, i);
    return edges_at(maxima, widths_px);
  }

  // The same by the share of each gap that such a ring fills: wide ones stay in place.
  [[nodiscard]] RingEdges edges(const RingEdges& maxima,
                                double width,
                                const BlurredBars& bars) const {
    PerDirection widths_px;
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      const double px = width_px(width, i);
      widths_px[i] = gaps_px_[i] * px / bars.maxima(px, i).distance_px;
    }
    return edges_at(maxima, widths_px);
  }

 private:
  [[nodiscard]] double width_by(std::size_t first,
                                std::size_t step,
                                const BlurredBars& bars) const {
    double gaps_px = 0.0;
    double radii_px = 0.0;
    for (std::size_t i = first; i < kBarDirections; i += step) {
      gaps_px += gaps_px_[i];
      radii_px += radii_px_[i];
    }
    return falling_zero(0.0, gaps_px / radii_px, 1e-5, [&](double width) {
      double predicted_px = 0.0;
      for (std::size_t i = first; i < kBarDirections; i += step) {
        predicted_px += bars.maxima(width_px(width, i), i).distance_px;
      }
      return gaps_px - predicted_px;
    });
  }

  // Perspective makes the near side wider than the far side: the centres of the edges are apart.
  [[nodiscard]] double width_px(double width, std::size_t i) const {
    return std::max(0.0, width * radii_px_[i] + nearer_px_[i]);
  }

  [[nodiscard]] RingEdges edges_at(const RingEdges& maxima, const PerDirection& widths_px) const {
    PerDirection outer;
    PerDirection inner;
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      outer[i] = radii_px_[i] + 0.5 * widths_px[i];
      inner[i] = radii_px_[i] - 0.5 * widths_px[i];
    }
    return {ellipse_of(outer, center_).value_or(maxima.outer),
            ellipse_of(inner, center_).value_or(maxima.inner)};
  }

  Eigen::Vector2d center_;
  PerDirection radii_px_;
  PerDirection gaps_px_;
  PerDirection nearer_px_;  // difference of the width to that without perspective
};

// Width of a ring over the radius of its middle line.
double width_of(double ratio) {
  return 2.0 * (1.0 - ratio) / (1.0 + ratio);
}

// The width of a ring that may be thinner; thin ones have less contrast. RMS distance from the
// upper end for a density that is 0 at the lower end and grows linearly.
Estimate width_up_to(double width, double thinnest) {
  return {width, (width - thinnest) / std::sqrt(6.0)};
}

}  // namespace

double min_maxima_distance() {
  return BlurredBars(0.0).maxima(0.0, 0).distance_px;
}

// The blur's standard deviation is in proportion to the square root of the inverse sharpness.
bool is_thin(const RingEdges& maxima, double sharpness) {
  const BlurredBars bars(0.0);
  const double sharp = bars.maxima(bars.widest_px(), 0).sharpness;
  return MiddleLine(maxima).min_gap_px() <= bars.widest_px() * std::sqrt(sharp / sharpness);
}

RingEdges without_motion_blur(const RingEdges& maxima, const Eigen::Vector2d& blur_px) {
  const MiddleLine middle(maxima);
  const BlurredBars bars(0.0);
  const double width = middle.width_across(blur_px, bars);
  const double width_px = width * maxima.outer.semi_minor;
  return width_px > blur_px.norm() + bars.widest_px() ? maxima : middle.edges(maxima, width);
}

UnblurredRing without_blur_bias(const RingEdges& maxima,
                                const Estimate& sharpness,
                                std::optional<double> known_ratio) {
  const MiddleLine middle(maxima);
  if (!(middle.min_gap_px() > 0.0)) return {maxima, 0.0, {}};
  const double error = kUnlikelySigmas * sharpness.sigma;
  const double min_defocus = middle.defocus_at(sharpness.value + error);
  BlurredBars bars(min_defocus);
  double widest = middle.width(bars);
  if (middle.min_gap_px() > bars.widest_px()) return {maxima, 0.0, {widest}};
  const BlurredBars at_max_defocus(middle.defocus_at(sharpness.value - error));
  double thinnest = std::min(widest, middle.width(at_max_defocus));
  // Out of focus, a ring whose width does not show may be as thin as a line.
  if (min_defocus > 0.0 && !middle.shows_width(thinnest, at_max_defocus)) thinnest = 0.0;
  if (widest == 0.0) {
    // Edges that are less sharp than those of any ring have another edge beside them. The ring is
    // at most as wide as in focus. Its edges are corrected for the blur that they show: without it
    // the uncertainty of the scene bullseye is too small.
    widest = middle.width(BlurredBars(0.0));
  }
  Estimate width = width_up_to(widest, thinnest);
  if (known_ratio) {
    const double known = width_of(*known_ratio);
    width.value = std::clamp(known, thinnest, widest);
    width.sigma = std::abs(known - width.value);
    bars = BlurredBars(middle.defocus_of(width.value));
  }
  const RingEdges edges = middle.edges(maxima, width.value, bars);
  return {edges, kBlurBiasShare * max_difference_px(edges.outer, maxima.outer), width};
}

bool are_partners(const Ellipse& a, const Ellipse& b) {
  const double larger = std::max(a.semi_major, b.semi_major);
  const double ratio = std::min(a.semi_major, b.semi_major) / larger;
  return ratio >= kMinRingRatio && ratio <= kMaxRingRatio && are_concentric(a, b);
}

}  // namespace ellipse
