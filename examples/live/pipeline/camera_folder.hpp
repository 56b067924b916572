#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>

namespace live {

/// The folder of camera calibrations that clients may select. Without a folder, they cannot select
/// any.
class CameraFolder {
 public:
  /// @param folder  Empty = none. Throws std::filesystem::filesystem_error if it does not exist.
  explicit CameraFolder(const std::filesystem::path& folder);

  [[nodiscard]] bool is_open() const { return !folder_.empty(); }

  /// @param name  A file name in the folder, or a path to a file in it.
  /// @return The canonical path. Throws std::invalid_argument if the file is not in the folder or
  /// is not a calibration. The message does not reveal whether a file outside exists. Reads at most
  /// 1 MB.
  [[nodiscard]] std::string path_of(const std::string& name) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace live
