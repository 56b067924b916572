// SPDX-License-Identifier: MIT
#include "core/tracking/pad/edge_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/edges/noise.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/tracking/pad/visible_part.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kMaxSteps = 24;  // to each side of the expected position
constexpr int kMaxBox = 3;     // max samples averaged on each side of an edge

// One value per pixel of the longest profile, and one more.
using PerPixel = std::array<float, 2 * (kMaxSteps + kMaxBox) + 4>;

// Pixel levels across an edge.
struct Profile {
  PerPixel sums;  // prefix sums of the levels
  std::size_t count = 0;
  std::size_t box = 1;
  float first = 0.0F;      // first pixel relative to the middle one [steps]
  float step_px = 0.0F;    // along the normal
  float middle_px = 0.0F;  // middle pixel relative to the expected edge, along the normal

  void read(const std::uint8_t* pixel, std::ptrdiff_t stride) {
    sums[0] = 0.0F;
    for (std::size_t i = 0; i < count; ++i, pixel += stride) {
      sums[i + 1] = sums[i] + static_cast<float>(*pixel);
    }
  }

  // Highest mean of a box from this position on, towards the bright side.
  [[nodiscard]] float brightest_from(std::size_t i) const {
    float sum = 0.0F;
    for (; i + box <= count; ++i) sum = std::max(sum, sums[i + box] - sums[i]);
    return sum / static_cast<float>(box);
  }
};

// Minimum contrast of an edge: less in shadow, where contrast falls with the light.
struct MinContrast {
  float noise = 0.0F;     // standard deviation
  float by_gain = 0.0F;   // of the image
  float relative = 0.0F;  // share of the light; 0 = unknown

  // Whether there is a light in which an edge of this contrast is accepted.
  [[nodiscard]] bool may_accept(float contrast) const {
    const bool is_noise = contrast < float{kAllSigmas} * noise;
    return contrast >= by_gain || (relative > 0.0F && !is_noise);
  }
  [[nodiscard]] bool accepts(const EdgeCandidate& edge) const {
    return edge.contrast >= by_gain || edge.contrast > relative * edge.light;
  }
};

// Keeps the strongest local maxima of the difference between the boxes after and before a position.
void keep_edges(const Profile& profile,
                const MinContrast& min,
                double reach_px,
                EdgeSample& sample) {
  const auto& sums = profile.sums;
  const std::size_t half = profile.box;
  const float scale = 1.0F / static_cast<float>(half);
  PerPixel rises;  // box differences between samples i - 1 and i
  for (std::size_t i = half; i + half <= profile.count; ++i) {
    rises[i] = (sums[i + half] - 2.0F * sums[i] + sums[i - half]) * scale;
  }
  const float min_rise = float{kUnlikelySigmas} * min.noise;
  for (std::size_t i = half + 1; i + half < profile.count; ++i) {
    const float here = rises[i];
    if (here < min_rise || rises[i - 1] > here || rises[i + 1] >= here) continue;
    const float vertex = parabola_vertex(rises[i - 1], here, rises[i + 1]);
    const float at = profile.first + static_cast<float>(i) - 0.5F + vertex;
    const float distance_px = at * profile.step_px + profile.middle_px;
    if (std::abs(distance_px) > reach_px || !min.may_accept(here)) continue;
    EdgeCandidate candidate{distance_px, here, profile.brightest_from(i)};
    if (!min.accepts(candidate)) continue;
    for (int k = 0; k < sample.count; ++k) {  // the strongest first
      EdgeCandidate& other = sample.candidates[static_cast<std::size_t>(k)];
      if (candidate.contrast > other.contrast) std::swap(candidate, other);
    }
    if (sample.count < static_cast<int>(sample.candidates.size())) {
      sample.candidates[static_cast<std::size_t>(sample.count++)] = candidate;
    }
  }
}

}  // namespace

void EdgeSearch::add(const Eigen::Matrix3d& view,
                     const Eigen::Vector2d& pad_point,
                     const Eigen::Vector2d& to_bright,
                     double contrast,
                     int feature) {
  const auto edge = view_of(view, pad_point, to_bright);
  if (!edge || samples_.size() >= kMaxSamples) return;
  EdgeSample& sample = samples_.emplace_back();
  sample.view = *edge;
  sample.contrast = static_cast<float>(contrast);
  sample.feature = feature;
}

struct EdgeSearch::Placement {
  const PadView& view;
  VisiblePart visible;
  double px_per_radius;
  double spacing_px = 0.0;

