#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/gst.h>

G_BEGIN_DECLS

/**
 * GstEllipseTrackerState:
 * @GST_ELLIPSE_TRACKER_STATE_UNKNOWN: unknown
 * @GST_ELLIPSE_TRACKER_STATE_SEARCHING: no target
 * @GST_ELLIPSE_TRACKER_STATE_CONFIRMING: an ellipse is followed, but its probability is too low
 * to report it
 * @GST_ELLIPSE_TRACKER_STATE_FOLLOWING: a target is reported whose matched edges determine its
 * position
 * @GST_ELLIPSE_TRACKER_STATE_COASTING: a target is reported whose matched edges do not determine
 * its position, which is extrapolated
 *
 * State of the tracker in a frame. With tracking=redetect and tracking=none it is either searching
 * or following.
 *
 * Since: 0.2
 */
typedef enum {
  GST_ELLIPSE_TRACKER_STATE_UNKNOWN,
  GST_ELLIPSE_TRACKER_STATE_SEARCHING,
  GST_ELLIPSE_TRACKER_STATE_CONFIRMING,
  GST_ELLIPSE_TRACKER_STATE_FOLLOWING,
  GST_ELLIPSE_TRACKER_STATE_COASTING,
} GstEllipseTrackerState;

#define GST_TYPE_ELLIPSE_TRACKER_STATE (gst_ellipse_tracker_state_get_type())
GType gst_ellipse_tracker_state_get_type(void);

/**
 * GstEllipseSearchMeta:
 * @meta: parent
 * @processing_time: processing time of the frame, in ns
 * @tracker_state: state of the tracker. Since: 0.2
 *
 * Marks a frame as searched for a target, even if none was found. An element that keeps
 * #GstEllipseMeta also keeps this.
 *
 * Since: 0.1
 */
typedef struct _GstEllipseSearchMeta GstEllipseSearchMeta;
struct _GstEllipseSearchMeta {
  GstMeta meta;

  GstClockTime processing_time;
  GstEllipseTrackerState tracker_state;
};

#define GST_ELLIPSE_SEARCH_META_API_TYPE (gst_ellipse_search_meta_api_get_type())
GType gst_ellipse_search_meta_api_get_type(void);

#define GST_ELLIPSE_SEARCH_META_INFO (gst_ellipse_search_meta_get_info())
const GstMetaInfo* gst_ellipse_search_meta_get_info(void);

GstEllipseSearchMeta* gst_buffer_add_ellipse_search_meta(GstBuffer* buffer,
                                                         GstClockTime processing_time);

GstEllipseSearchMeta* gst_buffer_get_ellipse_search_meta(GstBuffer* buffer);

const gchar* gst_ellipse_search_meta_get_tracker_state_name(const GstEllipseSearchMeta* meta);

G_END_DECLS
