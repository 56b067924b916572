#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace evaluate {

/// Reads pictures as grey levels. JPEG goes through GStreamer's jpegdec and videoconvert, so that
/// the tracker sees the very pixels that it sees in a pipeline: decoders differ by a level or two.
/// gst_init() must have been called.
class PictureReader {
 public:
  PictureReader();
  ~PictureReader();
  PictureReader(const PictureReader&) = delete;
  PictureReader& operator=(const PictureReader&) = delete;

  /// Whether a file's name is that of a JPEG or PNG picture.
  [[nodiscard]] static bool is_picture(const std::filesystem::path& file);

  /// A JPEG that is cut off is none. Throws std::runtime_error that names the file, where it is no
  /// picture that can be read.
  [[nodiscard]] cv::Mat read(const std::filesystem::path& file);

 private:
  class JpegPipeline;
  std::unique_ptr<JpegPipeline> jpeg_;
};

}  // namespace evaluate
