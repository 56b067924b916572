#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// A frame to be looked at.
struct Exhibit {
  std::string caption;
  cv::Mat picture;  ///< Colour; the truth in green, the answer in orange.
};

/// The worst frames of one method on one data set: wrong, false and missed ones, spread over the
/// sequences, then right ones with the largest error of the centre.
[[nodiscard]] std::vector<Exhibit> worst_frames(const Evaluation& evaluation,
                                                std::size_t method,
                                                const std::string& dataset,
                                                std::size_t most);

}  // namespace evaluate
