#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Required results of each method on each data set.
struct Limits {
  std::optional<double> min_f1;
  std::optional<double> min_recall;
  std::optional<int> max_false;  ///< Frames with a wrong answer: FP and WD.
};

/// One message per violated limit, with method and data set. A measure that is undefined because no
/// frame shows a target violates its limit.
[[nodiscard]] std::vector<std::string> violated_limits(const Evaluation& evaluation,
                                                       const Limits& limits);

}  // namespace evaluate
