#pragma once  // SPDX-License-Identifier: MIT

// Hot loops are written once and inlined into a baseline and an AVX2 function, which the compiler
// vectorizes.
#if defined(__x86_64__) && defined(__GNUC__)
#define ELLIPSE_AVX2 __attribute__((target("avx2")))
#else
#define ELLIPSE_AVX2
#endif
#define ELLIPSE_INLINE inline __attribute__((always_inline))

// Placed before a loop, states that its arrays do not overlap. Without it, compilers do not
// vectorize a loop over many arrays, because they would have to check each pair for overlap.
#if defined(__clang__)
#define ELLIPSE_NO_ALIAS _Pragma("clang loop vectorize(assume_safety)")
#else
#define ELLIPSE_NO_ALIAS _Pragma("GCC ivdep")
#endif

namespace ellipse {

/// Instruction set of the hot loops. All give the same results.
enum class Simd { kBaseline, kAvx2 };

/// The best set that this processor supports.
[[nodiscard]] Simd best_simd();

}  // namespace ellipse
