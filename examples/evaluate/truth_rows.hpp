#pragma once  // SPDX-License-Identifier: MIT

#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/rows.hpp"

namespace evaluate {

/// Reads the ellipse in a row of gt.csv; none if all its fields are empty. Throws RowError.
[[nodiscard]] Truth truth_of_csv(const Row& row);

/// Reads the ellipse in a row of a ground_truth.txt: full axes, width <= height, the angle is that
/// of the width [degrees]. Throws RowError.
[[nodiscard]] Truth truth_of_published(const Row& row);

}  // namespace evaluate
