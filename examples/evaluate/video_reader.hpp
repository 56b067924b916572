#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace evaluate {

/// The video next to a data set's table that contains the frames of an image folder: the same name
/// with a video extension. nullopt if there is none.
[[nodiscard]] std::optional<std::filesystem::path> video_of(
    const std::filesystem::path& dataset_folder, const std::string& name);

/// Decodes a video to luma frame by frame, as in a GStreamer pipeline. Requires gst_init().
class VideoReader {
 public:
  /// Does not open the file.
  explicit VideoReader(std::filesystem::path file);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  /// Timestamps of all frames [ns] in decoding order. Decodes the whole video.
  /// Throws std::runtime_error that names a file that cannot be decoded to its end.
  [[nodiscard]] std::vector<std::int64_t> frame_times_ns();

  /// The n-th decoded frame, from 0. Fast in ascending order; going back restarts decoding.
  /// Throws std::runtime_error that names the file if it has no such frame.
  [[nodiscard]] cv::Mat read(std::size_t number);

 private:
  class Pipeline;

  std::filesystem::path file_;
  std::unique_ptr<Pipeline> pipeline_;
  std::size_t next_ = 0;  // number of the pipeline's next frame
};

}  // namespace evaluate
