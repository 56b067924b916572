#pragma once  // SPDX-License-Identifier: MIT

#include "core/geometry/ellipse.hpp"
#include "examples/evaluate/measures.hpp"

namespace evaluate {

/// A frame [px] and a target in it, for tests of the measures.
inline constexpr FrameSize kFrame{320, 240};
inline constexpr ellipse::Ellipse kTarget{160.0, 120.0, 50.0, 40.0, 0.3};

}  // namespace evaluate
