#pragma once  // SPDX-License-Identifier: MIT

#include <span>
#include <vector>

#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/resampling.hpp"

namespace evaluate {

/// Comparison of all ellipses found in a frame with all true ones.
struct AllResult {
  FrameCounts counts;  ///< Counts ellipses, not frames.
  std::vector<double> centre_errors_px;
  /// Per match, the larger error of the two semi-axes.
  std::vector<double> axis_errors_px;
};

/// Matches found and true ellipses one to one at an intersection over union of at least kMinIou,
/// with as many matches as possible. A true ellipse with less than kMinVisible of its perimeter in
/// the frame may be missed; an ellipse that matches it counts neither as right nor as mistaken.
/// Frames that are not judged are not counted.
[[nodiscard]] AllResult compare_all(std::span<const ellipse::Ellipse> found,
                                    const Truth& truth,
                                    const FrameSize& frame);

}  // namespace evaluate
