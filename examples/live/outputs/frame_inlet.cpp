// SPDX-License-Identifier: MIT
#include "examples/live/outputs/frame_inlet.hpp"

namespace live {

std::string frame_inlet(const std::string& name, int max_frames) {
  return "appsrc name=" + name +
         " is-live=true format=time do-timestamp=true leaky-type=downstream max-bytes=0 "
         "max-buffers=" +
         std::to_string(max_frames);
}

void push_frame(GstAppSrc* inlet, const Frame& frame) {
  // A writable buffer for the timestamps; it shares the pixels and has the metadata.
  GstBuffer* buffer = gst_buffer_copy(gst_sample_get_buffer(frame.sample.get()));
  GST_BUFFER_PTS(buffer) = GST_CLOCK_TIME_NONE;
  GST_BUFFER_DTS(buffer) = GST_CLOCK_TIME_NONE;
  const Ref<GstSample> sample(
      gst_sample_new(buffer, gst_sample_get_caps(frame.sample.get()), nullptr, nullptr));
  gst_buffer_unref(buffer);
  gst_app_src_push_sample(inlet, sample.get());
}

}  // namespace live
