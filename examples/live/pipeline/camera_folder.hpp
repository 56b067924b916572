#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>

namespace live {

/// The calibrations that clients may have read: those in one folder, or none.
class CameraFolder {
 public:
  /// @param folder  Empty = none. Throws std::filesystem::filesystem_error where there is no such.
  explicit CameraFolder(const std::filesystem::path& folder);

  [[nodiscard]] bool is_open() const { return !folder_.empty(); }

  /// @param name  Of a file, by itself or with its path.
  /// @return Its path without links. Throws std::invalid_argument where it is not in the folder,
  /// whatever is there, and where it is no calibration. Reads at most 1 MB.
  [[nodiscard]] std::string path_of(const std::string& name) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace live
