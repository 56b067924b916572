// SPDX-License-Identifier: MIT
#include "examples/evaluate/luma_sample.hpp"

#include <gst/video/video.h>

namespace evaluate {

cv::Mat luma_of(GstSample* sample) {
  GstVideoInfo info;
  GstVideoFrame frame;
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ)) {
    return {};
  }
  cv::Mat picture = cv::Mat(GST_VIDEO_FRAME_HEIGHT(&frame),
                            GST_VIDEO_FRAME_WIDTH(&frame),
                            CV_8UC1,
                            GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                            static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)))
                        .clone();
  gst_video_frame_unmap(&frame);
  return picture;
}

}  // namespace evaluate
