// SPDX-License-Identifier: MIT
#include "core/edges/gradient_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/edges/noise.hpp"

namespace ellipse {
namespace {

using Int = std::int16_t;

// Found by experiment, see docs/provenance.md.
constexpr double kLowOverNoise = 3.0;
constexpr double kHighOverLow = 2.0;  // [Canny1986]: two to three
constexpr int kHistogramShift = 4;    // log2 of a bin of magnitudes [units of Gradient]

// Sigma of a gradient's component if that of the pixels is 1: the norm of the kernel.
const double kGradientOfNoise = std::sqrt(70.0 * 10.0);

// The compiler vectorizes these plain loops, for SSE2 and AVX2 on x86-64 and for NEON on AArch64.
// Sixteen bits suffice: the largest component is 16 x 255 x 3 = 12240.

ELLIPSE_INLINE void filter_columns_body(const std::uint8_t* const* rows,
                                        Int* __restrict smooth,
                                        Int* __restrict difference,
                                        int n) {
  const std::uint8_t* __restrict a = rows[0];
  const std::uint8_t* __restrict b = rows[1];
  const std::uint8_t* __restrict c = rows[2];
  const std::uint8_t* __restrict d = rows[3];
  const std::uint8_t* __restrict e = rows[4];
  for (int i = 0; i < n; ++i) {
    smooth[i] = static_cast<Int>(a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i]);
    difference[i] = static_cast<Int>((e[i] - a[i]) + 2 * (d[i] - b[i]));
  }
}

// The magnitude is max(larger, 7/8 larger + 1/2 smaller): the Euclidean norm within 3 %.
ELLIPSE_INLINE void filter_rows_body(const Int* __restrict smooth,
                                     const Int* __restrict difference,
                                     Int* __restrict gx,
                                     Int* __restrict gy,
                                     Int* __restrict magnitude,
                                     Gradient* __restrict both,
                                     int n) {
  for (int i = 0; i < n; ++i) {
    const Int* s = smooth + i;
    const Int* d = difference + i;
    const Int x = static_cast<Int>(s[2] - s[-2] + 2 * (s[1] - s[-1]));
    const Int y = static_cast<Int>(d[-2] + d[2] + 4 * (d[-1] + d[1]) + 6 * d[0]);
    const Int ax = static_cast<Int>(x < 0 ? -x : x);
    const Int ay = static_cast<Int>(y < 0 ? -y : y);
    const Int larger = ax > ay ? ax : ay;
    const Int smaller = ax > ay ? ay : ax;
    const Int mixed = static_cast<Int>(larger - (larger >> 3) + (smaller >> 1));
    magnitude[i] = larger > mixed ? larger : mixed;
    gx[i] = x;
    gy[i] = y;
    both[i] = {x, y};
  }
}

// Gradients of a row, and magnitudes of it and its neighbours.
struct MaximaRows {
  const Int* gx;
  const Int* gy;
  const Int* above;
  const Int* here;
  const Int* below;
};

// A gradient maximum is above `low`, a seed above `high`.
struct Levels {
  Int low;
  Int high;
};

// The direction of the edge, as maximum::kOctant. `is_along_row`: -1 if the gradient is along the
// row.
ELLIPSE_INLINE Int octant_of(Int gx, Int gy, Int ax, Int ay, Int is_along_row) {
  const Int larger = ax > ay ? ax : ay;
  const Int smaller = ax > ay ? ay : ax;
  // tan(22.5 degrees) = 0.414; 1/2 - 1/16 - 1/64 = 0.422
  const Int diagonal = static_cast<Int>((larger >> 1) - (larger >> 4) - (larger >> 6));
  const Int is_diagonal = static_cast<Int>(smaller > diagonal ? -1 : 0);
  const Int is_left = static_cast<Int>(gx < 0 ? -1 : 0);
  const Int is_down = static_cast<Int>(gy > 0 ? -1 : 0);
  const Int slanted = static_cast<Int>(((is_left & 6) ^ (is_down & 2)) + 1);
  const Int straight =
      static_cast<Int>((is_along_row & (2 + (is_left & 4))) | (~is_along_row & is_down & 4));
  return static_cast<Int>((is_diagonal & slanted) | (~is_diagonal & straight));
}

// Also lists the blocks with a magnitude above `low`, as distances from the first pixel; returns
// their number.
ELLIPSE_INLINE int mark_maxima_body(
    const MaximaRows& rows, std::uint8_t* codes, Levels levels, int n, std::int32_t* blocks) {
  const Int low = levels.low;
  const Int high = levels.high;
  int count = 0;
  for (int begin = 0; begin < n; begin += GradientMap::kBlock) {
    const Int* __restrict m = rows.here + begin;
    std::uint8_t* __restrict out = codes + begin;
    Int any = 0;
    for (int i = 0; i < GradientMap::kBlock; ++i)
      any = static_cast<Int>(any | (m[i] > low ? -1 : 0));
    if (any == 0) {
      std::memset(out, 0, GradientMap::kBlock);
      continue;
    }
    blocks[count++] = begin;
    const Int* __restrict gx = rows.gx + begin;
    const Int* __restrict gy = rows.gy + begin;
    const Int* __restrict up = rows.above + begin;
    const Int* __restrict down = rows.below + begin;
    for (int i = 0; i < GradientMap::kBlock; ++i) {
      const Int ax = static_cast<Int>(gx[i] < 0 ? -gx[i] : gx[i]);
      const Int ay = static_cast<Int>(gy[i] < 0 ? -gy[i] : gy[i]);
      const Int is_along_row = static_cast<Int>(ax > ay ? -1 : 0);
      const Int before = static_cast<Int>((m[i - 1] & is_along_row) | (up[i] & ~is_along_row));
      const Int after = static_cast<Int>((m[i + 1] & is_along_row) | (down[i] & ~is_along_row));
      const Int octant = octant_of(gx[i], gy[i], ax, ay, is_along_row);
      const Int is_maximum = static_cast<Int>((m[i] > low ? -1 : 0) & (m[i] >= before ? -1 : 0) &
                                              (m[i] > after ? -1 : 0));
      const Int seed = static_cast<Int>((m[i] > high ? -1 : 0) & maximum::kSeed);
      out[i] = static_cast<std::uint8_t>(is_maximum & (octant | maximum::kFree | seed));
    }
  }
  return count;
}

void filter_columns(const std::uint8_t* const* rows, Int* smooth, Int* difference, int n) {
  filter_columns_body(rows, smooth, difference, n);
}
void filter_rows(
    const Int* smooth, const Int* difference, Int* gx, Int* gy, Int* m, Gradient* both, int n) {
  filter_rows_body(smooth, difference, gx, gy, m, both, n);
}
int mark_maxima(
    const MaximaRows& rows, std::uint8_t* codes, Levels levels, int n, std::int32_t* blocks) {
  return mark_maxima_body(rows, codes, levels, n, blocks);
}
ELLIPSE_AVX2 void filter_columns_avx2(const std::uint8_t* const* rows, Int* s, Int* d, int n) {
  filter_columns_body(rows, s, d, n);
}
ELLIPSE_AVX2 void filter_rows_avx2(
    const Int* smooth, const Int* difference, Int* gx, Int* gy, Int* m, Gradient* both, int n) {
  filter_rows_body(smooth, difference, gx, gy, m, both, n);
}
ELLIPSE_AVX2 int mark_maxima_avx2(
    const MaximaRows& rows, std::uint8_t* codes, Levels levels, int n, std::int32_t* blocks) {
  return mark_maxima_body(rows, codes, levels, n, blocks);
}

struct Kernels {
  decltype(&filter_columns) columns;
  decltype(&filter_rows) rows;
  decltype(&mark_maxima) maxima;
};

const Kernels& kernels_of(Simd simd) {
  static constexpr Kernels kBaseline{filter_columns, filter_rows, mark_maxima};
  static constexpr Kernels kAvx2{filter_columns_avx2, filter_rows_avx2, mark_maxima_avx2};
  return simd == Simd::kAvx2 ? kAvx2 : kBaseline;
}

// Never shrinks, since pictures of two sizes may alternate.
template <class T>
void grow(std::vector<T>& values, std::size_t size) {
  values.resize(std::max(values.size(), size));
}

}  // namespace

