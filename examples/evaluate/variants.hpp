#pragma once  // SPDX-License-Identifier: MIT

#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Names of the variants, in order of documentation: "flip-x", "noise", ...
[[nodiscard]] std::vector<std::string> variant_names();

/// What each variant does to a picture, separated by semicolons.
[[nodiscard]] std::string describe_variants();

/// Copies of sequences with altered pictures and accordingly transformed truth. Each copy belongs
/// to a data set of its own, "NAME VARIANT". The noise of a frame depends only on its number.
/// Pictures are altered when they are requested; variants that flip or rotate read each picture
/// here too, to get its size.
///
/// Throws std::invalid_argument that names an unknown variant, or a sequence with a distorting lens
/// if the variant moves pixels.
[[nodiscard]] std::vector<Sequence> variants_of(const std::vector<Sequence>& sequences,
                                                const std::vector<std::string>& names);

}  // namespace evaluate
