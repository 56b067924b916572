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

/// The videos next to a data set's table, and which of their frames the table names.
class VideoFrames {
 public:
  /// A frame of a video.
  struct VideoFrame {
    std::size_t number = 0;
    std::int64_t pts_ns = 0;
  };

  explicit VideoFrames(std::filesystem::path dataset_folder)
      : dataset_folder_(std::move(dataset_folder)) {}

  /// The video frame that an image such as images/eye/frame_0012.png denotes; nullopt if the
  /// image's folder has no video. Throws std::runtime_error that names the video if it has no such
  /// frame or cannot be decoded.
  [[nodiscard]] std::optional<VideoFrame> find(const std::filesystem::path& image);

  /// The pictures of an image's folder; nullptr if the folder has no video.
  [[nodiscard]] std::shared_ptr<PictureSource> pictures_of(
      const std::filesystem::path& image_folder) const;

  /// One message per video with frames that were not requested by find().
  [[nodiscard]] std::vector<std::string> unnamed_frames() const;

 private:
  struct Video {
    std::filesystem::path file;
    std::vector<std::int64_t> times_ns;
    std::vector<bool> is_named;
    std::string error;  // decoding error
  };

  [[nodiscard]] Video* video_of_folder(const std::filesystem::path& image_folder);

  std::filesystem::path dataset_folder_;
  std::map<std::filesystem::path, std::optional<Video>> videos_;  // by image folder
};

}  // namespace evaluate
