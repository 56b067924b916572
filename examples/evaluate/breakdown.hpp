#pragma once  // SPDX-License-Identifier: MIT

#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/plots.hpp"

namespace evaluate {

/// Plots of each method's performance on one data set: distribution of the centre error, and recall
/// by target size, visible part, noise and edge deformation. Omits quantities that the data set
/// does not specify or vary.
[[nodiscard]] std::vector<Panel> breakdown(const Evaluation& evaluation,
                                           const std::string& dataset);

}  // namespace evaluate
