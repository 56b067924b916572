#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/ellipse.hpp"

namespace evaluate {

/// What a frame shows, according to its data set.
struct Truth {
  /// The target's outer edge [px]. nullopt where the frame shows none.
  std::optional<ellipse::Ellipse> target;
  /// Share of the perimeter inside the frame. nullopt where the data set does not say.
  std::optional<double> visible_fraction;
  /// False where the target is known to be there, but not where: such a frame is not judged.
  bool is_labelled = true;
};

struct Frame {
  std::filesystem::path image;  ///< To be read.
  std::string name;             ///< As "sequence/file", for people and for other programs.
  Truth truth;
};

/// Frames that follow each other in time.
struct Sequence {
  std::string name;
  std::vector<Frame> frames;  ///< In the natural order of their file names.
};

/// Reads a data set from a folder with `gt.csv` (columns image, cx, cy, semi_major, semi_minor,
/// angle_rad and, if there, visible_fraction; images named relative to the folder), or with the
/// `ground_truth.txt` of the published AirLab data set, in the folder itself or in folders below.
///
/// Throws std::runtime_error that names the file and the line, where something cannot be read.
[[nodiscard]] std::vector<Sequence> read_dataset(const std::filesystem::path& folder);

}  // namespace evaluate
