#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// The random scenes of these seeds, as sequences "pad-17" and so on of the data set "wild": theme
/// and seed. Each has its own picture size and frame rate, and all true ellipses of each frame.
/// Nothing is rendered before it is asked for.
/// @param seconds  Length of each; 0 = one frame.
[[nodiscard]] std::vector<Sequence> make_wild(const std::vector<std::uint64_t>& seeds,
                                              double seconds);

/// The sequences of "wild:SEEDS", or the single frames of "wild-frames:SEEDS"; nullopt where the
/// text is neither. Seeds are as in scene_seeds(), up to 100,000 of them.
[[nodiscard]] std::optional<std::vector<Sequence>> wild_by_name(const std::string& text,
                                                                double seconds);

}  // namespace evaluate
