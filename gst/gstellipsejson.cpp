/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipsejson
 * @title: ellipsejson
 *
 * Writes the ellipses on video buffers as text: one JSON object on one line per frame, even if
 * nothing was found. Works with any sink: filesink, fdsink, udpsink, tcpserversink.
 *
 * |[
 * gst-launch-1.0 -q ellipsetestsrc num-buffers=3 ! ellipsetrack ! ellipsejson ! fdsink
 * ]|
 *
 * Since: 0.1
 */

#include "gst/gstellipsejson.h"

#include <gst/video/video.h>

#include <string>

#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/video_view.hpp"

struct _GstEllipseJson {
  GstBaseTransform parent;

  GstVideoInfo info;
  guint64 frame;
  gboolean writes_times;  // under the object lock
};

enum { PROP_0, PROP_TIMES };

G_DEFINE_TYPE(GstEllipseJson, gst_ellipse_json, GST_TYPE_BASE_TRANSFORM)

GST_ELEMENT_REGISTER_DEFINE(ellipsejson, "ellipsejson", GST_RANK_NONE, GST_TYPE_ELLIPSE_JSON)

#define SINK_CAPS "video/x-raw(ANY); video/x-bayer(ANY)"
#define SRC_CAPS "application/x-ndjson"

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(SINK_CAPS));

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(SRC_CAPS));

static GstCaps* gst_ellipse_json_transform_caps(GstBaseTransform*,
                                                GstPadDirection direction,
                                                GstCaps*,
                                                GstCaps* filter) {
  GstCaps* all = gst_caps_from_string(direction == GST_PAD_SINK ? SRC_CAPS : SINK_CAPS);
  if (filter == nullptr) return all;
  GstCaps* some = gst_caps_intersect_full(filter, all, GST_CAPS_INTERSECT_FIRST);
  gst_caps_unref(all);
  return some;
}

static gboolean gst_ellipse_json_set_caps(GstBaseTransform* base, GstCaps* in, GstCaps*) {
  GstVideoInfo* info = &GST_ELLIPSE_JSON(base)->info;
  return is_mosaic(in) ? set_mosaic_info(info, in) : gst_video_info_from_caps(info, in);
}

// Removes a member whose value is a number or null.
static void remove_member(std::string& json, const std::string& name) {
  const std::size_t begin = json.find(",\"" + name + "\":");
  if (begin != std::string::npos) json.erase(begin, json.find_first_of(",}", begin + 1) - begin);
}

static std::string line_of(GstEllipseJson* self, GstBuffer* buffer) {
  gchar* json = gst_buffer_ellipses_to_json(buffer,
                                            self->frame,
                                            static_cast<guint>(GST_VIDEO_INFO_WIDTH(&self->info)),
                                            static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&self->info)));
  std::string line = json;
  g_free(json);
  GST_OBJECT_LOCK(self);
  const bool writes_times = self->writes_times != FALSE;
  GST_OBJECT_UNLOCK(self);
  if (!writes_times) remove_member(line, "processing_ns");
  return line + "\n";
}

static GstFlowReturn gst_ellipse_json_prepare_output_buffer(GstBaseTransform* base,
                                                            GstBuffer* in,
                                                            GstBuffer** out) {
  auto* self = GST_ELLIPSE_JSON(base);
  const std::string line = line_of(self, in);
  ++self->frame;
  *out = gst_buffer_new_memdup(line.data(), line.size());
  gst_buffer_copy_into(*out, in, GST_BUFFER_COPY_TIMESTAMPS, 0, -1);
  return GST_FLOW_OK;
}

// prepare_output_buffer() writes the complete output.
static GstFlowReturn gst_ellipse_json_transform(GstBaseTransform*, GstBuffer*, GstBuffer*) {
  return GST_FLOW_OK;
}

static gboolean gst_ellipse_json_start(GstBaseTransform* base) {
  GST_ELLIPSE_JSON(base)->frame = 0;
  return TRUE;
}

static gboolean gst_ellipse_json_propose_allocation(GstBaseTransform*, GstQuery*, GstQuery* query) {
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  return TRUE;
}

static void gst_ellipse_json_set_property(GObject* object,
                                          guint id,
                                          const GValue* value,
                                          GParamSpec* pspec) {
  if (id != PROP_TIMES) {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    return;
  }
  GST_OBJECT_LOCK(object);
  GST_ELLIPSE_JSON(object)->writes_times = g_value_get_boolean(value);
  GST_OBJECT_UNLOCK(object);
}

static void gst_ellipse_json_get_property(GObject* object,
                                          guint id,
                                          GValue* value,
                                          GParamSpec* pspec) {
  if (id != PROP_TIMES) {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    return;
  }
  GST_OBJECT_LOCK(object);
  g_value_set_boolean(value, GST_ELLIPSE_JSON(object)->writes_times);
  GST_OBJECT_UNLOCK(object);
}

static void gst_ellipse_json_init(GstEllipseJson* self) {
  gst_video_info_init(&self->info);
  self->writes_times = TRUE;
}

static void gst_ellipse_json_class_init(GstEllipseJsonClass* klass) {
  auto* object_class = G_OBJECT_CLASS(klass);
  object_class->set_property = gst_ellipse_json_set_property;
  object_class->get_property = gst_ellipse_json_get_property;
  g_object_class_install_property(
      object_class,
      PROP_TIMES,
      g_param_spec_boolean("times",
                           "Times",
                           "Write processing_ns, which differs between runs",
                           TRUE,
                           static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                    GST_PARAM_MUTABLE_PLAYING)));

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipses to JSON",
                                        "Filter/Converter/Video",
                                        "Writes the ellipses that buffers carry as JSON lines",
                                        "The gst-ellipse authors");
  gst_element_class_add_static_pad_template(element_class, &sink_template);
  gst_element_class_add_static_pad_template(element_class, &src_template);

  auto* base_class = GST_BASE_TRANSFORM_CLASS(klass);
  base_class->transform_caps = gst_ellipse_json_transform_caps;
  base_class->set_caps = gst_ellipse_json_set_caps;
  base_class->prepare_output_buffer = gst_ellipse_json_prepare_output_buffer;
  base_class->transform = gst_ellipse_json_transform;
  base_class->start = gst_ellipse_json_start;
  base_class->propose_allocation = gst_ellipse_json_propose_allocation;
}
