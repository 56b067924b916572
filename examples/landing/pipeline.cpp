// SPDX-License-Identifier: MIT
#include "examples/landing/pipeline.hpp"

#include <gst/app/app.h>

#include <stdexcept>

namespace landing {
namespace {

constexpr GstClockTime kTimeout = 60 * GST_SECOND;
constexpr GstClockTime kQueuePoll = 2 * GST_MSECOND;  // between checks of a full queue
constexpr GstClockTime kBusPoll =
    100 * GST_MSECOND;  // wait for a picture between checks of the bus
constexpr guint64 kQueued = 4;

[[noreturn]] void raise(GError* error) {
  const std::runtime_error failure(error->message);
  g_error_free(error);
  throw failure;
}

struct BufferDeleter {
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
};
using BufferHolder = std::unique_ptr<GstBuffer, BufferDeleter>;

}  // namespace

Pipeline::Pipeline(const std::string& line) {
  GError* error = nullptr;
  pipeline_ = gst_parse_launch_full(line.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error);
  if (error != nullptr) raise(error);
}

Pipeline::~Pipeline() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(pipeline_);
}

Element Pipeline::element(const char* name) const {
  return Element(gst_bin_get_by_name(GST_BIN(pipeline_), name));
}

void Pipeline::play() {
  if (gst_element_set_state(pipeline_, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) fail();
}

// A blocking appsrc would wait forever after an element downstream has failed.
void Pipeline::push(const Element& source, GstBuffer* buffer) {
  BufferHolder held(buffer);
  GstAppSrc* queue = GST_APP_SRC(source.get());
  for (GstClockTime waited = 0; gst_app_src_get_current_level_buffers(queue) >= kQueued;
       waited += kQueuePoll) {
    if (has_ended(kQueuePoll)) throw std::runtime_error("the pipeline has ended");
    if (waited > kTimeout) throw std::runtime_error("the pipeline has stalled");
  }
  if (gst_app_src_push_buffer(queue, held.release()) != GST_FLOW_OK) fail();
}

// A blocking appsink would wait forever after an element upstream has failed.
Sample Pipeline::pull(const Element& sink) {
  for (GstClockTime waited = 0; waited <= kTimeout; waited += kBusPoll) {
    Sample sample(gst_app_sink_try_pull_sample(GST_APP_SINK(sink.get()), kBusPoll));
    if (sample) return sample;
    if (has_ended(0)) throw std::runtime_error("the pipeline has ended");
  }
  throw std::runtime_error("the pipeline has stalled");
}

void Pipeline::await_end() {
  if (!has_ended(kTimeout))
    throw std::runtime_error("the pipeline does not reach the end of the stream");
}

bool Pipeline::has_ended(GstClockTime patience) {
  GstBus* bus = gst_element_get_bus(pipeline_);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, patience, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  if (message == nullptr) return false;
  GError* error = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message, &error, nullptr);
  }
  gst_message_unref(message);
  if (error != nullptr) raise(error);
  return true;
}

void Pipeline::fail() {
  await_end();
  throw std::runtime_error("the pipeline has ended");
}

}  // namespace landing
