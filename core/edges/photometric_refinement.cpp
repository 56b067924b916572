// SPDX-License-Identifier: MIT
#include "core/edges/photometric_refinement.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/camera/camera.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/noise.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/robust.hpp"
#include "core/image/simd.hpp"

namespace ellipse {
namespace {

// See docs/provenance.md.
// Largest distance from an edge at which pixels carry information on its position [px].
constexpr double kPhotometricBandPx = 3.8;
constexpr int kLanes = 12;  // pixels across the edge: kPhotometricBandPx at 45 degrees
constexpr int kLinesOfSector = 6;
constexpr std::size_t kMaxSectors = 80;  // of a long outline, whose lines are subsampled
constexpr std::size_t kNeighbours = 3;   // sectors on each side that share the two levels
constexpr double kTypicalStepPx = 2.3;   // half the width of the blurred step; others are within
                                         // half and twice of it
constexpr double kTukeyOfSigma = 4.7;    // reach over the scatter

// Sums over a sector's pixels of the products of: the unit step s between the two levels, its slope
// g, its derivative w by narrowing, and the brightness i.
enum Sum { k1, kS, kSS, kI, kIS, kII, kG, kGS, kGG, kIG, kW, kWS, kWG, kWW, kIW, kSums };
using Sums = Eigen::Array<double, kSums, 1>;

struct Sector {
  Sums sums = Sums::Zero();
  Eigen::Vector2d outwards{0.0, 0.0};  // sum of the normals,
  double curvature = 0.0;              // and of the curvatures [1/px]
  int lines = 0;
};

// Crossing of a line of pixels and the perimeter.
struct Crossing {
  const std::uint8_t* pixel = nullptr;  // nearest to the crossing
  std::ptrdiff_t along = 0;             // stride of the line's pixels [bytes]
  float offset = 0.0F;                  // of the crossing from the pixel [px]
  float slope = 0.0F;                   // derivative of the distance from the perimeter
  float quadratic = 0.0F;               // half its second derivative

  // Converts in a loop of its own, which uses vectors of more than two floats.
  ELLIPSE_INLINE void read(float (&intensities)[kLanes]) const {
    alignas(16) std::uint8_t levels[kLanes];
    const std::uint8_t* next = pixel - kLanes / 2 * along;
    for (std::uint8_t& level : levels) {
      level = *next;
      next += along;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      intensities[lane] = static_cast<float>(levels[lane]) - 128.0F;
    }
  }
};

// The sums of a sector's lines, lane by lane.
struct LaneSums {
  alignas(32) float of[kSums][kLanes] = {};
};

// Compiled for the baseline processor and for AVX2, with identical results.
template <bool kWithWidth>
ELLIPSE_INLINE void add_line(const Crossing& crossing,
                             float inside_px,
                             float inverse_step,
                             LaneSums& sums) {
  const auto outside_px = static_cast<float>(kPhotometricBandPx);
  alignas(32) float intensities[kLanes];
  crossing.read(intensities);
  for (int lane = 0; lane < kLanes; ++lane) {
    const float t = static_cast<float>(lane - kLanes / 2) - crossing.offset;
    const float distance = t * (crossing.slope + crossing.quadratic * t);
    const float one = distance >= -inside_px && distance <= outside_px ? 1.0F : 0.0F;
    // The step's slope is (1 - x^2)^3: close to a Gaussian, without an exponential.
    const float x = std::min(1.0F, std::max(-1.0F, distance * inverse_step));
    const float xx = x * x;
    const float rest = 1.0F - xx;
    const float g = 35.0F / 32.0F * inverse_step * (one * rest * rest * rest);
    const float s =
        one * (0.5F + x * (35.0F + xx * (-35.0F + xx * (21.0F - 5.0F * xx))) * (1.0F / 32.0F));
    const float i = one * intensities[lane];
    sums.of[k1][lane] += one;
    sums.of[kS][lane] += s;
    sums.of[kSS][lane] += s * s;
    sums.of[kI][lane] += i;
    sums.of[kIS][lane] += i * s;
    sums.of[kII][lane] += i * i;
    sums.of[kG][lane] += g;
    sums.of[kGS][lane] += g * s;
    sums.of[kGG][lane] += g * g;
    sums.of[kIG][lane] += i * g;
    if constexpr (kWithWidth) {
      const float w = distance * g;
      sums.of[kW][lane] += w;
      sums.of[kWS][lane] += w * s;
      sums.of[kWG][lane] += w * g;
      sums.of[kWW][lane] += w * w;
      sums.of[kIW][lane] += i * w;
    }
  }
}

using AddLine = void (*)(const Crossing&, float inside_px, float inverse_step, LaneSums&);

template <bool kWithWidth>
void add_line_baseline(const Crossing& crossing, float inside, float inverse, LaneSums& sums) {
  add_line<kWithWidth>(crossing, inside, inverse, sums);
}

template <bool kWithWidth>
ELLIPSE_AVX2 void add_line_avx2(const Crossing& crossing,
                                float inside,
                                float inverse,
                                LaneSums& sums) {
  add_line<kWithWidth>(crossing, inside, inverse, sums);
}

class Accumulator {
 public:
  Accumulator(double inside_px, double step_px, bool fits_width)
      : inside_px_(static_cast<float>(std::min(inside_px, kPhotometricBandPx))),
        inverse_step_(static_cast<float>(1.0 / step_px)) {
    if (best_simd() == Simd::kAvx2) {
      add_ = fits_width ? add_line_avx2<true> : add_line_avx2<false>;
    } else {
      add_ = fits_width ? add_line_baseline<true> : add_line_baseline<false>;
    }
  }

