// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/frame.hpp"

#include <gst/video/video.h>

#include <atomic>
#include <utility>

#include "gst/ellipse/gstellipsemeta.h"

namespace live {
namespace {

std::atomic<guint64> next_number{0};

}  // namespace

FramePtr make_frame(GstSample* sample, Ref<GstBuffer> input, guint64 index, gint64 arrived_us) {
  auto frame = std::make_shared<Frame>();
  frame->sample.reset(gst_sample_copy(sample));
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstVideoInfo info;
  if (buffer == nullptr || !gst_video_info_from_caps(&info, gst_sample_get_caps(sample))) {
    return nullptr;
  }
  frame->input = std::move(input);
  frame->number = next_number++;
  frame->index = index;
  frame->arrived_us = arrived_us;
  frame->pts = GST_BUFFER_PTS_IS_VALID(buffer) ? GST_BUFFER_PTS(buffer) : 0;
  frame->width = GST_VIDEO_INFO_WIDTH(&info);
  frame->height = GST_VIDEO_INFO_HEIGHT(&info);
  if (GST_VIDEO_INFO_FPS_N(&info) > 0) {
    gst_util_fraction_to_double(
        GST_VIDEO_INFO_FPS_N(&info), GST_VIDEO_INFO_FPS_D(&info), &frame->rate);
  }
  const Ref<gchar> json(gst_buffer_ellipses_to_json(
      buffer, index, static_cast<guint>(frame->width), static_cast<guint>(frame->height)));
  frame->line = std::string(json.get()) + "\n";
  return frame;
}

FramePtr detached_copy(const Frame& frame) {
  auto copy = std::make_shared<Frame>();
  copy->input.reset(gst_buffer_copy_deep(frame.input.get()));
  Ref<GstBuffer> output(gst_buffer_new());
  gst_buffer_copy_into(output.get(), copy->input.get(), GST_BUFFER_COPY_MEMORY, 0, -1);
  constexpr auto kAllButPixels = static_cast<GstBufferCopyFlags>(
      GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS | GST_BUFFER_COPY_META);
  gst_buffer_copy_into(
      output.get(), gst_sample_get_buffer(frame.sample.get()), kAllButPixels, 0, -1);
  copy->sample.reset(
      gst_sample_new(output.get(), gst_sample_get_caps(frame.sample.get()), nullptr, nullptr));
  copy->number = next_number++;
  copy->index = frame.index;
  copy->arrived_us = frame.arrived_us;
  copy->pts = frame.pts;
  copy->width = frame.width;
  copy->height = frame.height;
  copy->rate = frame.rate;
  copy->line = frame.line;
  return copy;
}

}  // namespace live
