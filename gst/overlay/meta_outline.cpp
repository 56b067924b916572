// SPDX-License-Identifier: MIT
#include "gst/overlay/meta_outline.hpp"

#include <array>

void write_outline(GstEllipseMeta* meta, const ellipse::LensView& lens) {
  if (!lens.is_distorted()) return;
  std::array<Eigen::Vector2d, G_N_ELEMENTS(GstEllipseMeta::outline) / 2> points;
  ellipse::distorted_outline(
      lens, {meta->cx, meta->cy, meta->semi_major, meta->semi_minor, meta->angle_rad}, points);
  gfloat* to = meta->outline;
  for (const Eigen::Vector2d& point : points) {
    *to++ = static_cast<gfloat>(point.x());
    *to++ = static_cast<gfloat>(point.y());
  }
  meta->n_outline = static_cast<guint>(points.size());
}
