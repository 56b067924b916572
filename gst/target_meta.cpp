// SPDX-License-Identifier: MIT
#include "gst/target_meta.hpp"

#include <algorithm>
#include <cmath>

const gchar* state_nick(const std::optional<ellipse::Target>& target) {
  if (!target) return "lost";
  switch (target->state) {
    case ellipse::TargetState::kDetected:
      return "detected";
    case ellipse::TargetState::kTracked:
      return "tracked";
    case ellipse::TargetState::kPredicted:
      return "predicted";
  }
  return "lost";
}

const GstEllipseMeta* attach_target_meta(GstBuffer* buffer,
                                         const ellipse::Target& target,
                                         const GstVideoInfo& info,
                                         GstClockTime processing_time) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->state = static_cast<GstEllipseState>(target.state);
  meta->id = target.id;
  meta->cx = target.ellipse.cx;
  meta->cy = target.ellipse.cy;
  meta->semi_major = target.ellipse.semi_major;
  meta->semi_minor = target.ellipse.semi_minor;
  meta->angle_rad = target.ellipse.angle_rad;
  meta->contour_overlap = target.contour_overlap;
  meta->ellipse_overlap = target.ellipse_overlap;
  meta->visible_fraction = target.visible_fraction;
  meta->scale = static_cast<guint>(target.scale);
  meta->roi_x = target.search_region.x;
  meta->roi_y = target.search_region.y;
  meta->roi_width = static_cast<guint>(target.search_region.width);
  meta->roi_height = static_cast<guint>(target.search_region.height);
  meta->frame_width = static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info));
  meta->frame_height = static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info));
  meta->pts = GST_BUFFER_PTS(buffer);
  meta->processing_time = processing_time;
  return meta;
}

void attach_roi_meta(GstBuffer* buffer, const GstEllipseMeta& meta) {
  const ellipse::Ellipse e{meta.cx, meta.cy, meta.semi_major, meta.semi_minor, meta.angle_rad};
  const Eigen::Vector2d half = ellipse::half_extent(e);
  const auto first = [](double at) { return static_cast<guint>(std::max(0.0, std::floor(at))); };
  const auto last = [](double at, guint size) {
    return static_cast<guint>(std::clamp(std::ceil(at) + 1.0, 0.0, static_cast<double>(size)));
  };
  const guint left = first(e.cx - half.x());
  const guint top = first(e.cy - half.y());
  const guint right = last(e.cx + half.x(), meta.frame_width);
  const guint bottom = last(e.cy + half.y(), meta.frame_height);
  if (left >= right || top >= bottom) return;
  GstVideoRegionOfInterestMeta* roi = gst_buffer_add_video_region_of_interest_meta(
      buffer, "ellipse", left, top, right - left, bottom - top);
  gst_video_region_of_interest_meta_add_param(roi, gst_ellipse_meta_to_structure(&meta));
}
