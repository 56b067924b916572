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

}  // namespace live
