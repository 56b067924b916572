#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// The videos that lie beside a data set's table, and which of their frames it names.
class VideoFrames {
 public:
  /// A frame of a video.
  struct Place {
    std::size_t number = 0;
    std::int64_t pts_ns = 0;
  };

  explicit VideoFrames(std::filesystem::path dataset_folder)
      : dataset_folder_(std::move(dataset_folder)) {}

  /// The frame that an image such as images/eye/frame_0012.png stands for; nullopt where there is
  /// no video of the image's folder. Throws std::runtime_error that names the video, where it has
  /// no such frame or cannot be decoded.
  [[nodiscard]] std::optional<Place> find(const std::filesystem::path& image);

  /// What gives the pictures of an image's folder; nullptr where that is no video's.
  [[nodiscard]] std::shared_ptr<PictureSource> pictures_of(
      const std::filesystem::path& image_folder) const;

  /// One line for each video with frames that find() was not asked for.
  [[nodiscard]] std::vector<std::string> unnamed_frames() const;

 private:
  struct Video {
    std::filesystem::path file;
    std::vector<std::int64_t> times_ns;
    std::vector<bool> is_named;
    std::string error;  // why it cannot be decoded
  };

  [[nodiscard]] Video* video_of_folder(const std::filesystem::path& image_folder);

  std::filesystem::path dataset_folder_;
  std::map<std::filesystem::path, std::optional<Video>> videos_;  // by the images' folder
};

}  // namespace evaluate
