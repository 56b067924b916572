#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Duration and frame rate of each scene.
struct ScenePace {
  double seconds = 20.0;
  double frames_per_second = 30.0;
};

/// Parses the seeds of "KIND:SEED", where commas separate several and FROM-TO is a range; nullopt
/// if the text does not start with the kind. Throws std::invalid_argument that quotes the text if
/// the seeds are invalid or more than `limit`.
[[nodiscard]] std::optional<std::vector<std::uint64_t>> scene_seeds(
    const std::string& text, const std::string& kind = "scenes", std::size_t limit = 1000);

/// Every scene of the catalog with each seed, as sequences "approach-901" and so on of the data set
/// "scenes". Each starts at its beginning and is continuous. Pictures are rendered on demand.
/// Throws std::invalid_argument if the pace gives no frame.
[[nodiscard]] std::vector<Sequence> make_scenes(const std::vector<std::uint64_t>& seeds,
                                                const ScenePace& pace);

/// One scene of the catalog: "scenes-negative:41-46" gives sequences "negative-41" and so on of the
/// data set "scenes-negative". nullopt if the text does not start with the name of such a data set.
/// Throws as scene_seeds() and make_scenes().
[[nodiscard]] std::optional<std::vector<Sequence>> one_scene_by_name(const std::string& text,
                                                                     const ScenePace& pace);

/// The scene without a pad on each ground that contains pad-like objects, as sequences
/// "flowers-901" and so on of the data set "clutter". Throws as make_scenes().
[[nodiscard]] std::vector<Sequence> make_clutter(const std::vector<std::uint64_t>& seeds,
                                                 const ScenePace& pace);

/// All scenes through each named lens, as sequences "approach-barrel-901" and so on of the data set
/// "distorted". Throws as make_scenes().
[[nodiscard]] std::vector<Sequence> make_distorted(const std::vector<std::uint64_t>& seeds,
                                                   const ScenePace& pace);

}  // namespace evaluate
