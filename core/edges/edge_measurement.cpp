// SPDX-License-Identifier: MIT
#include "core/edges/edge_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/edges/noise.hpp"

namespace ellipse {
namespace {

constexpr int kReachOnPicture = 2;  // pixels to each side

// A gradient maximum near a sample, on the pixel row or column closest to the normal.
struct FoundMaximum {
  Eigen::Vector2f gradient;
  float along_px;  // from the sample's pixel
  float sharpness;
  float sigma_px = 0.0F;
};

// The outward normal of an outline, and the sign of the gradients along it.
class SignedNormal {
 public:
  SignedNormal(const Eigen::Vector2f& normal, Polarity polarity)
      : normal_(normal), sign_(static_cast<float>(polarity)) {}

  // The gradient along the normal: positive if its sign is right.
  [[nodiscard]] float component(const Gradient& g) const {
    const float along =
        static_cast<float>(g.x) * normal_.x() + static_cast<float>(g.y) * normal_.y();
    return sign_ == 0.0F ? std::abs(along) : sign_ * along;
  }

  // Whether a gradient is within 30 degrees of the normal, and its sign is right.
  [[nodiscard]] bool agrees(const Gradient& g) const {
    const float along = component(g);
    const float gx = g.x;
    const float gy = g.y;
    return along > 0.0F && along * along >= kMinSquaredCosine * (gx * gx + gy * gy);
  }

 private:
  Eigen::Vector2f normal_;
  float sign_;  // 1: outwards, -1: inwards, 0: either
};

// @param offset  From the sample's pixel to the maximum's, in steps.
FoundMaximum maximum_at(const Gradient* here, std::ptrdiff_t step, std::ptrdiff_t offset) {
  const SubpixelMaximum vertex = subpixel_maximum(here, static_cast<int>(step));
  return {{here->x, here->y}, static_cast<float>(offset) + vertex.offset_px, vertex.sharpness};
}

// Propagation of errors gives the variance of a parabola's vertex -b / 2c, with b = h(1) - h(-1)
// and c = h(-1) - 2 h(0) + h(1), as (var b / 4 + offset^2 var c) / c^2. The kernels of GradientMap
// correlate the noise of neighbours by .4 along their difference and .8 along their smoothing, and
// of second neighbours by -.4 and .4. Offsets within a pixel have a mean square of 1/12. Selecting
// maxima favours noise that sharpens them, which raises the mean of c^2 by var c.
float vertex_variance(float noise, float cosine, float curvature) {
  const float along = cosine * cosine;
  const float var_c = 0.4F + 1.6F * along;
  const float variance = 0.3F + 0.4F * along + var_c / 12.0F;
  const float squared = curvature * curvature - noise * noise * var_c;
  return along * noise * noise * variance / std::max(1e-9F, squared);
}

// Of the angle between a normal and its row or column, whichever is closer.
float cosine_along(const Eigen::Vector2f& normal) {
  return normal.lpNorm<Eigen::Infinity>();
}

struct EdgePosition {
  Eigen::Vector2f point;  // from the outline's origin
  float distance_px;      // from the outline
};

// @param along_px  From the sample's pixel, along the row or column.
// @param variance  Of the blur along the edge.
EdgePosition position_of(const OutlineSamples& outline,
                         std::size_t k,
                         float along_px,
                         float variance) {
  const Eigen::Vector2f normal = outline.normal(k);
  Eigen::Vector2f from_sample = outline.nearest(k).cast<float>() - outline.point(k);
  from_sample[outline.is_along_row(k) ? 0 : 1] += along_px;
  // The outline curves away from its tangent to both sides of the sample.
  const float aside = from_sample.y() * normal.x() - from_sample.x() * normal.y();
  const float curvature = outline.curvature(k);
  return {outline.point(k) + from_sample + inward_shift(variance, curvature) * normal,
          from_sample.dot(normal) + 0.5F * curvature * (aside * aside + variance)};
}

EdgeMeasurement measured(const OutlineSamples& outline,
                         std::size_t k,
                         const FoundMaximum& maximum) {
  const Eigen::Vector2f normal = outline.normal(k);
  const auto [point, distance_px] = position_of(outline, k, maximum.along_px, kSharpVariance);
  const Eigen::Vector2f& gradient = maximum.gradient;
  const float contrast = gradient.norm();
  const float across = gradient.y() * normal.x() - gradient.x() * normal.y();
  const bool is_bright_inside = gradient.dot(normal) < 0.0F;
  const float sine = (is_bright_inside ? -across : across) / contrast;
  const float cosine = cosine_along(normal);
  return {static_cast<int>(k),
          point,
          normal,
          {outline.anomaly(k), outline.px_per_unit(k), distance_px},
          maximum.sigma_px,
          sine * (1.0F + sine * sine / 6.0F),  // arc sine, within .003 up to 30 degrees
          contrast,
          maximum.sharpness / (cosine * cosine),
          outline.length_px(k),
          outline.turn(k),
          outline.px_per_ideal(k),
          is_bright_inside};
}

// The pixels whose search stays inside the picture: a rectangle relative to an outline's origin.
class SearchableArea {
 public:
  SearchableArea(int width, int height, int margin, const Eigen::Vector2i& origin)
      : left_(margin - origin.x()),
        top_(margin - origin.y()),
        width_(static_cast<unsigned>(std::max(0, width - 2 * margin))),
        height_(static_cast<unsigned>(std::max(0, height - 2 * margin))) {}

