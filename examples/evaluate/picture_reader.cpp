// SPDX-License-Identifier: MIT
#include "examples/evaluate/picture_reader.hpp"

#include <gst/app/app.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "examples/evaluate/luma_sample.hpp"

namespace evaluate {
namespace {

constexpr GstClockTime kPictureTimeout = 3 * GST_SECOND;

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::runtime_error(file.string() + ": not a readable picture");
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(g_ascii_tolower(c));
  return extension;
}

bool is_jpeg(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".jpg" || extension == ".jpeg";
}

// Checks the markers SOI and EOI. Without SOI the decoder would wait for more data; without EOI it
// would fill in the missing part.
bool is_whole_jpeg(GBytes* bytes) {
  constexpr std::string_view kEnd = "\xff\xd9";
  gsize size = 0;
  const auto* data = static_cast<const char*>(g_bytes_get_data(bytes, &size));
  const std::string_view text(data, size);
  return text.starts_with("\xff\xd8") &&
         text.substr(size - std::min<gsize>(size, 4096)).find(kEnd) != std::string_view::npos;
}

}  // namespace

class PictureReader::JpegPipeline {
 public:
  JpegPipeline() {
    pipeline_ = gst_parse_launch(
        "appsrc name=in caps=image/jpeg,framerate=30/1 format=time ! jpegdec ! videoconvert "
        "! video/x-raw,format=GRAY8 ! appsink name=out sync=false",
        nullptr);
    if (pipeline_ == nullptr) throw std::runtime_error("the GStreamer element jpegdec is missing");
    in_ = GST_APP_SRC(gst_bin_get_by_name(GST_BIN(pipeline_), "in"));
    out_ = GST_APP_SINK(gst_bin_get_by_name(GST_BIN(pipeline_), "out"));
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
  }

  ~JpegPipeline() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(in_);
    gst_object_unref(out_);
    gst_object_unref(pipeline_);
  }

  JpegPipeline(const JpegPipeline&) = delete;
  JpegPipeline& operator=(const JpegPipeline&) = delete;

  /// Returns an empty picture if the bytes are not a JPEG.
  cv::Mat decode(GBytes* bytes) {
    if (!is_whole_jpeg(bytes)) return {};
    GstBuffer* buffer = gst_buffer_new_wrapped_bytes(bytes);
    GST_BUFFER_PTS(buffer) = time_;
    time_ += GST_SECOND / 30;
    gst_app_src_push_buffer(in_, buffer);
    GstSample* sample = gst_app_sink_try_pull_sample(out_, kPictureTimeout);
    if (sample == nullptr) return {};
    cv::Mat picture = luma_of(sample);
    gst_sample_unref(sample);
    return picture;
  }

 private:
  GstElement* pipeline_ = nullptr;
  GstAppSrc* in_ = nullptr;
  GstAppSink* out_ = nullptr;
  GstClockTime time_ = 0;
};

bool PictureReader::is_picture(const std::filesystem::path& file) {
  return is_jpeg(file) || extension_of(file) == ".png";
}

PictureReader::PictureReader() = default;

PictureReader::~PictureReader() = default;

cv::Mat PictureReader::read(const std::filesystem::path& file) {
  cv::Mat picture;
  if (!is_jpeg(file)) {
    picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  } else {
    gchar* contents = nullptr;
    gsize length = 0;
    if (!g_file_get_contents(file.c_str(), &contents, &length, nullptr)) fail(file);
    GBytes* bytes = g_bytes_new_take(contents, length);
    if (!jpeg_) jpeg_ = std::make_unique<JpegPipeline>();
    picture = jpeg_->decode(bytes);
    g_bytes_unref(bytes);
    if (picture.empty()) jpeg_.reset();  // the decoder may still wait for data of this picture
  }
  if (picture.empty()) fail(file);
  return picture;
}

}  // namespace evaluate