  void add(const Crossing& crossing) { add_(crossing, inside_px_, inverse_step_, sums_); }

  [[nodiscard]] Sums take() {
    Sums sums;
    for (int k = 0; k < kSums; ++k) {
      float sum = 0.0F;
      for (const float lane : sums_.of[k]) sum += lane;
      sums[k] = sum;
    }
    sums_ = {};
    return sums;
  }

 private:
  float inside_px_;
  float inverse_step_;
  AddLine add_;
  LaneSums sums_;
};

struct Pass {
  bool fits_width = false;
  double step_px = 0.0;
};

// Sums over the pixels along an ellipse's perimeter, by sector.
class Band {
 public:
  Band(const ImageView& luma, const Ellipse& e, double inside_px, const Pass& pass)
      : accumulator_(inside_px, pass.step_px, pass.fits_width),
        center_(e.center()),
        shape_(shape_matrix(e)),
        conic_(shape_.inverse()),
        luma_(luma) {
    const double lines = std::min(kFarPx, perimeter_px(e));
    stride_ = static_cast<int>(std::ceil(lines / (kMaxSectors * kLinesOfSector)));
    for (int quarter = 0; quarter < 4; ++quarter) read(quarter);
    close_sector();
  }

  [[nodiscard]] std::span<const Sector> sectors() const { return {sectors_.data(), count_}; }

  // The point of the perimeter with this normal.
  [[nodiscard]] Eigen::Vector2d point_with_normal(const Eigen::Vector2d& outwards) const {
    const Eigen::Vector2d along = shape_ * outwards;
    return center_ + along / std::sqrt(outwards.dot(along));
  }

 private:
  // Reads the quarter whose normals are within 45 degrees of an axis by lines of pixels along it:
  // the top one by columns from left to right, the right one by rows downwards, and so on.
  void read(int quarter) {
    const int axis = quarter % 2;  // from line to line
    const int other = 1 - axis;
    const double side = quarter == 1 || quarter == 2 ? 1.0 : -1.0;
    const int forth = quarter < 2 ? 1 : -1;
    Eigen::Vector2d normal;
    normal[other] = side;
    normal[axis] = -forth;
    const double from = point_with_normal(normal)[axis];
    normal[axis] = forth;
    const double to = point_with_normal(normal)[axis];
    const Eigen::Array2i size(luma_.width, luma_.height);
    const double end = size[axis];
    const int low = static_cast<int>(std::ceil(std::clamp(std::min(from, to), 0.0, end)));
    const int high = static_cast<int>(std::floor(std::clamp(std::max(from, to), -1.0, end - 1.0)));
    const std::ptrdiff_t along = axis == 0 ? luma_.stride : 1;
    const std::ptrdiff_t step = axis == 0 ? 1 : luma_.stride;
    const double c = 1.0 / conic_(other, other);
    const double slant = -conic_(0, 1) * c;
    const double determinant = conic_.determinant() * c;
    for (int line = forth > 0 ? low : high; line >= low && line <= high; line += forth * stride_) {
      Eigen::Vector2d at;
      at[axis] = line - center_[axis];
      at[other] = slant * at[axis] +
                  side * std::sqrt(std::max(0.0, (1.0 - determinant * at[axis] * at[axis]) * c));
      const double crossing = center_[other] + at[other];
      if (!(crossing >= kLanes / 2 && crossing < size[other] - kLanes + kLanes / 2)) {
        close_sector();
        continue;
      }
      const int nearest = static_cast<int>(std::floor(crossing + 0.5));
      add_crossing(luma_.data + nearest * along + line * step, along, crossing - nearest, at);
    }
  }

