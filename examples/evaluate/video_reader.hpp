#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace evaluate {

/// The file beside a data set's table that holds the frames of a folder of images: same name, with
/// the extension of a video. nullopt where there is none.
[[nodiscard]] std::optional<std::filesystem::path> video_of(
    const std::filesystem::path& dataset_folder, const std::string& name);

/// Decodes a video to luma, frame by frame, as a GStreamer pipeline sees it. gst_init() must have
/// been called.
class VideoReader {
 public:
  /// Opens nothing yet.
  explicit VideoReader(std::filesystem::path file);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  /// The time of each frame [ns] in the order of decoding. Decodes the whole video.
  /// Throws std::runtime_error that names the file, where it cannot be decoded to its end.
  [[nodiscard]] std::vector<std::int64_t> frame_times_ns();

  /// The n-th decoded frame, from 0. Cheap in ascending order; going back starts over.
  /// Throws std::runtime_error that names the file, where it has no such frame.
  [[nodiscard]] cv::Mat read(std::size_t number);

 private:
  class Pipeline;

  std::filesystem::path file_;
  std::unique_ptr<Pipeline> pipeline_;
  std::size_t next_ = 0;  // number of the frame that the pipeline gives next
};

}  // namespace evaluate
