/* SPDX-License-Identifier: MIT */
#include "gst/ellipse/gstellipsemeta.h"

#include <gst/video/gstvideometa.h>
#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>

#include "core/ellipse.hpp"
#include "core/image_view.hpp"
#include "gst/ellipse/gstellipsesearchmeta.h"

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
 * The type that the ellipses of a buffer are counted and filtered by, as in
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

// The field is read as the number that it is: it may come from anybody, and be no value of its
// type.
template <class Enum>
static const gchar* nick_of(GType type, const Enum* field) {
  gint number = 0;
  static_assert(sizeof(Enum) == sizeof(gint));
  std::memcpy(&number, field, sizeof number);
  auto* enum_class = static_cast<GEnumClass*>(g_type_class_ref(type));
  const GEnumValue* entry = g_enum_get_value(enum_class, number);
  g_type_class_unref(enum_class);  // static types keep their strings
  return entry != nullptr ? entry->value_nick : "unknown";
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

// Where a scaler puts the picture: between black borders where its shape is another one, as
// videoscale does unless told otherwise; GstVideoMetaTransform does not say whether it was. Borders
// are whole pixels of the chroma.
static ellipse::Rect picture_inside(const GstVideoInfo& in, const GstVideoInfo& out) {
  const gint width = GST_VIDEO_INFO_WIDTH(&out);
  const gint height = GST_VIDEO_INFO_HEIGHT(&out);
  gint n = 0;  // n / d: width by height of the picture, in pixels of the output
  gint d = 0;
  const bool is_known =
      gst_util_fraction_multiply(
          in.width, in.height, GST_VIDEO_INFO_PAR_N(&in), GST_VIDEO_INFO_PAR_D(&in), &n, &d) &&
      gst_util_fraction_multiply(
          n, d, GST_VIDEO_INFO_PAR_D(&out), GST_VIDEO_INFO_PAR_N(&out), &n, &d);
  if (!is_known) return {0, 0, width, height};
  const guint64 least_height = gst_util_uint64_scale_int(static_cast<guint64>(width), d, n);
  if (least_height <= static_cast<guint64>(height)) {
    const gint used = static_cast<gint>(least_height);
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

// x becomes (x + 0.5) s - 0.5 in each direction, so that pixels keep the area that they cover.
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
    // A part of the bytes is no picture any more.
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
 * What GStreamer knows of the metadata: its size, and how it is copied and scaled. Thread-safe.
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
 * @role: what the ellipse stands for
 *
 * Attaches an ellipse, all of whose numbers are still to be filled in: 0, the scale 1, the times
 * `GST_CLOCK_TIME_NONE`. Allocates the metadata; as all that writes to a buffer, for one thread at
 * a time.
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
 * @state: (inout) (transfer none) (nullable): opaque, to be `NULL` before the first call
 *
 * The ellipses of a buffer, one after the other, in the order in which they were attached.
 * Allocates nothing.
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
 * The ellipses of a buffer, in the order in which they were attached. For languages in which a list
 * is handier than [func@GstEllipse.buffer_iterate_ellipse_meta]; allocates the list alone.
 *
 * Returns: (transfer container) (element-type GstEllipseMeta): a new list of the ellipses, which
 *   the buffer owns; empty where there are none. `g_list_free()` frees it
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
 * @role: the role that is looked for
 *
 * The target of a frame, or the truth. Allocates nothing.
 *
 * Returns: (transfer none) (nullable): the first ellipse with that role, owned by the buffer;
 *   `NULL` where there is none
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
 * Its role in a word. Thread-safe; allocates nothing.
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
 * Its state in a word. Thread-safe; allocates nothing.
 *
 * Returns: (transfer none): "detected", "tracked" or "predicted"; "unknown" for any other number
 *
 * Since: 0.1
 */
const gchar* gst_ellipse_meta_get_state_name(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  return nick_of(GST_TYPE_ELLIPSE_STATE, &meta->state);
}

static void set_numbers(GstStructure* structure,
                        const gchar* name,
                        const gdouble* numbers,
                        guint count) {
  GValue list = G_VALUE_INIT;
  g_value_init(&list, GST_TYPE_ARRAY);
  for (guint i = 0; i < count; ++i) {
    GValue number = G_VALUE_INIT;
    g_value_init(&number, G_TYPE_DOUBLE);
    g_value_set_double(&number, numbers[i]);
    gst_value_array_append_and_take_value(&list, &number);
  }
  gst_structure_take_value(structure, name, &list);
}

static void add_pose(GstStructure* structure, const GstEllipseMeta* meta) {
  // clang-format off
  gst_structure_set(structure,
                    "bearing_x", G_TYPE_DOUBLE, meta->bearing_x,
                    "bearing_y", G_TYPE_DOUBLE, meta->bearing_y,
                    "bearing_z", G_TYPE_DOUBLE, meta->bearing_z,
                    "angle_x", G_TYPE_DOUBLE, meta->angle_x,
                    "angle_y", G_TYPE_DOUBLE, meta->angle_y,
                    "centre_x", G_TYPE_DOUBLE, meta->centre_x,
                    "centre_y", G_TYPE_DOUBLE, meta->centre_y,
                    "normal_x", G_TYPE_DOUBLE, meta->normal_x,
                    "normal_y", G_TYPE_DOUBLE, meta->normal_y,
                    "normal_z", G_TYPE_DOUBLE, meta->normal_z,
                    "other_normal_x", G_TYPE_DOUBLE, meta->other_normal_x,
                    "other_normal_y", G_TYPE_DOUBLE, meta->other_normal_y,
                    "other_normal_z", G_TYPE_DOUBLE, meta->other_normal_z,
                    "certainty", G_TYPE_DOUBLE, meta->certainty,
                    nullptr);
  // clang-format on
}

static void add_position(GstStructure* structure, const GstEllipseMeta* meta) {
  // clang-format off
  gst_structure_set(structure,
                    "position_x", G_TYPE_DOUBLE, meta->position_x,
                    "position_y", G_TYPE_DOUBLE, meta->position_y,
                    "position_z", G_TYPE_DOUBLE, meta->position_z,
                    "other_position_x", G_TYPE_DOUBLE, meta->other_position_x,
                    "other_position_y", G_TYPE_DOUBLE, meta->other_position_y,
                    "other_position_z", G_TYPE_DOUBLE, meta->other_position_z,
                    nullptr);
  // clang-format on
  set_numbers(structure,
              "position_covariance",
              meta->position_covariance,
              G_N_ELEMENTS(meta->position_covariance));
}

/**
 * gst_ellipse_meta_to_structure:
 * @meta: an ellipse
 *
 * All fields by their names in a structure named "ellipse"; role and state as their nicks, the
 * numbers of the covariance and the outline as arrays, and of pose, position and outline what is
 * known. What is to outlive the buffer is kept this way.
 *
 * Returns: (transfer full): a new structure, of the caller's
 *
 * Since: 0.1
 */
GstStructure* gst_ellipse_meta_to_structure(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  // clang-format off
  GstStructure* structure = gst_structure_new("ellipse",
                           "role", G_TYPE_STRING, gst_ellipse_meta_get_role_name(meta),
                           "state", G_TYPE_STRING, gst_ellipse_meta_get_state_name(meta),
                           "id", G_TYPE_UINT64, meta->id,
                           "cx", G_TYPE_DOUBLE, meta->cx,
                           "cy", G_TYPE_DOUBLE, meta->cy,
                           "semi_major", G_TYPE_DOUBLE, meta->semi_major,
                           "semi_minor", G_TYPE_DOUBLE, meta->semi_minor,
                           "angle_rad", G_TYPE_DOUBLE, meta->angle_rad,
                           "contour_overlap", G_TYPE_DOUBLE, meta->contour_overlap,
                           "ellipse_overlap", G_TYPE_DOUBLE, meta->ellipse_overlap,
                           "visible_fraction", G_TYPE_DOUBLE, meta->visible_fraction,
                           "scale", G_TYPE_UINT, meta->scale,
                           "roi_x", G_TYPE_INT, meta->roi_x,
                           "roi_y", G_TYPE_INT, meta->roi_y,
                           "roi_width", G_TYPE_UINT, meta->roi_width,
                           "roi_height", G_TYPE_UINT, meta->roi_height,
                           "frame_width", G_TYPE_UINT, meta->frame_width,
                           "frame_height", G_TYPE_UINT, meta->frame_height,
                           "pts", GST_TYPE_CLOCK_TIME, meta->pts,
                           "processing_time", GST_TYPE_CLOCK_TIME, meta->processing_time,
                           nullptr);
  // clang-format on
  if (meta->has_pose) add_pose(structure, meta);
  if (meta->has_position) add_position(structure, meta);
  const guint points = std::min<guint>(meta->n_outline, G_N_ELEMENTS(meta->outline) / 2);
  if (points > 0) {
    gdouble numbers[G_N_ELEMENTS(meta->outline)];
    std::copy_n(meta->outline, 2 * points, numbers);
    set_numbers(structure, "outline", numbers, 2 * points);
  }
  return structure;
}

// With a point whatever the locale; JSON knows no NaN.
static void append_number(GString* json, const gchar* name, const gchar* format, gdouble value) {
  gchar text[G_ASCII_DTOSTR_BUF_SIZE];
  g_string_append_printf(
      json,
      ",\"%s\":%s",
      name,
      std::isfinite(value) ? g_ascii_formatd(text, sizeof text, format, value) : "null");
}

struct Member {
  const gchar* name;
  gdouble value;
};

// An object in the object, such as ,"bearing":{"x":0,"y":0,"z":1}.
static void append_object(GString* json,
                          const gchar* name,
                          const gchar* format,
                          std::initializer_list<Member> members) {
  g_string_append_printf(json, ",\"%s\":{", name);
  const gsize begin = json->len;
  for (const Member& member : members) append_number(json, member.name, format, member.value);
  g_string_erase(json, static_cast<gssize>(begin), 1);  // the comma before the first
  g_string_append_c(json, '}');
}

static void append_vector(GString* json, const gchar* name, gdouble x, gdouble y, gdouble z) {
  append_object(json, name, "%.6f", {{"x", x}, {"y", y}, {"z", z}});
}

static void append_pose(GString* json, const GstEllipseMeta* meta) {
  append_vector(json, "bearing", meta->bearing_x, meta->bearing_y, meta->bearing_z);
  append_number(json, "angle_x", "%.6f", meta->angle_x);
  append_number(json, "angle_y", "%.6f", meta->angle_y);
  append_object(json, "centre", "%.4f", {{"x", meta->centre_x}, {"y", meta->centre_y}});
  append_vector(json, "normal", meta->normal_x, meta->normal_y, meta->normal_z);
  append_vector(
      json, "other_normal", meta->other_normal_x, meta->other_normal_y, meta->other_normal_z);
  append_number(json, "certainty", "%.4f", meta->certainty);
}

static void append_position(GString* json, const GstEllipseMeta* meta) {
  append_vector(json, "position", meta->position_x, meta->position_y, meta->position_z);
  append_vector(json,
                "other_position",
                meta->other_position_x,
                meta->other_position_y,
                meta->other_position_z);
  gchar text[G_ASCII_DTOSTR_BUF_SIZE];
  const gchar* separator = ",\"position_covariance\":[";
  for (const gdouble value : meta->position_covariance) {
    g_string_append(json, separator);
    g_string_append(
        json, std::isfinite(value) ? g_ascii_formatd(text, sizeof text, "%.6e", value) : "null");
    separator = ",";
  }
  g_string_append_c(json, ']');
}

/**
 * gst_ellipse_meta_to_json:
 * @meta: an ellipse
 *
 * The ellipse as a JSON object on one line: role, id, state, cx, cy, semi_major, semi_minor,
 * angle_rad, contour_overlap, ellipse_overlap, visible, scale; pixels and radians; and, where one
 * is known, the region that was searched, roi, as x, y, width and height. With a camera also
 * bearing, angle_x, angle_y, centre, normal, other_normal, certainty; with the target's diameter
 * position, other_position, position_covariance; metres. The truth has neither state nor overlaps
 * nor scale; a number that is not finite is null.
 *
 * Returns: (transfer full): a new string, which `g_free()` frees
 *
 * Since: 0.1
 */
gchar* gst_ellipse_meta_to_json(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  GString* json = g_string_new(nullptr);
  g_string_append_printf(json,
                         "{\"role\":\"%s\",\"id\":%" G_GUINT64_FORMAT,
                         gst_ellipse_meta_get_role_name(meta),
                         meta->id);
  const bool was_found = meta->role != GST_ELLIPSE_ROLE_TRUTH;
  if (was_found) {
    g_string_append_printf(json, ",\"state\":\"%s\"", gst_ellipse_meta_get_state_name(meta));
  }
  append_number(json, "cx", "%.4f", meta->cx);
  append_number(json, "cy", "%.4f", meta->cy);
  append_number(json, "semi_major", "%.4f", meta->semi_major);
  append_number(json, "semi_minor", "%.4f", meta->semi_minor);
  append_number(json, "angle_rad", "%.6f", meta->angle_rad);
  if (was_found) {
    append_number(json, "contour_overlap", "%.4f", meta->contour_overlap);
    append_number(json, "ellipse_overlap", "%.4f", meta->ellipse_overlap);
  }
  append_number(json, "visible", "%.4f", meta->visible_fraction);
  if (was_found) g_string_append_printf(json, ",\"scale\":%u", meta->scale);
  if (meta->roi_width > 0 && meta->roi_height > 0) {
    g_string_append_printf(json,
                           ",\"roi\":[%d,%d,%u,%u]",
                           meta->roi_x,
                           meta->roi_y,
                           meta->roi_width,
                           meta->roi_height);
  }
  if (meta->has_pose) append_pose(json, meta);
  if (meta->has_position) append_position(json, meta);
  g_string_append_c(json, '}');
  return g_string_free(json, FALSE);
}

static void append_time(GString* json, const gchar* name, GstClockTime time) {
  if (GST_CLOCK_TIME_IS_VALID(time)) {
    g_string_append_printf(json, ",\"%s\":%" G_GUINT64_FORMAT, name, time);
  } else {
    g_string_append_printf(json, ",\"%s\":null", name);
  }
}

/**
 * gst_buffer_ellipses_to_json:
 * @buffer: a buffer
 * @frame: the number of the frame
 * @width: width of the frame in px
 * @height: height of the frame in px
 *
 * All that a frame says of ellipses as a JSON object on one line, without a newline: frame, pts_ns,
 * width, height, processing_ns, and the array targets, also where nothing was found. It is what the
 * element ellipsejson writes.
 *
 * Returns: (transfer full): a new string, which `g_free()` frees
 *
 * Since: 0.1
 */
gchar* gst_buffer_ellipses_to_json(GstBuffer* buffer, guint64 frame, guint width, guint height) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  GString* json = g_string_new(nullptr);
  g_string_append_printf(json, "{\"frame\":%" G_GUINT64_FORMAT, frame);
  append_time(json, "pts_ns", GST_BUFFER_PTS(buffer));
  g_string_append_printf(json, ",\"width\":%u,\"height\":%u", width, height);
  const GstEllipseSearchMeta* search = gst_buffer_get_ellipse_search_meta(buffer);
  append_time(
      json, "processing_ns", search != nullptr ? search->processing_time : GST_CLOCK_TIME_NONE);
  g_string_append(json, ",\"targets\":[");
  gpointer state = nullptr;
  const gchar* separator = "";
  while (const GstEllipseMeta* meta = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    gchar* ellipse = gst_ellipse_meta_to_json(meta);
    g_string_append_printf(json, "%s%s", separator, ellipse);
    g_free(ellipse);
    separator = ",";
  }
  g_string_append(json, "]}");
  return g_string_free(json, FALSE);
}