  // @param at  The crossing, from the centre.
  void add_crossing(const std::uint8_t* pixel,
                    std::ptrdiff_t along,
                    double offset,
                    const Eigen::Vector2d& at) {
    const int axis = along == 1 ? 1 : 0;  // from line to line
    const Eigen::Vector2d gradient = conic_ * at;
    const double inverse = 1.0 / gradient.norm();
    const Eigen::Vector2d outwards = inverse * gradient;
    const double curvature = conic_.determinant() * inverse * inverse * inverse;
    Sector& sector = sectors_[count_];
    sector.outwards += outwards;
    sector.curvature += curvature;
    accumulator_.add({pixel,
                      along,
                      static_cast<float>(offset),
                      static_cast<float>(outwards[1 - axis]),
                      static_cast<float>(0.5 * curvature * outwards[axis] * outwards[axis])});
    if (++sector.lines >= kLinesOfSector) close_sector();
  }

  void close_sector() {
    Sector& sector = sectors_[count_];
    sector.sums = accumulator_.take();
    if (2 * sector.lines >= kLinesOfSector && count_ < kMaxSectors) {
      ++count_;
    } else {
      sector = {};
    }
  }

  Accumulator accumulator_;
  Eigen::Vector2d center_;
  Eigen::Matrix2d shape_;
  Eigen::Matrix2d conic_;
  std::array<Sector, kMaxSectors + 1> sectors_;  // the last one is incomplete
  std::size_t count_ = 0;
  ImageView luma_;
  int stride_ = 1;
};

// Least-squares fit of two levels and the step between them to a sector's pixels.
struct Step {
  // Level inside, contrast, and contrast x (offset inwards, narrower).
  Eigen::Vector4d values = Eigen::Vector4d::Zero();
  double offset_variance = 0.0;  // of values[2], per variance of the noise
};

Eigen::Matrix4d normal_matrix(const Sums& sums) {
  Eigen::Matrix4d normal;
  normal << sums[k1], sums[kS], sums[kG], sums[kW],  //
      sums[kS], sums[kSS], sums[kGS], sums[kWS],     //
      sums[kG], sums[kGS], sums[kGG], sums[kWG],     //
      sums[kW], sums[kWS], sums[kWG], sums[kWW];
  return normal;
}

Eigen::Vector4d right_side(const Sums& sums) {
  return {sums[kI], sums[kIS], sums[kIG], sums[kIW]};
}

template <int kValues>
Step solved(const Sums& sums) {
  Eigen::Matrix<double, kValues, kValues> normal =
      normal_matrix(sums).topLeftCorner<kValues, kValues>();
  normal.diagonal() *= 1.0 + 1e-9;
  const Eigen::Matrix<double, kValues, kValues> covariance = normal.inverse();
  Step step;
  step.values.template head<kValues>() = covariance * right_side(sums).head<kValues>();
  step.offset_variance = covariance(2, 2);
  return step;
}

Step fitted(const Sums& sums) {
  return sums[kWW] > 0.0 ? solved<4>(sums) : solved<3>(sums);
}

// Sum of the squared differences between the pixels and a step.
double squares(const Sums& sums, const Eigen::Vector4d& values) {
  return std::max(
      0.0,
      sums[kII] - 2.0 * values.dot(right_side(sums)) + values.dot(normal_matrix(sums) * values));
}

// A sector's measurement of the edge.
struct Edge {
  const Sector* sector = nullptr;
  double offset_px = 0.0;  // outwards
  double variance = 0.0;
  double narrower = 0.0;  // decrease of the width's logarithm from the assumed one
};

// Fits the levels together with the neighbours, which is more precise, unless the neighbours differ
// because of a shadow or an occluder.
std::optional<Edge> edge_of(std::span<const Sector> sectors,
                            std::size_t i,
                            double brighter_outside,
                            double min_contrast) {
  const std::size_t n = sectors.size();
  const Sums& own = sectors[i].sums;
  Sums near = own;
  for (std::size_t k = 1; k <= kNeighbours; ++k) {
    near += sectors[(i + k) % n].sums + sectors[(i + n - k) % n].sums;
  }
  const Step alone = fitted(own);
  if (!(brighter_outside * alone.values[1] >= min_contrast)) return std::nullopt;
  Step shared = fitted(near);
  // Fits the offset to this sector's pixels only.
  shared.values[2] = (own[kIG] - shared.values[0] * own[kG] - shared.values[1] * own[kGS] -
                      shared.values[3] * own[kWG]) /
                     own[kGG];
  const double rest = squares(own, alone.values);
  // At least the variance of rounding to grey levels.
  const double noise = 1.0 / 12.0 + rest / std::max(1.0, own[k1] - 3.0);
  const bool is_alike = squares(own, shared.values) - rest < kAllSigmas * kAllSigmas * noise;
  const Eigen::Vector4d& values = is_alike ? shared.values : alone.values;
  const double variance = noise * (is_alike ? 1.0 / own[kGG] : alone.offset_variance);
  return Edge{&sectors[i],
              -values[2] / values[1],
              variance / (values[1] * values[1]),
              values[3] / values[1]};
}

// Outlines that are not exactly elliptical scatter more than pixel noise explains.
double scatter_of(std::span<const Edge> edges) {
  std::array<WeightedDistance, kMaxSectors> distances;
  for (std::size_t i = 0; i < edges.size(); ++i) distances[i] = {edges[i].offset_px, 1.0};
  return robust_sigma(std::span(distances).first(edges.size()));
}

// One Gauss-Newton step. Returns half the width of the blurred step between the levels [px].
std::optional<double> fit_edges(const Band& band,
                                std::span<const Edge> edges,
                                FittedEllipse& refined) {
  const double scatter = scatter_of(edges);
  const double reach = kTukeyOfSigma * scatter;
  GeometricFit fit(refined.ellipse);
  double narrower = 0.0;
  double weights = 0.0;
  for (const Edge& edge : edges) {
    const double weight = tukey_weight(edge.offset_px, reach) / (edge.variance + scatter * scatter);
    narrower += weight * edge.narrower;
    weights += weight;
    const Sector& sector = *edge.sector;
    const Eigen::Vector2d outwards = sector.outwards.normalized();
    const double drawn_in_px = 0.5 * kLensVariance * sector.curvature / sector.lines;
    if (weight > 0.0) {
      fit.add(band.point_with_normal(outwards) + (edge.offset_px + drawn_in_px) * outwards, weight);
    }
  }
  const auto better = fit.solve();
  if (!better) return std::nullopt;
  refined = {*better, {image_from_pad(*better), fit.information()}};
  return kTypicalStepPx * std::exp(-narrower / weights);
}

}  // namespace

std::optional<FittedEllipse> refined_photometrically(const ImageView& luma,
                                                     const Ellipse& e,
                                                     Polarity polarity,
                                                     double inside_px,
                                                     double min_contrast) {
  inside_px -= kTypicalStepPx;  // the next edge has the same blur
  if (!(inside_px >= kTypicalStepPx)) return std::nullopt;
  const double brighter_outside = polarity == Polarity::kDarkInside ? 1.0 : -1.0;
  FittedEllipse refined{e, {}};
  Pass pass{true, kTypicalStepPx};
  for (int i = 0; i < 2; ++i) {
    const Band band(luma, refined.ellipse, inside_px, pass);
    const auto sectors = band.sectors();
    std::array<Edge, kMaxSectors> edges;
    std::size_t count = 0;
    for (std::size_t k = 0; k < sectors.size(); ++k) {
      const auto edge = edge_of(sectors, k, brighter_outside, min_contrast);
      if (edge) edges[count++] = *edge;
    }
    if (count < kMinEdgesOfEllipse || 2 * count < sectors.size()) return std::nullopt;
    const auto step_px = fit_edges(band, std::span(edges).first(count), refined);
    if (!step_px) return std::nullopt;
    pass = {false, std::clamp(*step_px, 0.5 * kTypicalStepPx, 2.0 * kTypicalStepPx)};
  }
  return refined;
}

}  // namespace ellipse