std::int16_t* GradientMap::row_of(std::vector<std::int16_t>& rows, int y) {
  const std::ptrdiff_t length = kBlock + width_ + kBlock;
  return rows.data() + length * ((y + kRows) % kRows) + kBlock;
}

void GradientMap::resize(const ImageView& luma) {
  width_ = luma.width;
  height_ = luma.height;
  stride_ = (width_ + 2 * kBlock) / kBlock * kBlock;  // the last block of a row may overrun it
  const auto pixels = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  const auto length = static_cast<std::size_t>(kBlock + width_ + kBlock);
  grow(gradients_, pixels);
  grow(maxima_, pixels + kBlock);
  grow(blocks_, pixels / kBlock);
  grow(smooth_, length);
  grow(difference_, length);
  grow(x_, kRows * length);
  grow(y_, kRows * length);
  grow(magnitude_, kRows * length);
  histogram_.resize((std::numeric_limits<Int>::max() >> kHistogramShift) + 1);
}

void GradientMap::compute_row(const ImageView& luma, int y) {
  std::array<const std::uint8_t*, 5> rows;
  for (int k = 0; k < 5; ++k) {
    rows[static_cast<std::size_t>(k)] = luma.row(std::clamp(y + k - 2, 0, height_ - 1));
  }
  Int* smooth = smooth_.data() + kBlock;
  Int* difference = difference_.data() + kBlock;
  const Kernels& kernels = kernels_of(simd_);
  kernels.columns(rows.data(), smooth, difference, width_);
  for (int k = 1; k <= 2; ++k) {  // the border repeats its last pixel
    smooth[-k] = smooth[0];
    difference[-k] = difference[0];
    smooth[width_ - 1 + k] = smooth[width_ - 1];
    difference[width_ - 1 + k] = difference[width_ - 1];
  }
  Gradient* out = gradients_.data() + static_cast<std::ptrdiff_t>(y) * stride_;
  kernels.rows(
      smooth, difference, row_of(x_, y), row_of(y_, y), row_of(magnitude_, y), out, width_);
}

