#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/picture.hpp"
#include "core/image/simd.hpp"

namespace ellipse {

/// The gradient at a pixel, from dark to bright, in units of 1 / kGradientGain grey levels per
/// pixel.
struct Gradient {
  std::int16_t x = 0;
  std::int16_t y = 0;
};

/// Response of the 5 x 5 kernels to a slope of one grey level per pixel.
inline constexpr double kGradientGain = 128.0;
/// Their largest response to a step of one grey level between two pixels.
inline constexpr double kGradientOfStep = 48.0;

/// Codes of gradient maxima: one byte per pixel, 0 elsewhere. The low three bits hold the direction
/// of the edge, which is the gradient turned by 90 degrees from x to y, in eighths of a turn from
/// +x to +y.
namespace maximum {
enum Code : std::uint8_t {
  kOctant = 0x07,
  kFree = 0x08,     ///< Not visited by a walk.
  kSeed = 0x10,     ///< Above the high threshold, and free.
  kChained = 0x40,  ///< In a chain.
};
}  // namespace maximum

/// The 5 x 5 kernels: along the edge and across it.
inline constexpr std::array<int, 5> kSmoothing = {1, 4, 6, 4, 1};
inline constexpr std::array<int, 5> kDifference = {-1, -2, 0, 2, 1};

/// Computes the gradients of a line of pixels as GradientMap does: from (x, y) to the right, or
/// down. All pixels are at least two pixels from the border.
template <std::size_t kPixels>
void gradients_along(
    const ImageView& luma, int x, int y, bool is_row, std::array<Gradient, kPixels>& gradients) {
  const std::ptrdiff_t along = is_row ? 1 : luma.stride;
  const std::ptrdiff_t across = is_row ? luma.stride : 1;
  std::array<int, kPixels + 4> smooth;
  std::array<int, kPixels + 4> difference;
  const std::uint8_t* c = luma.row(y) + x - 2 * along;
  for (std::size_t i = 0; i < kPixels + 4; ++i, c += along) {
    const int a = c[-2 * across];
    const int b = c[-across];
    const int d = c[across];
    const int e = c[2 * across];
    smooth[i] = a + e + 4 * (b + d) + 6 * *c;
    difference[i] = (e - a) + 2 * (d - b);
  }
  for (std::size_t i = 0; i < kPixels; ++i) {
    const int* s = smooth.data() + i;
    const int* t = difference.data() + i;
    const auto in_line = static_cast<std::int16_t>(s[4] - s[0] + 2 * (s[3] - s[1]));
    const auto across_line = static_cast<std::int16_t>(t[0] + t[4] + 4 * (t[1] + t[3]) + 6 * t[2]);
    gradients[i] = is_row ? Gradient{in_line, across_line} : Gradient{across_line, in_line};
  }
}

/// Hysteresis [Canny1986]: an edge begins above the high threshold and continues above the low one
/// [grey levels / px].
struct EdgeThresholds {
  double low = 0.0;
  double high = 0.0;
};

/// The gradient of a picture and its gradient maxima, in one pass over the rows.
///
/// Exact integer arithmetic: separable 5 x 5 kernels, smoothing [1 4 6 4 1] one way and difference
/// [-1 -2 0 2 1] the other [FaridSimoncelli2004]. A gradient maximum is a pixel above the low
/// threshold whose magnitude is at least that of the neighbour before it and above that of the one
/// after it, along the axis closest to the gradient [Canny1986].
class GradientMap {
 public:
  explicit GradientMap(Simd simd = best_simd()) : simd_(simd) {}

  /// @param thresholds  0 = derived from the other one; both 0 = from the picture's noise.
  /// Allocates only when the picture grows. O(pixels).
  void compute(const Picture& picture, const EdgeThresholds& thresholds = {});

  [[nodiscard]] const LensView& lens() const { return lens_; }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Row stride of both maps [pixels].
  [[nodiscard]] int stride() const { return stride_; }

  /// Column and row of an index into the maps.
  [[nodiscard]] Eigen::Vector2i pixel_at(std::int32_t index) const {
    return {index % stride_, index / stride_};
  }
  /// Its position in the ideal plane [px].
  [[nodiscard]] Eigen::Vector2d point_of(std::int32_t index) const {
    return lens_.approximate_ideal(pixel_at(index).cast<double>());
  }

  [[nodiscard]] const Gradient* gradients() const { return gradients_.data(); }
  [[nodiscard]] const std::uint8_t* maxima() const { return maxima_.data(); }
  [[nodiscard]] std::uint8_t* maxima() { return maxima_.data(); }
  /// First pixels of the runs of kBlock pixels with a gradient above the low threshold: indices
  /// into the maps, ascending.
  [[nodiscard]] std::span<const std::int32_t> blocks() const {
    return {blocks_.data(), block_count_};
  }

  /// Standard deviation of the gradient's noise in one direction [units of Gradient].
  [[nodiscard]] double noise() const { return noise_; }
  /// The same from the gradients alone, which also show texture and shading.
  [[nodiscard]] double texture() const { return texture_; }
  /// Thresholds used by compute().
  [[nodiscard]] const EdgeThresholds& thresholds() const { return thresholds_; }

  /// Border without gradient maxima, where the kernels reach outside the picture [pixels].
  static constexpr int kBorder = 3;
  static constexpr int kBlock = 32;  // pixels

 private:
  static constexpr int kRows = 3;  // of gradients kept for non-maximum suppression

  void resize(const ImageView& luma);
  void compute_row(const ImageView& luma, int y);
  void mark_row(int y);
  void measure_noise(const ImageView& luma);
  [[nodiscard]] std::int16_t* row_of(std::vector<std::int16_t>& rows, int y);

  Simd simd_;
  LensView lens_;
  int width_ = 0;
  int height_ = 0;
  int stride_ = 0;
  double noise_ = 0.0;
  double texture_ = 0.0;
  EdgeThresholds thresholds_;
  std::vector<Gradient> gradients_;
  std::vector<std::uint8_t> maxima_;
  std::vector<std::int32_t> blocks_;
  std::size_t block_count_ = 0;
  std::vector<std::int16_t> smooth_;      // one row, smoothed down the columns
  std::vector<std::int16_t> difference_;  // one row, differences down the columns
  std::vector<std::int16_t> x_;           // kRows rows each
  std::vector<std::int16_t> y_;
  std::vector<std::int16_t> magnitude_;
  std::vector<int> histogram_;
};

}  // namespace ellipse
