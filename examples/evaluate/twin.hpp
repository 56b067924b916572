#pragma once  // SPDX-License-Identifier: MIT

#include <opencv2/core/mat.hpp>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// A rendered counterpart of the data set of [Keipour2021], of the same size: 1,511 frames of 640 x
/// 360, 1,378 of them with the target ("twin"), and 456 frames of a pad with a thin ring ("thin").
/// Pictures are rendered on demand and are identical on every machine.
///
/// @param ground  8-bit grey picture of the ground for all scenes; empty = each scene's own.
[[nodiscard]] std::vector<Sequence> make_twin(const cv::Mat& ground = {});

}  // namespace evaluate
