// SPDX-License-Identifier: MIT
#include "core/gradient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__)
#define ELLIPSE_HAS_AVX2 1
#define ELLIPSE_AVX2 __attribute__((target("avx2")))
#else
#define ELLIPSE_HAS_AVX2 0
#define ELLIPSE_AVX2
#endif
#define ELLIPSE_INLINE inline __attribute__((always_inline))

namespace ellipse {
namespace {

using Int = std::int16_t;

constexpr int kPadLeft = 16;   // buffers begin before the first pixel,
constexpr int kPadRight = 64;  // and go on behind the last one, so that blocks may overrun
constexpr int kBlock = 32;     // pixels that are looked at together

// Found by experiment, see docs/provenance.md.
constexpr int kNoiseRowStep = 12;
constexpr double kNoiseQuantile = 0.3;
constexpr double kThresholdOverNoise = 4.0;
constexpr double kLeastNoise = 20.0;  // rounding to grey levels alone makes as much
constexpr int kHistogramBins = 1536;
constexpr int kHistogramShift = 4;
constexpr double kLargestThreshold = 6000.0;

// These loops are plain: the compiler makes vectors of them, twice on x86-64, and of NEON's kind on
// AArch64. Sixteen bits are enough: the largest gradient is 16 x 255 x 6 = 24480.

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
  }
}

// The rows around the one whose crests are wanted.
struct CrestRows {
  const Int* gx;
  const Int* gy;
  const Int* above;
  const Int* here;
  const Int* below;
};

ELLIPSE_INLINE void mark_crests_body(const CrestRows& rows, std::uint8_t* codes, Int least, int n) {
  for (int begin = 0; begin < n; begin += kBlock) {
    const Int* __restrict m = rows.here + begin;
    std::uint8_t* __restrict out = codes + begin;
    Int any = 0;
    for (int i = 0; i < kBlock; ++i) any = static_cast<Int>(any | (m[i] > least ? -1 : 0));
    if (any == 0) {
      std::memset(out, 0, kBlock);
      continue;
    }
    const Int* __restrict gx = rows.gx + begin;
    const Int* __restrict gy = rows.gy + begin;
    const Int* __restrict up = rows.above + begin;
    const Int* __restrict down = rows.below + begin;
    for (int i = 0; i < kBlock; ++i) {
      const Int ax = static_cast<Int>(gx[i] < 0 ? -gx[i] : gx[i]);
      const Int ay = static_cast<Int>(gy[i] < 0 ? -gy[i] : gy[i]);
      const Int is_flat = static_cast<Int>(ax > ay ? -1 : 0);  // the gradient lies along the row
      const Int before = static_cast<Int>((m[i - 1] & is_flat) | (up[i] & ~is_flat));
      const Int after = static_cast<Int>((m[i + 1] & is_flat) | (down[i] & ~is_flat));
      const Int larger = ax > ay ? ax : ay;
      const Int smaller = ax > ay ? ay : ax;
      // tan(22.5 degrees) = 0.414; 1/2 - 1/16 - 1/64 = 0.422
      const Int diagonal = static_cast<Int>((larger >> 1) - (larger >> 4) - (larger >> 6));
      const Int code =
          static_cast<Int>(crest::kFree | ((gy[i] > 0 ? -1 : 0) & 1) | ((gx[i] < 0 ? -1 : 0) & 2) |
                           (is_flat & 4) | ((smaller > diagonal ? -1 : 0) & 8));
      const Int is_crest = static_cast<Int>((m[i] > least ? -1 : 0) & (m[i] >= before ? -1 : 0) &
                                            (m[i] > after ? -1 : 0));
      out[i] = static_cast<std::uint8_t>(is_crest & code);
    }
  }
}

void filter_columns(const std::uint8_t* const* rows, Int* smooth, Int* difference, int n) {
  filter_columns_body(rows, smooth, difference, n);
}
void filter_rows(const Int* smooth, const Int* difference, Int* gx, Int* gy, Int* m, int n) {
  filter_rows_body(smooth, difference, gx, gy, m, n);
}
void mark_crests(const CrestRows& rows, std::uint8_t* codes, Int least, int n) {
  mark_crests_body(rows, codes, least, n);
}
ELLIPSE_AVX2 void filter_columns_avx2(const std::uint8_t* const* rows, Int* s, Int* d, int n) {
  filter_columns_body(rows, s, d, n);
}
ELLIPSE_AVX2 void filter_rows_avx2(
    const Int* smooth, const Int* difference, Int* gx, Int* gy, Int* m, int n) {
  filter_rows_body(smooth, difference, gx, gy, m, n);
}
ELLIPSE_AVX2 void mark_crests_avx2(const CrestRows& rows, std::uint8_t* codes, Int least, int n) {
  mark_crests_body(rows, codes, least, n);
}

struct Kernels {
  decltype(&filter_columns) columns;
  decltype(&filter_rows) rows;
  decltype(&mark_crests) crests;
};

const Kernels& kernels_of(Simd simd) {
  static constexpr Kernels kBaseline{filter_columns, filter_rows, mark_crests};
  static constexpr Kernels kAvx2{filter_columns_avx2, filter_rows_avx2, mark_crests_avx2};
  return simd == Simd::kAvx2 ? kAvx2 : kBaseline;
}

bool is_saturated(std::uint8_t level) {
  return level < 2 || level > 253;
}

}  // namespace

