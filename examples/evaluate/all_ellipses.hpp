#pragma once  // SPDX-License-Identifier: MIT

#include <span>
#include <vector>

#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/resampling.hpp"

namespace evaluate {

/// How all ellipses that a method found in a frame compare with all that are true.
struct AllResult {
  FrameCounts counts;  ///< Of ellipses.
  std::vector<double> centre_errors_px;
  /// The larger of the two differences between semi-axes.
  std::vector<double> axis_errors_px;
};

/// Matches found and true ellipses one to one at an intersection over union of kMinIou and more,
/// as many as possible. A true ellipse with less than kMinVisible of its perimeter in the frame
/// may be missed; a found one that matches it is neither right nor mistaken. Nothing counts where
/// the frame is not judged.
[[nodiscard]] AllResult compare_all(std::span<const ellipse::Ellipse> found,
                                    const Truth& truth,
                                    const FrameSize& frame);

}  // namespace evaluate
