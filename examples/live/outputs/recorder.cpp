// SPDX-License-Identifier: MIT
#include "examples/live/outputs/recorder.hpp"

#include <stdexcept>
#include <utility>

#include "examples/live/outputs/frame_inlet.hpp"
#include "examples/live/outputs/h264.hpp"

namespace live {
namespace {

constexpr int kRecorderQueue = 8;  // frames; few, because they can hold buffers of a camera's pool
constexpr guint64 kMaxLines = 300;

std::filesystem::path numbered(const std::filesystem::path& file, int number) {
  if (number == 1) return file;
  std::filesystem::path result = file;
  result.replace_filename(file.stem().string() + "-" + std::to_string(number) +
                          file.extension().string());
  return result;
}

void set_location(GstElement* pipeline, const char* sink, const std::filesystem::path& file) {
  const Ref<GstElement> element(gst_bin_get_by_name(GST_BIN(pipeline), sink));
  g_object_set(element.get(), "location", file.c_str(), nullptr);
}

}  // namespace

Recorder::Recorder(std::filesystem::path file, std::function<void(const std::string&)> on_trouble)
    : file_(std::move(file)),
      on_trouble_(std::move(on_trouble)),
      other_size_([this] { send_eos(); }) {
  open();
}

Recorder::~Recorder() {
  if (pipeline_ == nullptr) return;
  takes_frames_ = false;
  send_eos();
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  GstMessage* end = gst_bus_timed_pop_filtered(
      bus.get(), 5 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  if (end != nullptr) gst_message_unref(end);
  close();
}

void Recorder::open() {
  GError* problem = nullptr;
  pipeline_ = gst_parse_launch((frame_inlet("video", kRecorderQueue) + " ! " + h264_encoder() +
                                " ! matroskamux ! filesink name=mkv "
                                "appsrc name=lines max-buffers=" +
                                std::to_string(kMaxLines) +
                                " leaky-type=downstream ! filesink name=ndjson sync=false "
                                "async=false")
                                   .c_str(),
                               &problem);
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error(error->message);
  }
  const std::filesystem::path mkv = numbered(file_, ++files_);
  set_location(pipeline_, "mkv", mkv);
  set_location(pipeline_, "ndjson", std::filesystem::path(mkv).replace_extension(".ndjson"));
  video_.reset(gst_bin_get_by_name(GST_BIN(pipeline_), "video"));
  lines_.reset(gst_bin_get_by_name(GST_BIN(pipeline_), "lines"));
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  bus_watch_ = gst_bus_add_watch(bus.get(), on_message, this);
  if (gst_element_set_state(pipeline_, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    close();
    throw std::runtime_error(mkv.string() + ": cannot be written");
  }
  width_ = 0;
  takes_frames_ = true;
}

void Recorder::close() {
  takes_frames_ = false;
  g_source_remove(bus_watch_);
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(std::exchange(pipeline_, nullptr));
}

void Recorder::send_eos() {
  gst_app_src_end_of_stream(GST_APP_SRC(video_.get()));
  gst_app_src_end_of_stream(GST_APP_SRC(lines_.get()));
}

void Recorder::put(const FramePtr& frame) {
  if (!takes_frames_) return;
  if (width_ == 0) {
    width_ = frame->width;
    height_ = frame->height;
  }
  if (frame->width != width_ || frame->height != height_) {
    takes_frames_ = false;
    other_size_.raise();
    return;
  }
  push_frame(GST_APP_SRC(video_.get()), *frame);
  GstBuffer* line = gst_buffer_new_memdup(frame->line.data(), frame->line.size());
  gst_app_src_push_buffer(GST_APP_SRC(lines_.get()), line);
}

gboolean Recorder::on_message(GstBus* /*bus*/, GstMessage* message, gpointer data) {
  auto* self = static_cast<Recorder*>(data);
  try {
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
      self->close();
      self->open();
    } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
      GError* error = nullptr;
      gst_message_parse_error(message, &error, nullptr);
      const Ref<GError> owned(error);
      self->close();
      self->on_trouble_(error->message);
    }
  } catch (const std::exception& error) {
    self->on_trouble_(error.what());
  }
  return G_SOURCE_CONTINUE;
}

}  // namespace live
