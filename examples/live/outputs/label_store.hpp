#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <optional>
#include <string>

#include "core/geometry/ellipse.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Appends labelled frames to a data set in the format of ellipse-evaluate: `gt.csv` and `images/`.
/// Existing entries are kept.
class LabelStore {
 public:
  /// Throws std::runtime_error if the folder cannot be created.
  explicit LabelStore(std::filesystem::path folder);

  /// @param target  The true ellipse; nullopt if the frame shows no target.
  /// @return The picture's path relative to the folder. Throws std::runtime_error if the picture or
  /// the table cannot be written. The table is written last.
  std::string add(const Frame& frame, const std::optional<ellipse::Ellipse>& target);

 private:
  std::filesystem::path folder_;
  int next_ = 1;
};

}  // namespace live