  [[nodiscard]] bool has(const Eigen::Vector2i& pixel) const {
    return static_cast<unsigned>(pixel.x() - left_) < width_ &&
           static_cast<unsigned>(pixel.y() - top_) < height_;
  }

 private:
  int left_;
  int top_;
  unsigned width_;
  unsigned height_;
};

// Finds the nearest chained gradient maximum in a map, alternating between both sides.
class MapSearch {
 public:
  MapSearch(const GradientMap& map, const Eigen::Vector2i& origin, int reach_px)
      : area(map.width(), map.height(), GradientMap::kBorder + reach_px, origin),
        maxima_(map.maxima()),
        gradients_(map.gradients()),
        stride_(map.stride()),
        origin_(origin.y() * map.stride() + origin.x()),
        reach_(reach_px) {}

  [[nodiscard]] std::optional<FoundMaximum> find(const Eigen::Vector2i& pixel,
                                                 bool is_along_row,
                                                 const SignedNormal& normal) const {
    const std::ptrdiff_t step = is_along_row ? 1 : stride_;
    const std::ptrdiff_t at = origin_ + std::ptrdiff_t(pixel.y()) * stride_ + pixel.x();
    for (std::ptrdiff_t k = 0; k <= 2 * reach_; ++k) {
      const std::ptrdiff_t offset = (k & 1) != 0 ? (k + 1) / 2 : -(k / 2);
      const std::ptrdiff_t beside = at + offset * step;
      if ((maxima_[beside] & maximum::kChained) == 0) continue;
      if (!normal.agrees(gradients_[beside])) continue;
      return maximum_at(gradients_ + beside, step, offset);
    }
    return std::nullopt;
  }

  SearchableArea area;

 private:
  const std::uint8_t* maxima_;
  const Gradient* gradients_;
  std::ptrdiff_t stride_;
  std::ptrdiff_t origin_;
  std::ptrdiff_t reach_;
};

// Finds the highest gradient maximum on the picture.
class PictureSearch {
 public:
  PictureSearch(const ImageView& luma, const Eigen::Vector2i& origin, double min_gradient)
      : area(luma.width, luma.height, kReachOnPicture + 1 + GradientMap::kBorder, origin),
        luma_(luma),
        origin_(origin),
        min_gradient_(static_cast<float>(min_gradient)) {}

  [[nodiscard]] std::optional<FoundMaximum> find(const Eigen::Vector2i& pixel,
                                                 bool is_along_row,
                                                 const SignedNormal& normal) const {
    const int first = -kReachOnPicture - 1;
    const int x = pixel.x() + origin_.x() + (is_along_row ? first : 0);
    const int y = pixel.y() + origin_.y() + (is_along_row ? 0 : first);
    std::array<Gradient, 2 * kReachOnPicture + 3> line;
    gradients_along(luma_, x, y, is_along_row, line);
    const auto top = std::max_element(
        line.begin() + 1, line.end() - 1, [&](const Gradient& a, const Gradient& b) {
          return normal.component(a) < normal.component(b);
        });
    if (normal.component(*top) < min_gradient_ || !normal.agrees(*top)) return std::nullopt;
    const std::ptrdiff_t offset = top - line.begin();
    FoundMaximum found = maximum_at(&*top, 1, offset + first);
    if (!(found.sharpness > 0.0F)) return std::nullopt;
    // The pixel at the bright end of the kernels.
    const bool is_brighter_before = (is_along_row ? top->x : top->y) < 0;
    const int bright = static_cast<int>(offset) + (is_brighter_before ? -2 : 2);
    const std::uint8_t level = is_along_row ? luma_.row(y)[x + bright] : luma_.row(y + bright)[x];
    found.sigma_px = is_saturated(level) ? kPixelError : kVertexError;
    return found;
  }