Gradient gradient_at(const ImageView& luma, int x, int y) {
  std::array<int, 5> smooth{};
  std::array<int, 5> difference{};
  const std::uint8_t* a = luma.row(y - 2) + x - 2;
  const std::uint8_t* b = luma.row(y - 1) + x - 2;
  const std::uint8_t* c = luma.row(y) + x - 2;
  const std::uint8_t* d = luma.row(y + 1) + x - 2;
  const std::uint8_t* e = luma.row(y + 2) + x - 2;
  for (std::size_t i = 0; i < 5; ++i) {
    smooth[i] = a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i];
    difference[i] = (e[i] - a[i]) + 2 * (d[i] - b[i]);
  }
  return {static_cast<Int>(smooth[4] - smooth[0] + 2 * (smooth[3] - smooth[1])),
          static_cast<Int>(difference[0] + difference[4] + 4 * (difference[1] + difference[3]) +
                           6 * difference[2])};
}

Simd best_simd() {
#if ELLIPSE_HAS_AVX2
  return __builtin_cpu_supports("avx2") ? Simd::kAvx2 : Simd::kBaseline;
#else
  return Simd::kBaseline;
#endif
}

std::int16_t* GradientMap::row_of(std::vector<std::int16_t>& rows, int y) {
  const std::ptrdiff_t length = kPadLeft + width_ + kPadRight;
  return rows.data() + length * ((y + kRows) % kRows) + kPadLeft;
}

void GradientMap::resize(const ImageView& luma) {
  width_ = luma.width;
  height_ = luma.height;
  stride_ = (width_ + kPadRight) / kBlock * kBlock;
  const auto pixels = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
  const auto length = static_cast<std::size_t>(width_) + kPadLeft + kPadRight;
  gradients_.resize(pixels);
  crests_.resize(pixels + kPadRight);
  smooth_.resize(length);
  difference_.resize(length);
  x_.resize(kRows * length);
  y_.resize(kRows * length);
  magnitude_.resize(kRows * length);
  histogram_.resize(kHistogramBins);
}

void GradientMap::compute_row(const ImageView& luma, int y) {
  std::array<const std::uint8_t*, 5> rows;
  for (int k = 0; k < 5; ++k) {
    rows[static_cast<std::size_t>(k)] = luma.row(std::clamp(y + k - 2, 0, height_ - 1));
  }
  Int* smooth = smooth_.data() + kPadLeft;
  Int* difference = difference_.data() + kPadLeft;
  const Kernels& kernels = kernels_of(simd_);
  kernels.columns(rows.data(), smooth, difference, width_);
  for (int k = 1; k <= 2; ++k) {  // the border repeats its last pixel
    smooth[-k] = smooth[0];
    difference[-k] = difference[0];
    smooth[width_ - 1 + k] = smooth[width_ - 1];
    difference[width_ - 1 + k] = difference[width_ - 1];
  }
  Int* gx = row_of(x_, y);
  Int* gy = row_of(y_, y);
  kernels.rows(smooth, difference, gx, gy, row_of(magnitude_, y), width_);
  Gradient* out = gradients_.data() + static_cast<std::ptrdiff_t>(y) * stride_;
  for (int i = 0; i < width_; ++i) out[i] = {gx[i], gy[i]};
}

// The gradient of noise is Rayleigh distributed, whose quantile q is sigma sqrt(-2 ln(1 - q))
// [Rosin1997]; a quantile so low that edges have no part in it tells sigma.
void GradientMap::measure_noise(const ImageView& luma, double floor) {
  std::fill(histogram_.begin(), histogram_.end(), 0);
  int samples = 0;
  for (int y = kBorder; y < height_ - kBorder; y += kNoiseRowStep) {
    compute_row(luma, y);
    const Int* m = row_of(magnitude_, y);
    const std::uint8_t* levels = luma.row(y);
    for (int x = 2; x < width_ - 2; x += 2) {
      if (is_saturated(levels[x])) continue;  // without noise, whatever the sensor's is
      ++histogram_[static_cast<std::size_t>(std::min(m[x] >> kHistogramShift, kHistogramBins - 1))];
      ++samples;
    }
  }
  double quantile = 0.0;
  int below = 0;
  for (int bin = 0; bin < kHistogramBins && below <= kNoiseQuantile * samples; ++bin) {
    below += histogram_[static_cast<std::size_t>(bin)];
    quantile = (bin + 0.5) * (1 << kHistogramShift);
  }
  if (samples == 0) quantile = 0.0;
  noise_ = std::max(kLeastNoise, quantile / std::sqrt(-2.0 * std::log(1.0 - kNoiseQuantile)));
  threshold_ = std::clamp(kThresholdOverNoise * noise_, kGradientGain * floor, kLargestThreshold);
}

void GradientMap::compute(const ImageView& luma, double threshold, double floor) {
  resize(luma);
  if (luma.empty()) return;
  measure_noise(luma, floor);
  if (threshold > 0.0) threshold_ = std::min(kGradientGain * threshold, 32767.0);
  std::fill(crests_.begin(), crests_.end(), std::uint8_t{0});
  const auto least = static_cast<Int>(threshold_);
  const int inside = width_ - 2 * kBorder;
  for (int y = 1; y < height_ - 1; ++y) {
    compute_row(luma, y);
    const int row = y - 1;
    if (inside <= 0 || row < kBorder || row >= height_ - kBorder) continue;
    std::uint8_t* codes = crests_.data() + static_cast<std::ptrdiff_t>(row) * stride_;
    const CrestRows rows{row_of(x_, row) + kBorder,
                         row_of(y_, row) + kBorder,
                         row_of(magnitude_, row - 1) + kBorder,
                         row_of(magnitude_, row) + kBorder,
                         row_of(magnitude_, row + 1) + kBorder};
    kernels_of(simd_).crests(rows, codes + kBorder, least, inside);
    std::memset(codes + width_ - kBorder,
                0,
                static_cast<std::size_t>(stride_) - static_cast<std::size_t>(width_) + kBorder);
  }
}

}  // namespace ellipse
