#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Writes the pictures and a `gt.csv`, which read_dataset() reads back as the same frames.
/// @param advance  Called after each frame; returning false stops early.
/// Throws std::runtime_error that names a file that cannot be written.
void write_dataset(const std::vector<Sequence>& sequences,
                   const std::filesystem::path& folder,
                   const std::function<bool(const Frame&)>& advance);

}  // namespace evaluate
