#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/gst.h>

G_BEGIN_DECLS

/**
 * GstEllipseSearchMeta:
 * @meta: parent
 * @processing_time: time spent on the frame, in ns
 *
 * Says that a frame was searched for a target, also where none was found. Lives as long as the
 * #GstEllipseMeta beside it would: an element that keeps those keeps this.
 *
 * Since: 0.1
 */
typedef struct _GstEllipseSearchMeta GstEllipseSearchMeta;
struct _GstEllipseSearchMeta {
  GstMeta meta;

  GstClockTime processing_time;
};

#define GST_ELLIPSE_SEARCH_META_API_TYPE (gst_ellipse_search_meta_api_get_type())
GType gst_ellipse_search_meta_api_get_type(void);

#define GST_ELLIPSE_SEARCH_META_INFO (gst_ellipse_search_meta_get_info())
const GstMetaInfo* gst_ellipse_search_meta_get_info(void);

GstEllipseSearchMeta* gst_buffer_add_ellipse_search_meta(GstBuffer* buffer,
                                                         GstClockTime processing_time);

GstEllipseSearchMeta* gst_buffer_get_ellipse_search_meta(GstBuffer* buffer);

G_END_DECLS
