/* SPDX-License-Identifier: MIT */
#include "gst/ellipse/gstellipsesearchmeta.h"

#include <gst/video/gstvideometa.h>
#include <gst/video/video.h>

#include "gst/ellipse/enum_nick.hpp"

GType gst_ellipse_tracker_state_get_type(void) {
  static const GEnumValue kValues[] = {
      {GST_ELLIPSE_TRACKER_STATE_UNKNOWN, "GST_ELLIPSE_TRACKER_STATE_UNKNOWN", "unknown"},
      {GST_ELLIPSE_TRACKER_STATE_SEARCHING, "GST_ELLIPSE_TRACKER_STATE_SEARCHING", "searching"},
      {GST_ELLIPSE_TRACKER_STATE_CONFIRMING, "GST_ELLIPSE_TRACKER_STATE_CONFIRMING", "confirming"},
      {GST_ELLIPSE_TRACKER_STATE_FOLLOWING, "GST_ELLIPSE_TRACKER_STATE_FOLLOWING", "following"},
      {GST_ELLIPSE_TRACKER_STATE_COASTING, "GST_ELLIPSE_TRACKER_STATE_COASTING", "coasting"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseTrackerState", kValues);
  return kType;
}

/**
 * gst_ellipse_search_meta_api_get_type:
 *
 * The API type by which this metadata is filtered, as in [method@Gst.Buffer.get_meta]. Thread-safe.
 *
 * Returns: the type of the metadata's API
 *
 * Since: 0.1
 */
GType gst_ellipse_search_meta_api_get_type(void) {
  // The same tags as the ellipses: an element that drops the ellipses must also drop this metadata.
  // Otherwise the buffer would state that nothing was found.
  static const gchar* kTags[] = {GST_META_TAG_VIDEO_STR,
                                 GST_META_TAG_VIDEO_SIZE_STR,
                                 GST_META_TAG_VIDEO_ORIENTATION_STR,
                                 nullptr};
  static const GType kType = gst_meta_api_type_register("GstEllipseSearchMetaAPI", kTags);
  return kType;
}

static gboolean search_meta_init(GstMeta* meta, gpointer, GstBuffer*) {
  auto* search = reinterpret_cast<GstEllipseSearchMeta*>(meta);
  search->processing_time = GST_CLOCK_TIME_NONE;
  search->tracker_state = GST_ELLIPSE_TRACKER_STATE_UNKNOWN;
  return TRUE;
}

static gboolean search_meta_transform(
    GstBuffer* to, GstMeta* meta, GstBuffer*, GQuark type, gpointer data) {
  const bool is_whole_copy =
      GST_META_TRANSFORM_IS_COPY(type) && !static_cast<const GstMetaTransformCopy*>(data)->region;
  if (!is_whole_copy && !GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) return FALSE;
  const auto* source = reinterpret_cast<const GstEllipseSearchMeta*>(meta);
  GstEllipseSearchMeta* copy = gst_buffer_add_ellipse_search_meta(to, source->processing_time);
  if (copy == nullptr) return FALSE;
  copy->tracker_state = source->tracker_state;
  return TRUE;
}

/**
 * gst_ellipse_search_meta_get_info:
 *
 * The registration of the metadata: its size, and how it is copied. Thread-safe.
 *
 * Returns: (transfer none): the registration, never freed
 *
 * Since: 0.1
 */
const GstMetaInfo* gst_ellipse_search_meta_get_info(void) {
  static const GstMetaInfo* kInfo = gst_meta_register(GST_ELLIPSE_SEARCH_META_API_TYPE,
                                                      "GstEllipseSearchMeta",
                                                      sizeof(GstEllipseSearchMeta),
                                                      search_meta_init,
                                                      nullptr,
                                                      search_meta_transform);
  return kInfo;
}

/**
 * gst_buffer_add_ellipse_search_meta:
 * @buffer: (transfer none): a writable #GstBuffer
 * @processing_time: processing time of the frame, in ns; %GST_CLOCK_TIME_NONE if unknown
 *
 * Marks the frame of a buffer as searched. The tracker's state is
 * `GST_ELLIPSE_TRACKER_STATE_UNKNOWN` until the caller sets it. Allocates the metadata; one thread
 * at a time, like all writing to a buffer.
 *
 * Returns: (transfer none): the #GstEllipseSearchMeta, owned by the buffer
 *
 * Since: 0.1
 */
GstEllipseSearchMeta* gst_buffer_add_ellipse_search_meta(GstBuffer* buffer,
                                                         GstClockTime processing_time) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  auto* meta = reinterpret_cast<GstEllipseSearchMeta*>(
      gst_buffer_add_meta(buffer, GST_ELLIPSE_SEARCH_META_INFO, nullptr));
  if (meta != nullptr) meta->processing_time = processing_time;
  return meta;
}

/**
 * gst_buffer_get_ellipse_search_meta:
 * @buffer: (transfer none): a #GstBuffer
 *
 * Returns the search metadata of a buffer, which marks its frame as searched. Allocates nothing.
 *
 * Returns: (transfer none) (nullable): the metadata, %NULL if the frame was not searched or an
 * element has dropped the metadata
 *
 * Since: 0.1
 */
GstEllipseSearchMeta* gst_buffer_get_ellipse_search_meta(GstBuffer* buffer) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  return reinterpret_cast<GstEllipseSearchMeta*>(
      gst_buffer_get_meta(buffer, GST_ELLIPSE_SEARCH_META_API_TYPE));
}

/**
 * gst_ellipse_search_meta_get_tracker_state_name:
 * @meta: metadata of a frame's search
 *
 * Returns the name of the tracker's state. Thread-safe; allocates nothing.
 *
 * Returns: (transfer none): "searching", "confirming", "following" or "coasting"; "unknown" for any
 *   other number
 *
 * Since: 0.2
 */
const gchar* gst_ellipse_search_meta_get_tracker_state_name(const GstEllipseSearchMeta* meta) {
  g_return_val_if_fail(meta != nullptr, nullptr);
  return nick_of(GST_TYPE_ELLIPSE_TRACKER_STATE, &meta->tracker_state);
}
