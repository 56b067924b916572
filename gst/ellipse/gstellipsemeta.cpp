/* SPDX-License-Identifier: MIT */
#include "gst/ellipse/gstellipsemeta.h"

#include <gst/video/gstvideometa.h>
#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "gst/ellipse/enum_nick.hpp"
#include "gst/ellipse/packed_covariance.hpp"

GType gst_ellipse_role_get_type(void) {
  static const GEnumValue kValues[] = {
      {GST_ELLIPSE_ROLE_TARGET, "GST_ELLIPSE_ROLE_TARGET", "target"},
      {GST_ELLIPSE_ROLE_CANDIDATE, "GST_ELLIPSE_ROLE_CANDIDATE", "candidate"},
      {GST_ELLIPSE_ROLE_TRUTH, "GST_ELLIPSE_ROLE_TRUTH", "truth"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseRole", kValues);
  return kType;
}

GType gst_ellipse_state_get_type(void) {
  static const GEnumValue kValues[] = {
      {GST_ELLIPSE_STATE_DETECTED, "GST_ELLIPSE_STATE_DETECTED", "detected"},
      {GST_ELLIPSE_STATE_TRACKED, "GST_ELLIPSE_STATE_TRACKED", "tracked"},
      {GST_ELLIPSE_STATE_PREDICTED, "GST_ELLIPSE_STATE_PREDICTED", "predicted"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseState", kValues);
  return kType;
}

/**
 * gst_ellipse_meta_api_get_type:
 *
 * The API type by which the ellipses of a buffer are counted and filtered, as in
 * [method@Gst.Buffer.get_n_meta]. Thread-safe.
 *
 * Returns: the type of the metadata's API
 *
 * Since: 0.1
 */
GType gst_ellipse_meta_api_get_type(void) {
  static const gchar* kTags[] = {GST_META_TAG_VIDEO_STR,
                                 GST_META_TAG_VIDEO_SIZE_STR,
                                 GST_META_TAG_VIDEO_ORIENTATION_STR,
                                 nullptr};
  static const GType kType = gst_meta_api_type_register("GstEllipseMetaAPI", kTags);
  return kType;
}

// All fields but the parent.
static void copy_fields(GstEllipseMeta* to, const GstEllipseMeta* from) {
  const GstMeta parent = to->meta;
  *to = *from;
  to->meta = parent;
}

static gboolean ellipse_meta_init(GstMeta* meta, gpointer, GstBuffer*) {
  GstEllipseMeta empty = {};
  empty.scale = 1;
  empty.pts = GST_CLOCK_TIME_NONE;
  empty.processing_time = GST_CLOCK_TIME_NONE;
  copy_fields(reinterpret_cast<GstEllipseMeta*>(meta), &empty);
  return TRUE;
}

// The part of a scaler's output that shows the picture. If the display aspect ratio changes,
// assumes the black borders that videoscale adds by default, since GstVideoMetaTransform does not
// specify them. Borders are whole chroma samples.
static ellipse::Rect picture_inside(const GstVideoInfo& in, const GstVideoInfo& out) {
  const gint width = GST_VIDEO_INFO_WIDTH(&out);
  const gint height = GST_VIDEO_INFO_HEIGHT(&out);
  gint n = 0;  // n / d: width / height of the picture in output pixels
  gint d = 0;
  const bool is_known =
      gst_util_fraction_multiply(
          in.width, in.height, GST_VIDEO_INFO_PAR_N(&in), GST_VIDEO_INFO_PAR_D(&in), &n, &d) &&
      gst_util_fraction_multiply(
          n, d, GST_VIDEO_INFO_PAR_D(&out), GST_VIDEO_INFO_PAR_N(&out), &n, &d);
  if (!is_known || n <= 0 || d <= 0) return {0, 0, width, height};
  const guint64 min_height = gst_util_uint64_scale_int(static_cast<guint64>(width), d, n);
  if (min_height <= static_cast<guint64>(height)) {
    const gint used = static_cast<gint>(min_height);
    const guint chroma = out.finfo->h_sub[1];
    return {0, (height - used) / 2 >> chroma << chroma, width, used};
  }
  const gint used =
      static_cast<gint>(gst_util_uint64_scale_int(static_cast<guint64>(height), n, d));
  const guint chroma = out.finfo->w_sub[1];
  return {(width - used) / 2 >> chroma << chroma, 0, used, height};
}

// The whole pixels that a span of pixels covers after scaling.
static void scale_span(gint& begin, guint& length, double factor, gint offset) {
  static constexpr double kFarthest = G_MAXINT / 2;
  const auto near = [](double value) { return std::clamp(value, -kFarthest, kFarthest); };
  const double end = near(std::ceil((static_cast<double>(begin) + length) * factor) + offset);
  const double first = near(std::floor(begin * factor) + offset);
  begin = static_cast<gint>(first);
  length = static_cast<guint>(std::max(0.0, end - first));
}

using Parameters = Eigen::Matrix<double, 5, 1>;

static Parameters parameters_of(const ellipse::Ellipse& e) {
  return {e.cx, e.cy, e.semi_major, e.semi_minor, e.angle_rad};
}

// Scales the covariance to first order, by differences of the parameters; unknown if they leave the
// ellipses.
static void scale_covariance(GstEllipseMeta* meta,
                             const ellipse::Ellipse& before,
                             const Eigen::Vector2d& factors,
                             const Eigen::Vector2d& shift) {
  constexpr double kStep = 1e-4;
  Eigen::Matrix<double, 5, 5> jacobian;
  for (int i = 0; i < 5; ++i) {
    const auto after = [&](double step) {
      Parameters p = parameters_of(before);
      p(i) += step;
      return ellipse::transformed({p(0), p(1), p(2), p(3), p(4)}, factors.asDiagonal(), shift);
    };
    const auto more = after(kStep);
    const auto less = after(-kStep);
    if (!more || !less) {
      meta->sigma_px = 0.0;  // unknown
      return;
    }
    Parameters change = parameters_of(*more) - parameters_of(*less);
    change(4) = std::remainder(change(4), G_PI);
    jacobian.col(i) = change / (2.0 * kStep);
  }
  Eigen::Matrix<double, 5, 5> covariance = unpacked_covariance<5>(meta->covariance);
  covariance = jacobian * covariance * jacobian.transpose();
  pack_covariance<5>(covariance, meta->covariance);
  meta->sigma_px = largest_sigma(covariance);
}

// Maps x to (x + 0.5) s - 0.5 in each direction: integer coordinates are pixel centres.
static gboolean scale_fields(GstEllipseMeta* meta, const GstVideoMetaTransform* scale) {
  const ellipse::Rect inside = picture_inside(*scale->in_info, *scale->out_info);
  const double sx = inside.width / static_cast<double>(GST_VIDEO_INFO_WIDTH(scale->in_info));
  const double sy = inside.height / static_cast<double>(GST_VIDEO_INFO_HEIGHT(scale->in_info));
  const ellipse::Ellipse before{
      meta->cx, meta->cy, meta->semi_major, meta->semi_minor, meta->angle_rad};
  const Eigen::Vector2d factors(sx, sy);
  const Eigen::Vector2d shift =
      Eigen::Vector2d(inside.x, inside.y) + 0.5 * (factors - Eigen::Vector2d::Ones());
  const std::optional<ellipse::Ellipse> after =
      ellipse::transformed(before, factors.asDiagonal(), shift);
  if (!after) return FALSE;
  if (meta->sigma_px > 0.0) scale_covariance(meta, before, factors, shift);
  meta->cx = after->cx;
  meta->cy = after->cy;
  meta->semi_major = after->semi_major;
  meta->semi_minor = after->semi_minor;
  meta->angle_rad = after->angle_rad;
  meta->centre_x = meta->centre_x * sx + shift.x();
  meta->centre_y = meta->centre_y * sy + shift.y();
  for (gsize i = 0; i + 1 < G_N_ELEMENTS(meta->outline); i += 2) {
    meta->outline[i] = static_cast<gfloat>(meta->outline[i] * sx + shift.x());
    meta->outline[i + 1] = static_cast<gfloat>(meta->outline[i + 1] * sy + shift.y());
  }
  scale_span(meta->roi_x, meta->roi_width, sx, inside.x);
  scale_span(meta->roi_y, meta->roi_height, sy, inside.y);
  meta->frame_width = static_cast<guint>(GST_VIDEO_INFO_WIDTH(scale->out_info));
  meta->frame_height = static_cast<guint>(GST_VIDEO_INFO_HEIGHT(scale->out_info));
  return TRUE;
}

static gboolean ellipse_meta_transform(
    GstBuffer* to, GstMeta* meta, GstBuffer*, GQuark type, gpointer data) {
  const auto* source = reinterpret_cast<GstEllipseMeta*>(meta);
  GstEllipseMeta moved = *source;
  if (GST_META_TRANSFORM_IS_COPY(type)) {
    // Part of the bytes is not a frame.
    if (static_cast<GstMetaTransformCopy*>(data)->region) return FALSE;
  } else if (!GST_VIDEO_META_TRANSFORM_IS_SCALE(type) ||
             !scale_fields(&moved, static_cast<GstVideoMetaTransform*>(data))) {
    return FALSE;
  }
  GstEllipseMeta* copy = gst_buffer_add_ellipse_meta(to, source->role);
  if (copy == nullptr) return FALSE;
  copy_fields(copy, &moved);
  return TRUE;
}

/**
 * gst_ellipse_meta_get_info:
 *
 * The registration of the metadata: its size, and how it is copied and scaled. Thread-safe.
 *
 * Returns: (transfer none): the registration, never freed
 *
 * Since: 0.1
 */
const GstMetaInfo* gst_ellipse_meta_get_info(void) {
  static const GstMetaInfo* kInfo = gst_meta_register(GST_ELLIPSE_META_API_TYPE,
                                                      "GstEllipseMeta",
                                                      sizeof(GstEllipseMeta),
                                                      ellipse_meta_init,
                                                      nullptr,
                                                      ellipse_meta_transform);
  return kInfo;
}

/**
 * gst_buffer_add_ellipse_meta:
 * @buffer: a writable buffer
 * @role: role of the ellipse
 *
 * Attaches an ellipse for the caller to fill in: all numbers are 0, the scale is 1, the times are
 * `GST_CLOCK_TIME_NONE`. Allocates the metadata. One thread at a time, like all writing to a
 * buffer.
 *
 * Returns: (transfer none): the ellipse, owned by the buffer
 *
 * Since: 0.1
 */
GstEllipseMeta* gst_buffer_add_ellipse_meta(GstBuffer* buffer, GstEllipseRole role) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  auto* meta = reinterpret_cast<GstEllipseMeta*>(
      gst_buffer_add_meta(buffer, GST_ELLIPSE_META_INFO, nullptr));
  if (meta != nullptr) meta->role = role;
  return meta;
}

/**
 * gst_buffer_iterate_ellipse_meta:
 * @buffer: a buffer
 * @state: (inout) (transfer none) (nullable): opaque, `NULL` before the first call
 *
 * Iterates over the ellipses of a buffer, in the order in which they were attached. Allocates
 * nothing.
 *
 * Returns: (transfer none) (nullable): the next ellipse, `NULL` after the last one
 *
 * Since: 0.1
 */
GstEllipseMeta* gst_buffer_iterate_ellipse_meta(GstBuffer* buffer, gpointer* state) {
  return reinterpret_cast<GstEllipseMeta*>(
      gst_buffer_iterate_meta_filtered(buffer, state, GST_ELLIPSE_META_API_TYPE));
}

/**
 * gst_buffer_list_ellipse_meta:
 * @buffer: a buffer
 *
 * Lists the ellipses of a buffer, in the order in which they were attached. For languages in which
 * a list is more convenient than [func@GstEllipse.buffer_iterate_ellipse_meta]. Allocates only the
 * list.
 *
 * Returns: (transfer container) (element-type GstEllipseMeta): a new list, empty if there
 *   are no ellipses; free it with `g_list_free()`. The buffer owns the ellipses
 *
 * Since: 0.1
 */
GList* gst_buffer_list_ellipse_meta(GstBuffer* buffer) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  GList* list = nullptr;
  gpointer state = nullptr;
  while (GstEllipseMeta* meta = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    list = g_list_prepend(list, meta);
  }
  return g_list_reverse(list);
}

/**
 * gst_buffer_get_ellipse_meta:
 * @buffer: a buffer
 * @role: the role to find
 *
 * Returns the first ellipse with a role, such as the target of a frame or the truth. If several
 * trackers follow each other, it is the result of the first one;
 * [func@GstEllipse.buffer_iterate_ellipse_meta] returns all. Allocates nothing.
 *
 * Returns: (transfer none) (nullable): the first ellipse with that role, owned by the buffer;
 *   `NULL` if there is none
 *
 * Since: 0.1
 */
GstEllipseMeta* gst_buffer_get_ellipse_meta(GstBuffer* buffer, GstEllipseRole role) {
  gpointer state = nullptr;
  while (GstEllipseMeta* meta = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    if (meta->role == role) return meta;
  }
  return nullptr;
}

/**
 * gst_ellipse_meta_get_role_name:
 * @meta: an ellipse
 *
 * Returns the name of the role. Thread-safe; allocates nothing.
 *
 * Returns: (transfer none): "target", "candidate" or "truth"; "unknown" for any other number
 *
 * Since: 0.1
 */
const gchar* gst_ellipse_meta_get_role_name(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  return nick_of(GST_TYPE_ELLIPSE_ROLE, &meta->role);
}

/**
 * gst_ellipse_meta_get_state_name:
 * @meta: an ellipse
 *
 * Returns the name of the state. Thread-safe; allocates nothing.
 *
 * Returns: (transfer none): "detected", "tracked" or "predicted"; "unknown" for any other number
 *
 * Since: 0.1
 */
const gchar* gst_ellipse_meta_get_state_name(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  return nick_of(GST_TYPE_ELLIPSE_STATE, &meta->state);
}
