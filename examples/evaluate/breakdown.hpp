#pragma once  // SPDX-License-Identifier: MIT

#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/plots.hpp"

namespace evaluate {

/// Where each method is good and where not, on one data set: how its errors of the centre are
/// spread, and its recall by the target's size, its visible part, the noise and the crumpling. What
/// the data set does not tell, or does not vary, is left out.
[[nodiscard]] std::vector<Panel> breakdown(const Evaluation& evaluation,
                                           const std::string& dataset);

}  // namespace evaluate
