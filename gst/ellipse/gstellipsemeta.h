#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/gst.h>

G_BEGIN_DECLS

/**
 * GstEllipseRole:
 * @GST_ELLIPSE_ROLE_TARGET: the ellipse that is being followed
 * @GST_ELLIPSE_ROLE_CANDIDATE: another ellipse of the picture
 * @GST_ELLIPSE_ROLE_TRUTH: where a test source has really drawn the target
 *
 * What an ellipse on a buffer stands for.
 *
 * Since: 0.1
 */
typedef enum {
  GST_ELLIPSE_ROLE_TARGET,
  GST_ELLIPSE_ROLE_CANDIDATE,
  GST_ELLIPSE_ROLE_TRUTH,
} GstEllipseRole;

/**
 * GstEllipseState:
 * @GST_ELLIPSE_STATE_DETECTED: found where nothing was known of it
 * @GST_ELLIPSE_STATE_TRACKED: found around its last place
 * @GST_ELLIPSE_STATE_PREDICTED: not seen; its motion was continued
 *
 * How a target came to be known in its frame.
 *
 * Since: 0.1
 */
typedef enum {
  GST_ELLIPSE_STATE_DETECTED,
  GST_ELLIPSE_STATE_TRACKED,
  GST_ELLIPSE_STATE_PREDICTED,
} GstEllipseState;

#define GST_TYPE_ELLIPSE_ROLE (gst_ellipse_role_get_type())
GType gst_ellipse_role_get_type(void);

#define GST_TYPE_ELLIPSE_STATE (gst_ellipse_state_get_type())
GType gst_ellipse_state_get_type(void);

/**
 * GstEllipseMeta:
 * @meta: what all metadata have
 * @role: what the ellipse stands for
 * @state: how it came to be known
 * @id: number of the target, the same while it is not lost, from 1; 0 = none
 * @cx: centre in px, x to the right, the centre of the top-left pixel is 0
 * @cy: centre in px, y down
 * @semi_major: semi-major axis in px
 * @semi_minor: semi-minor axis in px
 * @angle_rad: major axis from +x towards +y, in (-pi/2, pi/2]
 * @contour_overlap: share of its contour's pixels on the ellipse, 0 to 1
 * @ellipse_overlap: share of the ellipse's pixels on edges, 0 to 1
 * @visible_fraction: share of the perimeter inside the frame, 0 to 1
 * @scale: frame scale that it was found at, a power of two
 * @roi_x: left edge of the region that was searched, in px
 * @roi_y: upper edge of that region, in px
 * @roi_width: width of that region, in px
 * @roi_height: height of that region, in px
 * @frame_width: width in px of the frame that the numbers refer to
 * @frame_height: height in px of the frame that the numbers refer to
 * @pts: presentation time stamp of the frame that was analysed, in ns; or `GST_CLOCK_TIME_NONE`
 * @processing_time: time spent on that frame, in ns; or `GST_CLOCK_TIME_NONE`
 *
 * One ellipse on a video buffer; a buffer may have several. Survives copies, and follows scaling:
 * under a scale that is not the same in x and y the ellipse turns as the picture does.
 *
 * It belongs to its buffer and is gone with it, in every language: take its numbers while the
 * buffer is at hand, or keep what [method@GstEllipse.EllipseMeta.to_structure] returns.
 *
 * Since: 0.1
 */
typedef struct _GstEllipseMeta GstEllipseMeta;
struct _GstEllipseMeta {
  GstMeta meta;

  GstEllipseRole role;
  GstEllipseState state;
  guint64 id;
  gdouble cx;
  gdouble cy;
  gdouble semi_major;
  gdouble semi_minor;
  gdouble angle_rad;
  gdouble contour_overlap;
  gdouble ellipse_overlap;
  gdouble visible_fraction;
  guint scale;
  gint roi_x;
  gint roi_y;
  guint roi_width;
  guint roi_height;
  guint frame_width;
  guint frame_height;
  GstClockTime pts;
  GstClockTime processing_time;
};

#define GST_ELLIPSE_META_API_TYPE (gst_ellipse_meta_api_get_type())
GType gst_ellipse_meta_api_get_type(void);

#define GST_ELLIPSE_META_INFO (gst_ellipse_meta_get_info())
const GstMetaInfo* gst_ellipse_meta_get_info(void);

GstEllipseMeta* gst_buffer_add_ellipse_meta(GstBuffer* buffer, GstEllipseRole role);

GstEllipseMeta* gst_buffer_get_ellipse_meta(GstBuffer* buffer, GstEllipseRole role);

GstEllipseMeta* gst_buffer_iterate_ellipse_meta(GstBuffer* buffer, gpointer* state);

GList* gst_buffer_list_ellipse_meta(GstBuffer* buffer);

const gchar* gst_ellipse_meta_get_role_name(const GstEllipseMeta* meta);

const gchar* gst_ellipse_meta_get_state_name(const GstEllipseMeta* meta);

GstStructure* gst_ellipse_meta_to_structure(const GstEllipseMeta* meta);

gchar* gst_ellipse_meta_to_json(const GstEllipseMeta* meta);

gchar* gst_buffer_ellipses_to_json(GstBuffer* buffer, guint64 frame, guint width, guint height);

G_END_DECLS
