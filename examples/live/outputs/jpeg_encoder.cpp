// SPDX-License-Identifier: MIT
#include "examples/live/outputs/jpeg_encoder.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace live {
namespace {

GstElement* make_pipeline(int quality) {
  GError* problem = nullptr;
  GstElement* pipeline = gst_parse_launch(
      ("appsrc name=in format=time max-buffers=1 ! videoconvert ! jpegenc quality=" +
       std::to_string(quality) + " ! appsink name=out sync=false async=false")
          .c_str(),
      &problem);
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error(error->message);
  }
  return pipeline;
}

Picture picture_of(const Frame& frame, GstBuffer* jpeg) {
  constexpr gsize kStampSize = 8;
  const gsize size = gst_buffer_get_size(jpeg);
  auto* bytes = static_cast<guint8*>(g_malloc(kStampSize + size));
  const guint64 stamp = GUINT64_TO_LE(frame.pts);
  std::memcpy(bytes, &stamp, kStampSize);
  gst_buffer_extract(jpeg, 0, bytes + kStampSize, size);
  Picture picture{.number = frame.number, .pts = frame.pts, .arrived_us = frame.arrived_us};
  picture.stamped.reset(g_bytes_new_take(bytes, kStampSize + size));
  picture.jpeg.reset(g_bytes_new_from_bytes(picture.stamped.get(), kStampSize, size));
  return picture;
}

}  // namespace

JpegEncoder::JpegEncoder(int quality, std::function<void(Picture)> on_picture)
    : on_picture_(std::move(on_picture)),
      pipeline_(make_pipeline(quality)),
      source_(gst_bin_get_by_name(GST_BIN(pipeline_), "in")),
      wakeup_([this] { finish(); }) {
  const Ref<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline_), "out"));
  GstAppSinkCallbacks callbacks{};
  callbacks.new_sample = on_sample;
  gst_app_sink_set_callbacks(GST_APP_SINK(sink.get()), &callbacks, this, nullptr);
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  bus_watch_ = gst_bus_add_watch(bus.get(), on_message, this);
  gst_element_set_state(pipeline_, GST_STATE_PLAYING);
}

JpegEncoder::~JpegEncoder() {
  g_source_remove(bus_watch_);
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(pipeline_);
}

void JpegEncoder::encode(const FramePtr& frame) {
  frame_ = frame;
  gst_app_src_push_sample(GST_APP_SRC(source_.get()), frame->sample.get());
}

GstFlowReturn JpegEncoder::on_sample(GstAppSink* sink, gpointer data) {
  auto* self = static_cast<JpegEncoder*>(data);
  GstSample* sample = gst_app_sink_pull_sample(sink);
  {
    const std::lock_guard lock(self->mutex_);
    self->result_.reset(sample);
  }
  self->wakeup_.raise();
  return GST_FLOW_OK;
}

void JpegEncoder::finish() {
  Ref<GstSample> sample;
  {
    const std::lock_guard lock(mutex_);
    sample = std::move(result_);
  }
  if (!sample || !frame_) return;
  ++encoded_;
  const FramePtr frame = std::exchange(frame_, nullptr);
  on_picture_(picture_of(*frame, gst_sample_get_buffer(sample.get())));
}

gboolean JpegEncoder::on_message(GstBus* /*bus*/, GstMessage* message, gpointer data) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) static_cast<JpegEncoder*>(data)->recover();
  return G_SOURCE_CONTINUE;
}

void JpegEncoder::recover() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  frame_.reset();
  gst_element_set_state(pipeline_, GST_STATE_PLAYING);
}

}  // namespace live
