/* SPDX-License-Identifier: MIT */
/* The metadata as structures and as JSON. */
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <variant>

#include "gst/ellipse/gstellipsemeta.h"
#include "gst/ellipse/gstellipsesearchmeta.h"

// A field of the structure. The quarks of all names are looked up once, not per frame.
class Field {
 public:
  template <class Number>
  Field(const gchar* name, Number GstEllipseMeta::*member)
      : name_(g_quark_from_static_string(name)), member_(member) {}

  void set(GstStructure* structure, const GstEllipseMeta* meta) const {
    GValue value = G_VALUE_INIT;
    std::visit([&](auto member) { init(&value, meta->*member); }, member_);
    gst_structure_id_take_value(structure, name_, &value);
  }

 private:
  static void init(GValue* value, gdouble number) {
    g_value_init(value, G_TYPE_DOUBLE);
    g_value_set_double(value, number);
  }
  static void init(GValue* value, gint number) {
    g_value_init(value, G_TYPE_INT);
    g_value_set_int(value, number);
  }
  static void init(GValue* value, guint number) {
    g_value_init(value, G_TYPE_UINT);
    g_value_set_uint(value, number);
  }
  static void init(GValue* value, guint64 number) {
    g_value_init(value, G_TYPE_UINT64);
    g_value_set_uint64(value, number);
  }

  GQuark name_;
  std::variant<gdouble GstEllipseMeta::*,
               gint GstEllipseMeta::*,
               guint GstEllipseMeta::*,
               guint64 GstEllipseMeta::*>
      member_;
};

#define FIELD(name) Field(#name, &GstEllipseMeta::name)

static void add_ellipse(GstStructure* structure, const GstEllipseMeta* meta) {
  static const Field kFields[] = {FIELD(id),
                                  FIELD(cx),
                                  FIELD(cy),
                                  FIELD(semi_major),
                                  FIELD(semi_minor),
                                  FIELD(angle_rad),
                                  FIELD(contour_overlap),
                                  FIELD(ellipse_overlap),
                                  FIELD(probability),
                                  FIELD(visible_fraction),
                                  FIELD(scale),
                                  FIELD(roi_x),
                                  FIELD(roi_y),
                                  FIELD(roi_width),
                                  FIELD(roi_height),
                                  FIELD(frame_width),
                                  FIELD(frame_height),
                                  FIELD(pts),
                                  FIELD(processing_time)};
  for (const Field& field : kFields) field.set(structure, meta);
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

static void add_covariance(GstStructure* structure, const GstEllipseMeta* meta) {
  static const Field kSigma = FIELD(sigma_px);
  kSigma.set(structure, meta);
  set_numbers(structure, "covariance", meta->covariance, G_N_ELEMENTS(meta->covariance));
}

static void add_pose(GstStructure* structure, const GstEllipseMeta* meta) {
  static const Field kFields[] = {FIELD(bearing_x),
                                  FIELD(bearing_y),
                                  FIELD(bearing_z),
                                  FIELD(angle_x),
                                  FIELD(angle_y),
                                  FIELD(centre_x),
                                  FIELD(centre_y),
                                  FIELD(normal_x),
                                  FIELD(normal_y),
                                  FIELD(normal_z),
                                  FIELD(other_normal_x),
                                  FIELD(other_normal_y),
                                  FIELD(other_normal_z),
                                  FIELD(certainty)};
  for (const Field& field : kFields) field.set(structure, meta);
}

// A static string.
static void set_name(GstStructure* structure, GQuark field, const gchar* name) {
  GValue value = G_VALUE_INIT;
  g_value_init(&value, G_TYPE_STRING);
  g_value_set_static_string(&value, name);
  gst_structure_id_take_value(structure, field, &value);
}

static void add_position(GstStructure* structure, const GstEllipseMeta* meta) {
  static const Field kFields[] = {FIELD(position_x),
                                  FIELD(position_y),
                                  FIELD(position_z),
                                  FIELD(other_position_x),
                                  FIELD(other_position_y),
                                  FIELD(other_position_z)};
  for (const Field& field : kFields) field.set(structure, meta);
  set_numbers(structure,
              "position_covariance",
              meta->position_covariance,
              G_N_ELEMENTS(meta->position_covariance));
}

/**
 * gst_ellipse_meta_to_structure:
 * @meta: an ellipse
 *
 * Copies all fields by name into a structure named "ellipse": role and state as nicks, covariances
 * and outline as arrays; covariance, pose, position and outline only if known. Use it for data that
 * outlives the buffer.
 *
 * Returns: (transfer full): a new structure
 *
 * Since: 0.1
 */
GstStructure* gst_ellipse_meta_to_structure(const GstEllipseMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  static const GQuark kRole = g_quark_from_static_string("role");
  static const GQuark kState = g_quark_from_static_string("state");
  static const GQuark kName = g_quark_from_static_string("ellipse");
  GstStructure* structure = gst_structure_new_id_empty(kName);
  set_name(structure, kRole, gst_ellipse_meta_get_role_name(meta));
  set_name(structure, kState, gst_ellipse_meta_get_state_name(meta));
  add_ellipse(structure, meta);
  if (meta->sigma_px > 0.0) add_covariance(structure, meta);
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

// With a decimal point in any locale. Not finite: null, because JSON has no NaN.
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

// A nested object, such as ,"bearing":{"x":0,"y":0,"z":1}.
static void append_object(GString* json,
                          const gchar* name,
                          const gchar* format,
                          std::initializer_list<Member> members) {
  g_string_append_printf(json, ",\"%s\":{", name);
  const gsize begin = json->len;
  for (const Member& member : members) append_number(json, member.name, format, member.value);
  g_string_erase(json, static_cast<gssize>(begin), 1);  // the leading comma
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
 * Writes the ellipse as a JSON object on one line: role, id, state, cx, cy, semi_major, semi_minor,
 * angle_rad, contour_overlap, ellipse_overlap, probability, visible, scale, in pixels and radians;
 * and, if known, sigma_px and the search region roi as x, y, width and height. With a camera also
 * bearing, angle_x, angle_y, centre, normal, other_normal, certainty; with the target's diameter
 * position, other_position, position_covariance in metres. The truth has no state, overlaps,
 * probability or scale. A number that is not finite is null.
 *
 * Returns: (transfer full): a new string; free it with `g_free()`
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
    append_number(json, "probability", "%.4f", meta->probability);
  }
  if (meta->sigma_px > 0.0) append_number(json, "sigma_px", "%.4f", meta->sigma_px);
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

static void append_tracker_state(GString* json, const GstEllipseSearchMeta* search) {
  if (search == nullptr || search->tracker_state == GST_ELLIPSE_TRACKER_STATE_UNKNOWN) {
    g_string_append(json, ",\"tracker\":null");
  } else {
    g_string_append_printf(
        json, ",\"tracker\":\"%s\"", gst_ellipse_search_meta_get_tracker_state_name(search));
  }
}

/**
 * gst_buffer_ellipses_to_json:
 * @buffer: a buffer
 * @frame: the number of the frame
 * @width: width of the frame in px
 * @height: height of the frame in px
 *
 * Writes all ellipses of a frame as a JSON object on one line, without a newline: frame, pts_ns,
 * width, height, processing_ns, tracker (its state), and the array targets, which may be empty.
 * Unknown times and an unknown state are null. The element ellipsejson writes these lines.
 *
 * Returns: (transfer full): a new string; free it with `g_free()`
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
  append_tracker_state(json, search);
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
