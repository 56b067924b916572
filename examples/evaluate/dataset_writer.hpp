#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Writes the pictures and `gt.csv`, from which read_dataset() gives the same frames.
/// @param advance  Called after each frame; false ends it early.
/// Throws std::runtime_error that names the file, where it cannot be written.
void write_dataset(const std::vector<Sequence>& sequences,
                   const std::filesystem::path& folder,
                   const std::function<bool(const Frame&)>& advance);

}  // namespace evaluate
