// SPDX-License-Identifier: MIT
#include "gst/track/search_bounds.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include "gst/meta_ellipse.hpp"
#include "gst/track/analytics_meta.hpp"

namespace {

// Clips a box of any position and size to a frame.
ellipse::Rect clipped(std::int64_t x,
                      std::int64_t y,
                      std::int64_t width,
                      std::int64_t height,
                      const ellipse::Rect& frame) {
  const auto inside = [](std::int64_t at, int size) {
    return static_cast<int>(std::clamp<std::int64_t>(at, 0, size));
  };
  const int left = inside(x, frame.width);
  const int top = inside(y, frame.height);
  const int right = inside(x + width, frame.width);
  const int bottom = inside(y + height, frame.height);
  return ellipse::intersect({left, top, right - left, bottom - top}, frame);
}

// The bounding box of all regions of interest and detected objects, so that a target which passes
// from one to the next stays the same target. A type without a quark has no region; none is
// created, because quarks are never freed.
ellipse::Rect box_around_regions(GstBuffer* buffer,
                                 const std::string& type,
                                 const ellipse::Rect& frame) {
  ellipse::Rect box;
  const GQuark type_quark = type.empty() ? 0 : g_quark_try_string(type.c_str());
  if (!type.empty() && type_quark == 0) return box;
  gpointer state = nullptr;
  while (GstMeta* meta = gst_buffer_iterate_meta_filtered(
             buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    const auto* roi = reinterpret_cast<const GstVideoRegionOfInterestMeta*>(meta);
    if (type_quark != 0 && roi->roi_type != type_quark) continue;
    box = ellipse::united(box, clipped(roi->x, roi->y, roi->w, roi->h, frame));
  }
  state = nullptr;
  while (const auto object = next_object(buffer, &state, type_quark)) {
    box = ellipse::united(box, clipped(object->x, object->y, object->width, object->height, frame));
  }
  return box;
}

}  // namespace

ellipse::Rect search_bounds(GstBuffer* buffer,
                            const GstVideoInfo& info,
                            const TrackProperties& properties) {
  const ellipse::Rect frame = frame_of(buffer, info);
  const ellipse::Rect& roi = properties.roi;
  ellipse::Rect bounds = frame;
  if (properties.roi_source == ROI_SOURCE_PROPERTY) {
    bounds = clipped(roi.x, roi.y, roi.width, roi.height, frame);
  } else if (properties.roi_source == ROI_SOURCE_META) {
    bounds = box_around_regions(buffer, properties.roi_type, frame);
  }
  const GstVideoCropMeta* crop = gst_buffer_get_video_crop_meta(buffer);
  if (crop == nullptr) return bounds;
  return ellipse::intersect(bounds, clipped(crop->x, crop->y, crop->width, crop->height, frame));
}
