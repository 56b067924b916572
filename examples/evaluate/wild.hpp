#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Random scenes with these seeds, as sequences "pad-17" (theme and seed) and so on of the data set
/// "wild". Each has its own picture size and frame rate, and lists all true ellipses of each frame.
/// Pictures are rendered on demand.
/// @param seconds  Duration of each; 0 = one frame.
[[nodiscard]] std::vector<Sequence> make_wild(const std::vector<std::uint64_t>& seeds,
                                              double seconds);

/// Parses "wild:SEEDS" for sequences or "wild-frames:SEEDS" for single frames; nullopt if the text
/// is neither. Seeds as in scene_seeds(), at most 100,000.
[[nodiscard]] std::optional<std::vector<Sequence>> wild_by_name(const std::string& text,
                                                                double seconds);

}  // namespace evaluate
