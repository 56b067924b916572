// SPDX-License-Identifier: MIT
#include "examples/landing/eye.hpp"

#include "examples/evaluate/text.hpp"

namespace landing {

std::string PictureFormat::caps() const {
  return evaluate::format(
      "video/x-raw,format=GRAY8,width=%d,height=%d,framerate=%d/1", width, height, rate);
}

GstBuffer* PictureFormat::draw(std::uint64_t frame, const Draw& draw) const {
  const int stride = GST_ROUND_UP_4(width);
  const auto size = static_cast<gsize>(stride) * static_cast<gsize>(height);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_WRITE);
  draw({map.data, width, height, stride});
  gst_buffer_unmap(buffer, &map);
  const auto per_s = static_cast<guint64>(rate);
  GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(frame, GST_SECOND, per_s);
  GST_BUFFER_DURATION(buffer) = GST_SECOND / per_s;
  return buffer;
}

}  // namespace landing
