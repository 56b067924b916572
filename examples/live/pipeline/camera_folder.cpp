// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/camera_folder.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "core/camera/camera_file.hpp"

namespace live {

namespace fs = std::filesystem;

CameraFolder::CameraFolder(const fs::path& folder)
    : folder_(folder.empty() ? folder : fs::canonical(folder)) {}

std::string CameraFolder::path_of(const std::string& name) const {
  if (!is_open()) {
    throw std::invalid_argument("camera-file: requires --cameras FOLDER, and a file from it");
  }
  std::error_code error;
  const fs::path path = fs::canonical(folder_ / name, error);
  const bool is_inside =
      !error && std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first ==
                    folder_.end();
  // Opening a FIFO would block.
  if (!is_inside || !fs::is_regular_file(path, error)) {
    throw std::invalid_argument("camera-file: no such file in the folder of --cameras");
  }
  try {
    (void)ellipse::read_camera(path.string());
  } catch (const std::invalid_argument& problem) {
    throw std::invalid_argument(std::string("camera-file: ") + problem.what());
  }
  return path.string();
}

}  // namespace live
