// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/frame_tap.hpp"

#include <utility>

namespace live {

FrameTap::FrameTap(GstElement* tracker, GstAppSink* sink, FrameSink on_frame)
    : on_frame_(std::move(on_frame)) {
  // The queue holds at most one buffer, which on_sample() takes immediately.
  g_object_set(sink, "max-buffers", 1, "drop", TRUE, "enable-last-sample", FALSE, nullptr);
  GstAppSinkCallbacks callbacks{};
  callbacks.new_sample = on_sample;
  callbacks.new_preroll = on_preroll;
  gst_app_sink_set_callbacks(sink, &callbacks, this, nullptr);
  const Ref<GstPad> pad(gst_element_get_static_pad(tracker, "sink"));
  gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, on_arrival, this, nullptr);
}

// There is no queue between tracker and sink, so this buffer is the sink's next one.
GstPadProbeReturn FrameTap::on_arrival(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer data) {
  auto* self = static_cast<FrameTap*>(data);
  self->arrived_us_ = g_get_monotonic_time();
  self->input_.reset(gst_buffer_ref(GST_PAD_PROBE_INFO_BUFFER(info)));
  return GST_PAD_PROBE_OK;
}

GstFlowReturn FrameTap::on_sample(GstAppSink* sink, gpointer data) {
  const Ref<GstSample> sample(gst_app_sink_pull_sample(sink));
  auto* self = static_cast<FrameTap*>(data);
  if (sample) self->take(sample.get());
  ++self->rendered_;
  return GST_FLOW_OK;
}

GstFlowReturn FrameTap::on_preroll(GstAppSink* sink, gpointer data) {
  const Ref<GstSample> sample(gst_app_sink_pull_preroll(sink));
  if (sample) static_cast<FrameTap*>(data)->take(sample.get());
  return GST_FLOW_OK;
}

void FrameTap::take(GstSample* sample) {
  // The sink delivers a prerolled buffer again when playback resumes.
  if (last_ && gst_sample_get_buffer(last_->sample.get()) == gst_sample_get_buffer(sample)) return;
  FramePtr frame = make_frame(sample, std::move(input_), frames_, arrived_us_);
  if (!frame) return;
  last_ = frame;
  on_frame_(std::move(frame));
  ++frames_;
}

}  // namespace live
