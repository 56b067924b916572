#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// What each method has to reach on each data set, where a program checks it.
struct Limits {
  std::optional<double> min_f1;
  std::optional<double> min_recall;
  std::optional<int> max_false;  ///< Frames with an answer that is wrong: FP and WD.
};

/// One text for each limit that a method does not keep on a data set; each names both. A measure
/// that is not defined, because no frame shows a target, does not keep its limit.
[[nodiscard]] std::vector<std::string> unkept_limits(const Evaluation& evaluation,
                                                     const Limits& limits);

}  // namespace evaluate
