#pragma once  // SPDX-License-Identifier: MIT

#include "core/image/simd.hpp"

namespace ellipse {

/// Arc tangent of 0 <= x <= 1 [rad] in single precision, within 2e-7 [Abramowitz1964] 4.4.49.
/// Without branches, so that the compiler vectorizes loops.
ELLIPSE_INLINE float arc_tangent_of_share(float x) {
  const float s = x * x;
  float sum = 0.0028662257F;
  sum = sum * s - 0.0161657367F;
  sum = sum * s + 0.0429096138F;
  sum = sum * s - 0.0752896400F;
  sum = sum * s + 0.1065626393F;
  sum = sum * s - 0.1420889944F;
  sum = sum * s + 0.1999355085F;
  sum = sum * s - 0.3333314528F;
  return x + x * s * sum;
}

}  // namespace ellipse