  [[nodiscard]] double step_px(const PadCircle& circle) const {
    return kTwoPi * circle.radius * px_per_radius / OutlineSamples::kMaxSamples;
  }
  [[nodiscard]] double length_px(const PadLine& line, const Interval& part) const {
    return part.length() * (line.to - line.from).norm() * px_per_radius;
  }
};

void EdgeSearch::sample(const PadModel& model, const PadView& view, const ImageView& luma) {
  samples_.clear();
  samples_.reserve(kMaxSamples);
  Placement placement{view, VisiblePart(view, luma), view.radius_px()};
  std::array<VisibleSteps, kMaxCircles> visible;
  const auto directions = circle_directions(OutlineSamples::kMaxSamples);
  double total_px = 0.0;
  const std::size_t circles = std::min(model.circles.size(), visible.size());
  narrowest_ = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < circles; ++c) {
    const PadCircle& circle = model.circles[c];
    const bool is_whole = placement.visible.has_circle(circle.radius);
    if (is_whole) visible[c].set();
    for (std::size_t i = 0; !is_whole && i < OutlineSamples::kMaxSamples; ++i) {
      visible[c][i] = placement.visible.has(circle.radius * directions[i].cast<double>());
    }
    const auto count = static_cast<double>(visible[c].count());
    total_px += count * placement.step_px(circle);
    if (c == 0) visible_fraction_ = count / OutlineSamples::kMaxSamples;
    if (c == 0) continue;
    narrowest_ = std::min(narrowest_, std::abs(model.circles[c - 1].radius - circle.radius));
  }
  for (const PadLine& line : model.lines) {
    total_px += placement.length_px(line, placement.visible.clip(line.from, line.to));
  }
  if (!(total_px > 0.0)) return;

  placement.spacing_px = std::max(1.0, total_px / kSamples);
  for (std::size_t c = 0; c < circles; ++c) {
    sample_circle(placement, model.circles[c], visible[c], static_cast<int>(c));
  }
  for (std::size_t l = 0; l < model.lines.size(); ++l) {
    sample_line(placement, model.lines[l], static_cast<int>(circles + l));
  }
  if (view.lens.is_distorted()) distort(view.lens);
}

void EdgeSearch::sample_circle(const Placement& placement,
                               const PadCircle& circle,
                               const VisibleSteps& visible,
                               int feature) {
  const double step_px = placement.step_px(circle);
  const double spacing_px = placement.spacing_px;
  const double sign = circle.is_bright_outside ? 1.0 : -1.0;
  const auto directions = circle_directions(OutlineSamples::kMaxSamples);
  double since_px = 0.5 * spacing_px;
  for (std::size_t i = 0; i < OutlineSamples::kMaxSamples; ++i) {
    if (!visible[i]) continue;
    since_px += step_px;
    if (since_px < spacing_px) continue;
    since_px = std::min(since_px - spacing_px, spacing_px);
    const Eigen::Vector2d outwards = directions[i].cast<double>();
    add(placement.view.ideal_from_pad,
        circle.radius * outwards,
        sign * outwards,
        circle.contrast,
        feature);
  }
}

void EdgeSearch::sample_line(const Placement& placement, const PadLine& line, int feature) {
  const Interval part = placement.visible.clip(line.from, line.to);
  const int count = static_cast<int>(placement.length_px(line, part) / placement.spacing_px);
  for (int i = 0; i < count; ++i) {
    const double at = part.begin + part.length() * (i + 0.5) / count;
    add(placement.view.ideal_from_pad,
        line.from + at * (line.to - line.from),
        line.to_bright,
        line.contrast,
        feature);
  }
}

// Maps all samples from the ideal plane to the distorted image.
void EdgeSearch::distort(const LensView& lens) {
  std::array<std::array<float, kMaxSamples>, 6> numbers;
  auto& [x, y, nx, ny, across, along] = numbers;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const EdgeView& view = samples_[i].view;
    x[i] = static_cast<float>(view.point.x());
    y[i] = static_cast<float>(view.point.y());
    nx[i] = static_cast<float>(view.normal.x());
    ny[i] = static_cast<float>(view.normal.y());
  }
  lens.distort(
      {0.0, 0.0},
      {samples_.size(), x.data(), y.data(), nx.data(), ny.data(), across.data(), along.data()});
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    EdgeView& view = samples_[i].view;
    view.point = {x[i], y[i]};
    view.normal = {nx[i], ny[i]};
    view.px_per_unit *= across[i];
    view.row *= across[i];
  }
}

