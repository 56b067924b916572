#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// A frame for visual inspection.
struct Exhibit {
  std::string caption;
  cv::Mat picture;  ///< Colour; truth in green, answer in orange.
};

/// The worst frames of one method on one data set: wrong, false and missed answers, spread over the
/// sequences, followed by right ones with the largest centre error.
[[nodiscard]] std::vector<Exhibit> worst_frames(const Evaluation& evaluation,
                                                std::size_t method,
                                                const std::string& dataset,
                                                std::size_t max_count);

}  // namespace evaluate
