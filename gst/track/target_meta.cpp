// SPDX-License-Identifier: MIT
#include "gst/track/target_meta.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gst/ellipse/enum_nick.hpp"
#include "gst/ellipse/gstellipsesearchmeta.h"
#include "gst/ellipse/packed_covariance.hpp"
#include "gst/meta_ellipse.hpp"

static GstEllipseTrackerState in_metadata(ellipse::TrackerState state) {
  switch (state) {
    case ellipse::TrackerState::kSearching:
      return GST_ELLIPSE_TRACKER_STATE_SEARCHING;
    case ellipse::TrackerState::kConfirming:
      return GST_ELLIPSE_TRACKER_STATE_CONFIRMING;
    case ellipse::TrackerState::kFollowing:
      return GST_ELLIPSE_TRACKER_STATE_FOLLOWING;
    case ellipse::TrackerState::kCoasting:
      return GST_ELLIPSE_TRACKER_STATE_COASTING;
  }
  return GST_ELLIPSE_TRACKER_STATE_UNKNOWN;
}

const gchar* nick_of(ellipse::TrackerState state) {
  const GstEllipseTrackerState value = in_metadata(state);
  return nick_of(GST_TYPE_ELLIPSE_TRACKER_STATE, &value);
}

static void write_pose(GstEllipseMeta* meta, const ellipse::TargetPose& pose) {
  meta->has_pose = TRUE;
  Eigen::Map<Eigen::Vector3d>(&meta->bearing_x) = pose.bearing;
  meta->angle_x = pose.angles_rad.x();
  meta->angle_y = pose.angles_rad.y();
  meta->centre_x = pose.centre_px.x();
  meta->centre_y = pose.centre_px.y();
  Eigen::Map<Eigen::Vector3d>(&meta->normal_x) = pose.normal;
  Eigen::Map<Eigen::Vector3d>(&meta->other_normal_x) = pose.other_normal;
  meta->certainty = pose.certainty;
  if (!(pose.radius_m > 0.0)) return;
  meta->has_position = TRUE;
  Eigen::Map<Eigen::Vector3d>(&meta->position_x) = pose.position_m;
  Eigen::Map<Eigen::Vector3d>(&meta->other_position_x) = pose.other_position_m;
  pack_covariance<3>(pose.covariance_m2, meta->position_covariance);
}

static const GstEllipseMeta* attach_target_meta(GstBuffer* buffer,
                                                const ellipse::Target& target,
                                                const ellipse::LensView& lens,
                                                const GstVideoInfo& info,
                                                GstClockTime processing_time) {
  GstEllipseMeta* meta =
      attach_ellipse(buffer, GST_ELLIPSE_ROLE_TARGET, target.ellipse, lens, info);
  meta->state = static_cast<GstEllipseState>(target.state);
  meta->id = target.id;
  meta->contour_overlap = target.contour_overlap;
  meta->ellipse_overlap = target.ellipse_overlap;
  meta->probability = target.probability;
  meta->visible_fraction = target.visible_fraction;
  meta->scale = static_cast<guint>(target.scale);
  meta->roi_x = target.search_region.x;
  meta->roi_y = target.search_region.y;
  meta->roi_width = static_cast<guint>(target.search_region.width);
  meta->roi_height = static_cast<guint>(target.search_region.height);
  meta->processing_time = processing_time;
  pack_covariance<5>(target.covariance, meta->covariance);
  meta->sigma_px = largest_sigma(target.covariance);
  if (target.pose) write_pose(meta, *target.pose);
  return meta;
}

// The bounding box in image coordinates.
static Eigen::AlignedBox2d box_of(const GstEllipseMeta& meta) {
  const ellipse::Ellipse e = ellipse_of(meta);
  const Eigen::Vector2d half = ellipse::half_extent(e);
  if (meta.n_outline == 0) return {e.center() - half, e.center() + half};
  Eigen::AlignedBox2d box;
  for (gsize i = 0; i < meta.n_outline; ++i) {
    const Eigen::Vector2d point(meta.outline[2 * i], meta.outline[2 * i + 1]);
    if (point.allFinite()) box.extend(point);
  }
  return box;
}

// The whole pixels of the frame that contain the outline; empty if it is outside.
static ellipse::Rect box_in_frame(const GstEllipseMeta& meta) {
  const Eigen::AlignedBox2d box = box_of(meta);
  const auto first = [](double at, guint size) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
  };
  const auto last = [](double at, guint size) {
    return static_cast<int>(std::clamp(std::ceil(at) + 1.0, 0.0, static_cast<double>(size)));
  };
  const int left = first(box.min().x(), meta.frame_width);
  const int top = first(box.min().y(), meta.frame_height);
  const int right = last(box.max().x(), meta.frame_width);
  const int bottom = last(box.max().y(), meta.frame_height);
  return {left, top, right - left, bottom - top};
}

static void attach_roi_meta(GstBuffer* buffer, const GstEllipseMeta& meta) {
  const ellipse::Rect box = box_in_frame(meta);
  if (box.empty()) return;
  GstVideoRegionOfInterestMeta* roi =
      gst_buffer_add_video_region_of_interest_meta(buffer,
                                                   "ellipse",
                                                   static_cast<guint>(box.x),
                                                   static_cast<guint>(box.y),
                                                   static_cast<guint>(box.width),
                                                   static_cast<guint>(box.height));
  gst_video_region_of_interest_meta_add_param(roi, gst_ellipse_meta_to_structure(&meta));
}

static constexpr double kSameEllipsePx = 1.5;

static void attach_candidate_metas(GstBuffer* buffer,
                                   const std::optional<ellipse::Target>& target,
                                   const ellipse::Tracker& tracker,
                                   const TrackProperties& properties,
                                   const GstVideoInfo& info) {
  for (const ellipse::Detection& candidate : tracker.candidates()) {
    // The target itself; tracking changes its ellipse slightly.
    const bool is_target =
        target && ellipse::max_difference_px(candidate.ellipse, target->ellipse) < kSameEllipsePx;
    if (is_target) continue;
    GstEllipseMeta* meta =
        attach_ellipse(buffer, GST_ELLIPSE_ROLE_CANDIDATE, candidate.ellipse, tracker.lens(), info);
    meta->contour_overlap = candidate.contour_overlap;
    meta->ellipse_overlap = candidate.ellipse_overlap;
    meta->probability = candidate.probability;
    meta->visible_fraction = ellipse::visible_fraction(tracker.lens(),
                                                       candidate.ellipse,
                                                       static_cast<int>(meta->frame_width),
                                                       static_cast<int>(meta->frame_height));
    if (properties.attach_analytics) attach_object(buffer, *meta, box_in_frame(*meta), {});
  }
}

const GstEllipseMeta* attach_metas(GstBuffer* buffer,
                                   const std::optional<ellipse::Target>& target,
                                   const ellipse::Tracker& tracker,
                                   const TrackProperties& properties,
                                   const GstVideoInfo& info,
                                   const Sighting& sighting,
                                   GstClockTime processing_time) {
  gst_buffer_add_ellipse_search_meta(buffer, processing_time)->tracker_state =
      in_metadata(tracker.state());
  const GstEllipseMeta* meta = nullptr;
  if (target) {
    meta = attach_target_meta(buffer, *target, tracker.lens(), info, processing_time);
    if (properties.attach_roi_meta) attach_roi_meta(buffer, *meta);
    if (properties.attach_analytics) attach_object(buffer, *meta, box_in_frame(*meta), sighting);
  }
  if (properties.tracker.wants_candidates) {
    attach_candidate_metas(buffer, target, tracker, properties, info);
  }
  return meta;
}
