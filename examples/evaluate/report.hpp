#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Writes `index.html` into a folder: one page with everything in it, tables, plots and the worst
/// frames of the first method.
///
/// @param command   The line that gave the figures.
/// @param problems  Shown at the top: what the figures do not cover.
/// Throws std::runtime_error where it cannot be written, or gnuplot is not there.
void write_report(const Evaluation& evaluation,
                  const std::string& command,
                  const std::vector<std::string>& problems,
                  const std::filesystem::path& folder);

}  // namespace evaluate
