#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Writes `index.html` to a folder: a self-contained page with tables, plots and the worst frames
/// of the first method.
///
/// @param command   The command line that produced the results.
/// @param problems  Messages about skipped frames, shown at the top.
///
/// Throws std::runtime_error if it cannot be written or gnuplot is missing.
void write_report(const Evaluation& evaluation,
                  const std::string& command,
                  const std::vector<std::string>& problems,
                  const std::filesystem::path& folder);

}  // namespace evaluate
