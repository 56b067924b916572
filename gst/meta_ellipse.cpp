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
  meta->frame_width = static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info));
  meta->frame_height = static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info));
  meta->pts = GST_BUFFER_PTS(buffer);
  write_outline(meta, lens);
  return meta;
}
