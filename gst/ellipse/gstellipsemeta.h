#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/gst.h>

G_BEGIN_DECLS

/**
 * GstEllipseRole:
 * @GST_ELLIPSE_ROLE_TARGET: the target
 * @GST_ELLIPSE_ROLE_CANDIDATE: another ellipse in the frame
 * @GST_ELLIPSE_ROLE_TRUTH: ground truth of a test source
 *
 * Role of an ellipse on a buffer.
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
 * @GST_ELLIPSE_STATE_DETECTED: found by the detector, without a previous target
 * @GST_ELLIPSE_STATE_TRACKED: found from its previous position
 * @GST_ELLIPSE_STATE_PREDICTED: its matched edges do not determine the position, which is
 *   extrapolated; the target may be visible
 *
 * How a target was found in its frame.
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
 * @meta: parent
 * @role: role of the ellipse
 * @state: how it was found
 * @id: number of the target from 1, constant until the target is lost; 0 = none
 * @cx: centre in px, x to the right; 0 is the centre of the top-left pixel
 * @cy: centre in px, y down
 * @semi_major: semi-major axis in px
 * @semi_minor: semi-minor axis in px
 * @angle_rad: major axis from +x towards +y, in (-pi/2, pi/2]
 * @contour_overlap: share of its contour's pixels on the ellipse, 0 to 1; for a target followed by
 *   its edges, share of all its visible edges that were matched
 * @ellipse_overlap: share of the ellipse's perimeter on edges, 0 to 1; for a target followed by
 *   its edges, share of the visible outer edge that was matched
 * @visible_fraction: share of the perimeter inside the frame, 0 to 1
 * @scale: frame scale at which it was found, a power of two
 * @roi_x: left edge of the search region, in px
 * @roi_y: upper edge of that region, in px
 * @roi_width: width of that region, in px; 0 = unknown
 * @roi_height: height of that region, in px; 0 = unknown
 * @frame_width: width in px of the frame to which the coordinates refer
 * @frame_height: height in px of the frame to which the coordinates refer
 * @pts: presentation time stamp of the analysed frame, in ns; or `GST_CLOCK_TIME_NONE`
 * @processing_time: processing time of that frame, in ns; or `GST_CLOCK_TIME_NONE`
 * @has_pose: whether bearing, angles, centre and normals are valid: the camera is known
 * @has_position: whether the positions are valid: the target's diameter is known too
 * @bearing_x: unit vector from the camera to the circle's centre, x to the right
 * @bearing_y: the same, y down
 * @bearing_z: the same, z forward
 * @angle_x: angle of the bearing to the right of the optical axis, in rad
 * @angle_y: the same downwards
 * @centre_x: projection of the circle's centre in px, which differs from the ellipse's centre
 * @centre_y: the same
 * @normal_x: unit normal of the circle's plane, towards the camera
 * @normal_y: the same
 * @normal_z: the same
 * @other_normal_x: normal of the other circle with the same projection
 * @other_normal_y: the same
 * @other_normal_z: the same
 * @certainty: probability that @normal_x, y, z is the correct solution of the two, 0.5 to 1
 * @position_x: the circle's centre in m, in the frame of the bearing
 * @position_y: the same
 * @position_z: the same
 * @other_position_x: centre of the other circle with the same projection
 * @other_position_y: the same
 * @other_position_z: the same
 * @position_covariance: covariance of the position in m^2: xx, xy, xz, yy, yz, zz
 * @n_outline: number of points of @outline; 0 if the ellipse is in image coordinates
 * @outline: x and y in px of points on the ellipse's outline in distorted image coordinates, if the
 *   ellipse is in undistorted coordinates; NaN for points that the lens does not show
 * @probability: probability that it is a target, 0 to 1: with tracking=edges from all frames so
 *   far, otherwise from the detector in this frame; 1 if the detector gives none; 0 for the truth.
 *   Since: 0.2
 * @sigma_px: standard deviation of the target's centre in the direction in which it is largest, in
 *   px; 0 = unknown, as for candidates and the truth. Since: 0.2
 * @covariance: covariance of cx, cy, semi_major, semi_minor [px] and angle_rad: the upper triangle
 *   by rows, beginning with cx cx, cx cy. Valid if @sigma_px is not 0. Since: 0.2
 *
 * One ellipse on a video buffer; a buffer may have several. Copying the buffer keeps it. Scaling
 * transforms it, even if the scale differs in x and y.
 *
 * The buffer owns it, in every language: read its fields while you hold the buffer, or keep the
 * result of [method@GstEllipse.EllipseMeta.to_structure].
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

  gboolean has_pose;
  gboolean has_position;
  gdouble bearing_x;
  gdouble bearing_y;
  gdouble bearing_z;
  gdouble angle_x;
  gdouble angle_y;
  gdouble centre_x;
  gdouble centre_y;
  gdouble normal_x;
  gdouble normal_y;
  gdouble normal_z;
  gdouble other_normal_x;
  gdouble other_normal_y;
  gdouble other_normal_z;
  gdouble certainty;
  gdouble position_x;
  gdouble position_y;
  gdouble position_z;
  gdouble other_position_x;
  gdouble other_position_y;
  gdouble other_position_z;
  gdouble position_covariance[6];
  guint n_outline;
  gfloat outline[128];
  gdouble probability;
  gdouble sigma_px;
  gdouble covariance[15];
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
