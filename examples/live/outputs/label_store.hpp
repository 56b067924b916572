#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <optional>
#include <string>

#include "core/geometry/ellipse.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// A data set that grows by one picture with its truth at a time, in the form that ellipse-evaluate
/// reads: `gt.csv` and `images/`. What is there already stays.
class LabelStore {
 public:
  /// Throws std::runtime_error where the folder cannot be made.
  explicit LabelStore(std::filesystem::path folder);

  /// @param target  As the person said; nullopt where the picture shows none.
  /// @return The picture's name inside the folder. Throws std::runtime_error where it cannot be
  ///         written; then there is no new line in the table.
  std::string add(const Frame& frame, const std::optional<ellipse::Ellipse>& target);

 private:
  std::filesystem::path folder_;
  int next_ = 1;
};

}  // namespace live
