// SPDX-License-Identifier: MIT
#include "examples/evaluate/video_reader.hpp"

#include <gst/app/app.h>
#include <gst/gst.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "examples/evaluate/luma_sample.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

constexpr GstClockTime kStallTimeout = 20 * GST_SECOND;
constexpr GstClockTime kErrorInterval =
    GST_SECOND / 10;  // between checks for errors, which do not end the wait

constexpr std::array kExtensions = {
    ".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", ".ogv", ".mpg", ".mpeg", ".ts"};

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

}  // namespace

// decodebin has one thread per stream, so the pipeline blocks on the sink's queue of one buffer
// until the next frame is requested.
class VideoReader::Pipeline {
 public:
  explicit Pipeline(const fs::path& file) : file_(file) {
    GError* error = nullptr;
    pipeline_ = gst_parse_launch(
        "filesrc name=in ! decodebin ! videoconvert ! video/x-raw,format=I420 ! "
        "appsink name=out sync=false max-buffers=1",
        &error);
    if (error != nullptr) {
      const std::string what = error->message;
      g_error_free(error);
      if (pipeline_ != nullptr) gst_object_unref(pipeline_);
      fail(file_, what);
    }
    GstElement* in = gst_bin_get_by_name(GST_BIN(pipeline_), "in");
    g_object_set(in, "location", file.c_str(), nullptr);
    gst_object_unref(in);
    out_ = GST_APP_SINK(gst_bin_get_by_name(GST_BIN(pipeline_), "out"));
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
  }

  ~Pipeline() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(out_);
    gst_object_unref(pipeline_);
  }

  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Owned by the caller; nullptr after the last frame.
  GstSample* next() {
    for (GstClockTime waited = 0; waited < kStallTimeout; waited += kErrorInterval) {
      GstSample* sample = gst_app_sink_try_pull_sample(out_, kErrorInterval);
      if (sample != nullptr) return sample;
      throw_error();
      if (gst_app_sink_is_eos(out_)) return nullptr;
    }
    fail(file_, "contains no frame");
  }

 private:
  void throw_error() {
    GstBus* bus = gst_element_get_bus(pipeline_);
    GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    gst_object_unref(bus);
    if (message == nullptr) return;
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    const std::string what = error->message;
    g_error_free(error);
    gst_message_unref(message);
    fail(file_, what);
  }

  const fs::path& file_;
  GstElement* pipeline_ = nullptr;
  GstAppSink* out_ = nullptr;
};

std::optional<fs::path> video_of(const fs::path& dataset_folder, const std::string& name) {
  for (const char* extension : kExtensions) {
    const fs::path file = dataset_folder / (name + extension);
    if (fs::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

VideoReader::VideoReader(fs::path file) : file_(std::move(file)) {}

VideoReader::~VideoReader() = default;

std::vector<std::int64_t> VideoReader::frame_times_ns() {
  std::vector<std::int64_t> times;
  Pipeline pipeline(file_);
  while (GstSample* sample = pipeline.next()) {
    const GstClockTime pts = GST_BUFFER_PTS(gst_sample_get_buffer(sample));
    gst_sample_unref(sample);
    if (!GST_CLOCK_TIME_IS_VALID(pts)) fail(file_, "contains a frame without a time stamp");
    times.push_back(static_cast<std::int64_t>(pts));
  }
  return times;
}

cv::Mat VideoReader::read(std::size_t number) {
  if (!pipeline_ || number < next_) {
    pipeline_ = std::make_unique<Pipeline>(file_);
    next_ = 0;
  }
  while (GstSample* sample = pipeline_->next()) {
    cv::Mat picture;
    if (next_ == number) picture = luma_of(sample);
    gst_sample_unref(sample);
    if (next_++ < number) continue;
    if (picture.empty()) fail(file_, "frame " + std::to_string(number) + " cannot be decoded");
    return picture;
  }
  fail(file_, "contains no frame " + std::to_string(number));
}

}  // namespace evaluate
