#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// How long each scene is shown, and how often it is looked at.
struct ScenePace {
  double seconds = 20.0;
  double frames_per_second = 30.0;
};

/// The seeds of "KIND:SEED", where several are separated by commas and FROM-TO is a range; nullopt
/// where the text is none of the kind. Throws std::invalid_argument that names the text, where it
/// begins so and goes on otherwise, or gives more seeds than `most`.
[[nodiscard]] std::optional<std::vector<std::uint64_t>> scene_seeds(
    const std::string& text, const std::string& kind = "scenes", std::size_t most = 1000);

/// Every scene of the catalog with each seed, as sequences "approach-901" and so on of the data set
/// "scenes": each from its beginning, without a gap. Nothing is rendered before it is asked for.
/// Throws std::invalid_argument where the pace gives no frame.
[[nodiscard]] std::vector<Sequence> make_scenes(const std::vector<std::uint64_t>& seeds,
                                                const ScenePace& pace);

/// The scene without a pad on each ground that is full of what resembles one, as sequences
/// "flowers-901" and so on of the data set "clutter". Throws as make_scenes().
[[nodiscard]] std::vector<Sequence> make_clutter(const std::vector<std::uint64_t>& seeds,
                                                 const ScenePace& pace);

/// The same through each lens that has a name, as sequences "approach-barrel-901" and so on of the
/// data set "distorted".
[[nodiscard]] std::vector<Sequence> make_distorted(const std::vector<std::uint64_t>& seeds,
                                                   const ScenePace& pace);

}  // namespace evaluate
