// SPDX-License-Identifier: MIT
#include "core/image/simd.hpp"

namespace ellipse {

Simd best_simd() {
#if defined(__x86_64__) && defined(__GNUC__)
  return __builtin_cpu_supports("avx2") ? Simd::kAvx2 : Simd::kBaseline;
#else
  return Simd::kBaseline;
#endif
}

}  // namespace ellipse