// The geometric mean of two estimates. Gradients also show texture and shading, which hide weak
// edges as noise does. Second differences show neither, so that a soft edge in a shaded picture is
// found.
void GradientMap::measure_noise(const ImageView& luma) {
  std::fill(histogram_.begin(), histogram_.end(), 0);
  int unsaturated = 0;
  int all = 0;
  const int step = std::max(1, height_ / kNoiseRows);
  for (int y = kBorder; y < height_ - kBorder; y += step) {
    compute_row(luma, y);
    const Int* m = row_of(magnitude_, y);
    const std::uint8_t* levels = luma.row(y);
    for (int x = 2; x < width_ - 2; x += 2) {
      ++all;
      if (is_saturated(levels[x])) continue;
      ++histogram_[static_cast<std::size_t>(m[x] >> kHistogramShift)];
      ++unsaturated;
    }
  }
  const int samples = noise_samples(unsaturated, all);
  histogram_[0] += samples - unsaturated;
  const double rounding = kGradientOfNoise / std::sqrt(12.0);  // of pixels to grey levels
  const double quantile =
      (static_cast<double>(noise_bin(histogram_, samples)) + 0.5) * (1 << kHistogramShift);
  texture_ = std::max(rounding, noise_of(quantile));
  noise_ = std::sqrt(texture_ * kGradientOfNoise * pixel_noise(luma));
}

void GradientMap::compute(const Picture& picture, const EdgeThresholds& thresholds) {
  const ImageView& luma = picture.luma;
  lens_ = picture.lens;
  resize(luma);
  block_count_ = 0;
  thresholds_ = {};
  noise_ = texture_ = 0.0;
  if (luma.empty()) return;
  measure_noise(luma);
  const auto used = [](double level, double by_default) {
    // Thresholds have 16 bits.
    return std::min(level > 0.0 ? level : by_default,
                    std::numeric_limits<Int>::max() / kGradientGain);
  };
  // Quantization turns slow shading into steps of one grey level, which are not edges.
  const double by_noise = std::max(kLowOverNoise * noise_, kGradientOfStep) / kGradientGain;
  thresholds_.low =
      used(thresholds.low, thresholds.high > 0.0 ? thresholds.high / kHighOverLow : by_noise);
  thresholds_.high = used(thresholds.high, kHighOverLow * thresholds_.low);
  for (int y = 1; y < height_ - 1; ++y) {
    compute_row(luma, y);
    mark_row(y - 1);
  }
  for (int y = std::max(0, height_ - 2); y < height_; ++y) mark_row(y);
}

void GradientMap::mark_row(int y) {
  const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(y) * stride_;
  std::uint8_t* codes = maxima_.data() + begin;
  const int inside = width_ - 2 * kBorder;
  if (inside <= 0 || y < kBorder || y >= height_ - kBorder) {
    std::memset(codes, 0, static_cast<std::size_t>(stride_));
    return;
  }
  const MaximaRows rows{row_of(x_, y) + kBorder,
                        row_of(y_, y) + kBorder,
                        row_of(magnitude_, y - 1) + kBorder,
                        row_of(magnitude_, y) + kBorder,
                        row_of(magnitude_, y + 1) + kBorder};
  std::int32_t* blocks = blocks_.data() + block_count_;
  std::memset(codes, 0, kBorder);
  const Levels levels{static_cast<Int>(kGradientGain * thresholds_.low),
                      static_cast<Int>(kGradientGain * thresholds_.high)};
  const int count = kernels_of(simd_).maxima(rows, codes + kBorder, levels, inside, blocks);
  for (int i = 0; i < count; ++i) blocks[i] += static_cast<std::int32_t>(begin) + kBorder;
  block_count_ += static_cast<std::size_t>(count);
  // The last block may have overrun.
  const int end = width_ - kBorder;
  std::memset(codes + end, 0, static_cast<std::size_t>(stride_ - end));
}

}  // namespace ellipse
