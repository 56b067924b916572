// SPDX-License-Identifier: MIT
#include "gst/meta_ellipse.hpp"

#include <array>

// Points on the undistorted ellipse, in distorted image coordinates.
static void write_outline(GstEllipseMeta* meta, const ellipse::LensView& lens) {
  if (!lens.is_distorted()) return;
  std::array<Eigen::Vector2d, G_N_ELEMENTS(GstEllipseMeta::outline) / 2> points;
  ellipse::distorted_outline(lens, ellipse_of(*meta), points);
  gfloat* to = meta->outline;
  for (const Eigen::Vector2d& point : points) {
    *to++ = static_cast<gfloat>(point.x());
    *to++ = static_cast<gfloat>(point.y());
  }
  meta->n_outline = static_cast<guint>(points.size());
}

ellipse::Rect frame_of(GstBuffer* buffer, const GstVideoInfo& info) {
  const GstVideoMeta* meta = gst_buffer_get_video_meta(buffer);
  if (meta == nullptr) return {0, 0, GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info)};
  return {0, 0, static_cast<int>(meta->width), static_cast<int>(meta->height)};
}

GstEllipseMeta* attach_ellipse(GstBuffer* buffer,
                               GstEllipseRole role,
                               const ellipse::Ellipse& e,
                               const ellipse::LensView& lens,
                               const GstVideoInfo& info) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, role);
  meta->cx = e.cx;
  meta->cy = e.cy;
  meta->semi_major = e.semi_major;
  meta->semi_minor = e.semi_minor;
  meta->angle_rad = e.angle_rad;
  const ellipse::Rect frame = frame_of(buffer, info);
  meta->frame_width = static_cast<guint>(frame.width);
  meta->frame_height = static_cast<guint>(frame.height);
  meta->pts = GST_BUFFER_PTS(buffer);
  write_outline(meta, lens);
  return meta;
}
