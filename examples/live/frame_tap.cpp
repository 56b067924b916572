// SPDX-License-Identifier: MIT
#include "examples/live/frame_tap.hpp"

#include <gst/video/video.h>

#include <string>
#include <utility>

#include "gst/ellipse/gstellipsemeta.h"

namespace live {

FrameTap::FrameTap(GstElement* tracker, GstAppSink* sink, FrameSink on_frame)
    : on_frame_(std::move(on_frame)) {
  // One buffer at most waits here, and only while on_sample() takes it.
  g_object_set(sink, "max-buffers", 1, "drop", TRUE, "enable-last-sample", FALSE, nullptr);
  GstAppSinkCallbacks callbacks{};
  callbacks.new_sample = on_sample;
  callbacks.new_preroll = on_preroll;
  gst_app_sink_set_callbacks(sink, &callbacks, this, nullptr);
  const Ref<GstPad> pad(gst_element_get_static_pad(tracker, "sink"));
  gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, on_arrival, this, nullptr);
}

GstPadProbeReturn FrameTap::on_arrival(GstPad* /*pad*/, GstPadProbeInfo* /*info*/, gpointer data) {
  static_cast<FrameTap*>(data)->arrived_us_ = g_get_monotonic_time();
  return GST_PAD_PROBE_OK;
}

GstFlowReturn FrameTap::on_sample(GstAppSink* sink, gpointer data) {
  Ref<GstSample> sample(gst_app_sink_pull_sample(sink));
  auto* self = static_cast<FrameTap*>(data);
  if (sample) self->take(std::move(sample));
  ++self->rendered_;
  return GST_FLOW_OK;
}

GstFlowReturn FrameTap::on_preroll(GstAppSink* sink, gpointer data) {
  Ref<GstSample> sample(gst_app_sink_pull_preroll(sink));
  if (sample) static_cast<FrameTap*>(data)->take(std::move(sample));
  return GST_FLOW_OK;
}

void FrameTap::take(Ref<GstSample> theirs) {
  // appsink 1.22 writes on its own sample after a flush without asking who else holds it.
  auto frame = std::make_shared<Frame>();
  GstSample* sample = gst_sample_copy(theirs.get());
  frame->sample.reset(sample);
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstVideoInfo info;
  if (buffer == nullptr || !gst_video_info_from_caps(&info, gst_sample_get_caps(sample))) return;
  // What was shown when paused comes once more when it plays on.
  if (last_ && gst_sample_get_buffer(last_->sample.get()) == buffer) return;
  frame->number = frames_;
  frame->arrived_us = arrived_us_;  // no queue lies between: it is this frame's
  frame->pts = GST_BUFFER_PTS_IS_VALID(buffer) ? GST_BUFFER_PTS(buffer) : 0;
  frame->width = GST_VIDEO_INFO_WIDTH(&info);
  frame->height = GST_VIDEO_INFO_HEIGHT(&info);
  if (GST_VIDEO_INFO_FPS_N(&info) > 0) {
    gst_util_fraction_to_double(
        GST_VIDEO_INFO_FPS_N(&info), GST_VIDEO_INFO_FPS_D(&info), &frame->rate);
  }
  const Ref<gchar> json(gst_buffer_ellipses_to_json(
      buffer, frame->number, static_cast<guint>(frame->width), static_cast<guint>(frame->height)));
  frame->line = std::string(json.get()) + "\n";
  last_ = frame;
  on_frame_(std::move(frame));
  ++frames_;
}

}  // namespace live
