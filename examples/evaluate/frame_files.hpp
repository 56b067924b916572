#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

[[nodiscard]] std::size_t frames_of(const std::vector<Sequence>& sequences);

/// Frames of sequences that are rendered or read from a video.
[[nodiscard]] std::size_t frames_without_files(const std::vector<Sequence>& sequences);

/// Writes such sequences as a data set with gt.csv, and sets Frame::image. A sequence whose name is
/// taken goes into a further data set, in the folder "2" and so on.
/// @param advance  Called after each frame; false ends it early.
/// Throws std::runtime_error that names the file, where it cannot be written.
void write_files(std::vector<Sequence>& sequences,
                 const std::filesystem::path& folder,
                 const std::function<bool(const Frame&)>& advance);

/// A folder of its own that is gone in the end.
class TemporaryFolder {
 public:
  /// Throws std::runtime_error where it cannot be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace evaluate