void EdgeSearch::search(const ImageView& luma,
                        const ImageLevels& levels,
                        double reach_px,
                        const HomographyCovariance* covariance,
                        double max_px) {
  for (EdgeSample& sample : samples_) {
    double reach = reach_px;
    if (covariance != nullptr) {
      const double variance = variance_along(sample.view.row, *covariance);
      // Rounding may make the variance negative.
      reach = std::clamp(kAllSigmas * std::sqrt(std::max(0.0, variance)), reach_px, max_px);
    }
    search_along(luma, levels, reach, sample);
  }
}

namespace {

// Intersection of an edge with the pixel row or column closest to its normal.
struct Crossing {
  int axis;            // along which pixels are read
  int line;            // index of the row or column
  double position_px;  // along it
  double slope;        // distance from the edge per pixel along it
};

std::optional<Crossing> crossing_of(const EdgeView& view, const ImageView& luma) {
  const Eigen::Vector2d& normal = view.normal;
  const int axis = std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1;
  const int other = 1 - axis;
  const double slope = normal[axis];
  const Eigen::Array2i size(luma.width, luma.height);
  const double line = std::floor(view.point[other] + 0.5);
  if (!(line >= 0.0 && line < size[other])) return std::nullopt;
  const double crossing = view.point[axis] + normal[other] / slope * (view.point[other] - line);
  if (!(crossing >= 0.0 && crossing <= size[axis] - 1.0)) return std::nullopt;
  return Crossing{axis, static_cast<int>(line), crossing, slope};
}

// Sums of the levels across an edge: reads pixels along the row or column, which avoids
// interpolation.
// nullopt if the picture ends within a box of the edge.
// @param gap_px  Distance of the nearest other edge, which limits the box.
std::optional<Profile> profile_at(const Crossing& crossing,
                                  const ImageView& luma,
                                  double reach_px,
                                  double gap_px) {
  const auto& [axis, line, position, slope] = crossing;
  const int middle = static_cast<int>(std::floor(position + 0.5));
  const int end = axis == 0 ? luma.width : luma.height;
  const double reach = reach_px / std::abs(slope);
  const int step = std::max(1, static_cast<int>(std::ceil(reach / kMaxSteps)));
  const int steps = static_cast<int>(std::ceil(reach / step));
  const double step_px = step * std::abs(slope);
  const int box = static_cast<int>(std::clamp(0.5 * gap_px / step_px, 1.0, double(kMaxBox)));
  const bool is_forward = slope > 0.0;
  const int before = (is_forward ? middle : end - 1 - middle) / step;
  const int behind = (is_forward ? end - 1 - middle : middle) / step;
  const int first = -std::min(steps + box, before);
  const int last = std::min(steps + box, behind);
  if (first > -box || last < box) return std::nullopt;

  const std::ptrdiff_t along = axis == 0 ? 1 : luma.stride;
  const std::ptrdiff_t stride = (is_forward ? step : -step) * along;
  const std::uint8_t* pixel =
      luma.data + middle * along + line * (axis == 0 ? luma.stride : 1) + first * stride;
  std::optional<Profile> profile(std::in_place);
  profile->count = static_cast<std::size_t>(last - first) + 1;
  profile->box = static_cast<std::size_t>(box);
  profile->first = static_cast<float>(first);
  profile->step_px = static_cast<float>(step_px);
  profile->middle_px = static_cast<float>(slope * (middle - position));
  profile->read(pixel, stride);
  return profile;
}

}  // namespace

// The differences of neighbouring boxes are positive from dark to bright.
void EdgeSearch::search_along(const ImageView& luma,
                              const ImageLevels& levels,
                              double reach_px,
                              EdgeSample& sample) const {
  const double gap_px = narrowest_ * sample.view.px_per_unit;
  const auto crossing = crossing_of(sample.view, luma);
  const auto profile = crossing ? profile_at(*crossing, luma, reach_px, gap_px) : std::nullopt;
  sample.count = 0;
  sample.is_visible = profile.has_value();
  if (!profile) return;
  // Of the difference between the means of two boxes.
  const double noise = levels.noise * std::sqrt(2.0 / static_cast<double>(profile->box));
  const double contrast = kMajority * sample.contrast;
  const MinContrast min{static_cast<float>(noise),
                        static_cast<float>(levels.gain * contrast),
                        static_cast<float>(levels.relative_gain * contrast)};
  keep_edges(*profile, min, reach_px, sample);
}

}  // namespace ellipse
