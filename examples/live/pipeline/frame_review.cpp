// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/frame_review.hpp"

#include <utility>

namespace live {

FrameReview::FrameReview(Answer answer)
    : answer_(std::move(answer)), wakeup_([this] { finish(); }) {}

FrameReview::~FrameReview() {
  stop();
}

void FrameReview::begin(const FramePtr& frame, const Properties& properties) {
  pipeline_ = gst_parse_launch(
      "appsrc name=in format=time ! ellipsetrack name=track ! appsink name=out sync=false",
      nullptr);
  const auto part = [this](const char* name) {
    return Ref<GstElement>(gst_bin_get_by_name(GST_BIN(pipeline_), name));
  };
  properties.copy_to(part("track").get());
  GstAppSinkCallbacks callbacks{};
  callbacks.new_preroll = on_sample;
  const Ref<GstElement> sink = part("out");
  gst_app_sink_set_callbacks(GST_APP_SINK(sink.get()), &callbacks, this, nullptr);
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  bus_watch_ = gst_bus_add_watch(bus.get(), on_message, this);
  frame_ = frame;
  gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  const Ref<GstSample> input(gst_sample_new(
      frame->input.get(), gst_sample_get_caps(frame->sample.get()), nullptr, nullptr));
  const Ref<GstElement> source = part("in");
  gst_app_src_push_sample(GST_APP_SRC(source.get()), input.get());
}

GstFlowReturn FrameReview::on_sample(GstAppSink* sink, gpointer data) {
  auto* self = static_cast<FrameReview*>(data);
  {
    const std::lock_guard lock(self->mutex_);
    self->result_.reset(gst_app_sink_pull_preroll(sink));
  }
  self->wakeup_.raise();
  return GST_FLOW_OK;
}

gboolean FrameReview::on_message(GstBus* /*bus*/, GstMessage* message, gpointer data) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    static_cast<FrameReview*>(data)->wakeup_.raise();
  }
  return G_SOURCE_CONTINUE;
}

void FrameReview::finish() {
  if (!is_busy()) return;
  stop();
  const FramePtr before = std::exchange(frame_, nullptr);
  const Ref<GstSample> sample = std::move(result_);
  answer_(before,
          sample ? make_frame(sample.get(),
                              Ref<GstBuffer>(gst_buffer_ref(before->input.get())),
                              before->index,
                              before->arrived_us)
                 : nullptr);
}

void FrameReview::stop() {
  if (pipeline_ == nullptr) return;
  g_source_remove(bus_watch_);
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(std::exchange(pipeline_, nullptr));
}

}  // namespace live
