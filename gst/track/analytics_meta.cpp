// SPDX-License-Identifier: MIT
#include "gst/track/analytics_meta.hpp"

#include <cmath>
#include <numbers>

#ifdef ELLIPSE_HAS_ANALYTICS
#include <gst/analytics/analytics.h>
#endif

void Sighting::add(const ellipse::Target& target, GstClockTime pts) {
  if (target.id != id) *this = {target.id, pts, pts};
  if (target.state != ellipse::TargetState::kPredicted) last = pts;
}

#ifdef ELLIPSE_HAS_ANALYTICS

bool has_analytics() {
  return true;
}

#if GST_CHECK_VERSION(1, 26, 0)
// The box along the axes, in whole pixels. Rounding moves its centre by up to half a pixel in x and
// in y, which is sqrt(2) / 2 along any axis: the box is that much larger to contain the ellipse.
static bool add_oriented_box(GstAnalyticsRelationMeta* relations,
                             const GstEllipseMeta& meta,
                             GQuark type,
                             GstAnalyticsODMtd* object) {
  const double width = std::ceil(2.0 * meta.semi_major + std::numbers::sqrt2);
  const double height = std::ceil(2.0 * meta.semi_minor + std::numbers::sqrt2);
  // A box covers its pixels: the centre of the top-left pixel is at (0.5, 0.5).
  const double left = std::round(meta.cx + 0.5 - width / 2.0);
  const double top = std::round(meta.cy + 0.5 - height / 2.0);
  // Half a turn makes no difference, and the angle may not be negative.
  const double angle_rad =
      meta.angle_rad < 0.0 ? meta.angle_rad + std::numbers::pi : meta.angle_rad;
  return gst_analytics_relation_meta_add_oriented_od_mtd(relations,
                                                         type,
                                                         static_cast<gint>(left),
                                                         static_cast<gint>(top),
                                                         static_cast<gint>(width),
                                                         static_cast<gint>(height),
                                                         static_cast<gfloat>(angle_rad),
                                                         static_cast<gfloat>(meta.probability),
                                                         object) != FALSE;
}
#endif

static bool add_box(GstAnalyticsRelationMeta* relations,
                    const GstEllipseMeta& meta,
                    const ellipse::Rect& box,
                    GstAnalyticsODMtd* object) {
  const GQuark type = g_quark_from_static_string("ellipse");
#if GST_CHECK_VERSION(1, 26, 0)
  if (meta.n_outline == 0) return add_oriented_box(relations, meta, type, object);
#endif
  return gst_analytics_relation_meta_add_od_mtd(relations,
                                                type,
                                                box.x,
                                                box.y,
                                                box.width,
                                                box.height,
                                                static_cast<gfloat>(meta.probability),
                                                object) != FALSE;
}

static void add_tracking(GstAnalyticsRelationMeta* relations,
                         const Sighting& sighting,
                         guint object_id) {
  GstAnalyticsTrackingMtd track;
  if (gst_analytics_relation_meta_add_tracking_mtd(
          relations, sighting.id, sighting.first, &track) == FALSE) {
    return;
  }
  gst_analytics_tracking_mtd_update_last_seen(&track, sighting.last);
  constexpr GstAnalyticsRelTypes kRelated = GST_ANALYTICS_REL_TYPE_RELATE_TO;
  gst_analytics_relation_meta_set_relation(relations, kRelated, object_id, track.id);
  gst_analytics_relation_meta_set_relation(relations, kRelated, track.id, object_id);
}

void attach_object(GstBuffer* buffer,
                   const GstEllipseMeta& meta,
                   const ellipse::Rect& box,
                   const Sighting& sighting) {
  if (box.empty()) return;
  GstAnalyticsRelationMeta* relations = gst_buffer_add_analytics_relation_meta(buffer);
  GstAnalyticsODMtd object;
  if (relations == nullptr || !add_box(relations, meta, box, &object)) return;
  if (meta.id != 0) add_tracking(relations, sighting, object.id);
}

std::optional<ellipse::Rect> next_object(GstBuffer* buffer, gpointer* state, GQuark object_class) {
  GstAnalyticsRelationMeta* relations = gst_buffer_get_analytics_relation_meta(buffer);
  if (relations == nullptr) return std::nullopt;
  const GstAnalyticsMtdType type = gst_analytics_od_mtd_get_mtd_type();
  GstAnalyticsODMtd object;
  while (gst_analytics_relation_meta_iterate(relations, state, type, &object) != FALSE) {
    if (object_class != 0 && gst_analytics_od_mtd_get_obj_type(&object) != object_class) continue;
    ellipse::Rect box;
    gst_analytics_od_mtd_get_location(&object, &box.x, &box.y, &box.width, &box.height, nullptr);
    return box;
  }
  return std::nullopt;
}

#else

bool has_analytics() {
  return false;
}

void attach_object(GstBuffer* /*buffer*/,
                   const GstEllipseMeta& /*meta*/,
                   const ellipse::Rect& /*box*/,
                   const Sighting& /*sighting*/) {}

std::optional<ellipse::Rect> next_object(GstBuffer* /*buffer*/,
                                         gpointer* /*state*/,
                                         GQuark /*object_class*/) {
  return std::nullopt;
}

#endif
