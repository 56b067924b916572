#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace evaluate {

/// Reads pictures as grey levels. JPEGs are decoded by GStreamer's jpegdec and videoconvert, so
/// that the tracker receives the same pixels as in a pipeline; decoders differ by one or two
/// levels. Requires gst_init().
class PictureReader {
 public:
  PictureReader();
  ~PictureReader();
  PictureReader(const PictureReader&) = delete;
  PictureReader& operator=(const PictureReader&) = delete;

  /// Whether the file name has the extension of a JPEG or PNG.
  [[nodiscard]] static bool is_picture(const std::filesystem::path& file);

  /// Reads a picture. Throws std::runtime_error that names a file that cannot be read, including
  /// truncated JPEGs.
  [[nodiscard]] cv::Mat read(const std::filesystem::path& file);

 private:
  class JpegPipeline;
  std::unique_ptr<JpegPipeline> jpeg_;
};

}  // namespace evaluate
