#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

[[nodiscard]] std::size_t frames_of(const std::vector<Sequence>& sequences);

/// Number of frames that are rendered or decoded from a video.
[[nodiscard]] std::size_t frames_without_files(const std::vector<Sequence>& sequences);

/// Writes such sequences as a data set with gt.csv and sets Frame::image. Sequences with a name
/// already used are written to further data sets in the folders "2", "3" ...
/// @param advance  Called after each frame; returning false stops early.
/// Throws std::runtime_error that names a file that cannot be written.
void write_files(std::vector<Sequence>& sequences,
                 const std::filesystem::path& folder,
                 const std::function<bool(const Frame&)>& advance);

/// A temporary folder, removed by the destructor.
class TemporaryFolder {
 public:
  /// Throws std::runtime_error if it cannot be created.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace evaluate