  SearchableArea area;

 private:
  ImageView luma_;
  Eigen::Vector2i origin_;
  float min_gradient_;
};

// Centroid of the gradient along a normal, from a pixel on its row or column. nullopt if there is
// no gradient of the right sign.
// @param half_px  The line of pixels extends so far to both sides.
std::optional<float> centroid_along(const ImageView& luma,
                                    const Eigen::Vector2i& pixel,
                                    bool is_along_row,
                                    const SignedNormal& normal,
                                    int half_px) {
  float sum = 0.0F;
  float moment = 0.0F;
  for (int i = -half_px; i <= half_px; ++i) {
    std::array<Gradient, 1> gradient;
    const int x = pixel.x() + (is_along_row ? i : 0);
    const int y = pixel.y() + (is_along_row ? 0 : i);
    gradients_along(luma, x, y, is_along_row, gradient);
    const float height = std::max(0.0F, normal.component(gradient[0]));
    sum += height;
    moment += height * static_cast<float>(i);
  }
  return sum > 0.0F ? std::optional(moment / sum) : std::nullopt;
}

}  // namespace

double EdgeMeasurer::mean_contrast() const {
  double sum = 0.0;
  for (const EdgeMeasurement& edge : edges()) sum += edge.contrast;
  return count_ == 0 ? 0.0 : sum / static_cast<double>(count_);
}

// The sharpness of a Gaussian edge of variance v, by differences of pixels at c to its normal, is
// 1 / (v + c^2 / 3): to first order, and on average over positions within a pixel.
float EdgeMeasurer::defocus_variance() const {
  if (count_ < kMinEdgesOfEllipse) return 0.0F;
  float squared_cosines = 0.0F;
  for (const EdgeMeasurement& edge : edges()) {
    squared_cosines += std::pow(cosine_along(edge.normal), 2.0F);
  }
  const Estimate mean = sharpness();
  const auto sharpness = static_cast<float>(mean.value);
  const float variance = 1.0F / sharpness - squared_cosines / (3.0F * static_cast<float>(count_));
  const float sigma = static_cast<float>(mean.sigma) / (sharpness * sharpness);
  const float defocus = variance - kSharpVariance;
  return defocus > static_cast<float>(kAllSigmas) * sigma ? defocus : 0.0F;
}

Estimate EdgeMeasurer::sharpness() const {
  double sum = 0.0;
  double squares = 0.0;
  for (const EdgeMeasurement& edge : edges()) {
    sum += edge.sharpness;
    squares += std::pow(double{edge.sharpness}, 2);
  }
  const auto n = static_cast<double>(count_);
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

// Defocus moves curved edges farther inwards than measured() assumes.
void EdgeMeasurer::correct_curvature(const OutlineSamples& outline) {
  const float defocus = defocus_variance();
  if (defocus == 0.0F) return;
  for (std::size_t i = 0; i < count_; ++i) {
    EdgeMeasurement& edge = edges_[i];
    const auto k = static_cast<std::size_t>(edge.sample);
    const float shift =
        std::min(float{kReachOnPicture}, inward_shift(defocus, outline.curvature(k)));
    edge.point += shift * edge.normal;
    edge.offset.distance_px += shift;
  }
}

// Limits the variance to that of a uniform distribution over the reach, which chance matches
// follow. Uses the mean sharpness along the rows and columns, since that of a single edge is noisy.
void EdgeMeasurer::compute_sigmas(float noise, float reach_px) {
  const float of_chance = (reach_px + 0.5F) * (reach_px + 0.5F) / 3.0F;
  float sharpness = 0.0F;
  for (const EdgeMeasurement& edge : edges()) {
    const float cosine = cosine_along(edge.normal);
    sharpness += edge.sharpness * cosine * cosine;
  }
  sharpness /= static_cast<float>(std::max<std::size_t>(1, count_));
  for (std::size_t i = 0; i < count_; ++i) {
    EdgeMeasurement& edge = edges_[i];
    const float cosine = cosine_along(edge.normal);
    const float variance = vertex_variance(noise, cosine, edge.contrast * sharpness);
    edge.sigma_px = std::sqrt(std::min(of_chance, variance + kVertexError * kVertexError));
  }
}

// The standard deviation of the centroid of n pixels of equal noise grows as the root of the sum of
// their squared distances: as n^1.5.
void EdgeMeasurer::move_to_centroids(const Picture& picture,
                                     const OutlineSamples& outline,
                                     Polarity polarity) {
  const int sharp_px = kReachOnPicture + 1;
  for (std::size_t i = 0; i < count_; ++i) {
    EdgeMeasurement& edge = edges_[i];
    const auto k = static_cast<std::size_t>(edge.sample);
    const float across_px = std::abs(edge.normal.dot(motion_blur_.px));
    const float blurred_px = across_px / cosine_along(edge.normal);
    const int half_px = sharp_px + static_cast<int>(std::ceil(0.5F * blurred_px));
    edge.sigma_px *= std::pow((2.0F * half_px + 1.0F) / (2.0F * sharp_px + 1.0F), 1.5F);
    const SearchableArea area(
        picture.luma.width, picture.luma.height, half_px + GradientMap::kBorder, outline.origin());
    if (!area.has(outline.nearest(k))) continue;
    const auto along_px = centroid_along(picture.luma,
                                         outline.nearest(k) + outline.origin(),
                                         outline.is_along_row(k),
                                         {edge.normal, polarity},
                                         half_px);
    if (!along_px) continue;
    const float squared_along = motion_blur_.px.squaredNorm() - across_px * across_px;
    const auto [point, distance_px] =
        position_of(outline, k, *along_px, kSharpVariance + uniform_variance(squared_along));
    edge.point = point;
    edge.offset.distance_px = distance_px;
  }
}

template <class Search>
OutlineSupport EdgeMeasurer::measure_along(const OutlineSamples& outline,
                                           Polarity polarity,
                                           const Search& search) {
  count_ = 0;
  motion_blur_ = {};
  origin_ = outline.origin().cast<double>();
  float total = 0.0F;
  float total_turn = 0.0F;
  float inside = 0.0F;
  float inside_turn = 0.0F;
  float matched = 0.0F;
  float matched_turn = 0.0F;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const float length = outline.length_px(k);
    total += length;
    total_turn += outline.turn(k);
    const Eigen::Vector2i pixel = outline.nearest(k);
    if (!search.area.has(pixel)) continue;
    inside += length;
    inside_turn += outline.turn(k);
    const Eigen::Vector2f normal = outline.normal(k);
    const auto maximum = search.find(pixel, outline.is_along_row(k), {normal, polarity});
    if (!maximum) continue;
    matched += length;
    matched_turn += outline.turn(k);
    edges_[count_++] = measured(outline, k, *maximum);
  }
  if (!(inside > 0.0F)) return {};
  return {inside,
          inside / total,
          matched / inside,
          inside_turn / total_turn,
          matched_turn / inside_turn};
}

OutlineSupport EdgeMeasurer::measure(const GradientMap& map,
                                     const Ellipse& e,
                                     Polarity polarity,
                                     std::size_t samples,
                                     int reach_px) {
  const OutlineSamples outline(e, samples, map.lens());
  const MapSearch search(map, outline.origin(), reach_px);
  const OutlineSupport support = measure_along(outline, polarity, search);
  compute_sigmas(static_cast<float>(map.noise()), static_cast<float>(reach_px));
  return support;
}

OutlineSupport EdgeMeasurer::measure(const Picture& picture,
                                     const Ellipse& e,
                                     Polarity polarity,
                                     std::size_t samples,
                                     double min_gradient,
                                     const Eigen::Vector2f& motion_px) {
  const OutlineSamples outline(e, samples, picture.lens);
  const PictureSearch search(picture.luma, outline.origin(), min_gradient);
  const OutlineSupport support = measure_along(outline, polarity, search);
  motion_blur_ = ellipse::motion_blur(edges(), motion_px);
  if (motion_blur_.px.isZero()) {
    correct_curvature(outline);
  } else {
    move_to_centroids(picture, outline, polarity);
  }
  return support;
}

}  // namespace ellipse
