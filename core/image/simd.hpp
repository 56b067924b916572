#pragma once  // SPDX-License-Identifier: MIT

// Hot loops are written once, inlined into a function for every processor and into one for those
// with wider registers; the compiler does the rest.
#if defined(__x86_64__) && defined(__GNUC__)
#define ELLIPSE_AVX2 __attribute__((target("avx2")))
#else
#define ELLIPSE_AVX2
#endif
#define ELLIPSE_INLINE inline __attribute__((always_inline))

namespace ellipse {

/// Which instructions the hot loops use. All give the same numbers.
enum class Simd { kBaseline, kAvx2 };

/// The best that this processor has.
[[nodiscard]] Simd best_simd();

}  // namespace ellipse
