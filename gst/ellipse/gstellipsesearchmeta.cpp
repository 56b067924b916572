/* SPDX-License-Identifier: MIT */
#include "gst/ellipse/gstellipsesearchmeta.h"

#include <gst/video/gstvideometa.h>
#include <gst/video/video.h>

/**
 * gst_ellipse_search_meta_api_get_type:
 *
 * The type that this metadata is filtered by, as in [method@Gst.Buffer.get_meta]. Thread-safe.
 *
 * Returns: the type of the metadata's API
 *
 * Since: 0.1
 */
GType gst_ellipse_search_meta_api_get_type(void) {
  // Those of the ellipses, though a time has no size: where they are lost, "nothing was found" must
  // not be what remains.
  static const gchar* kTags[] = {GST_META_TAG_VIDEO_STR,
                                 GST_META_TAG_VIDEO_SIZE_STR,
                                 GST_META_TAG_VIDEO_ORIENTATION_STR,
                                 nullptr};
  static const GType kType = gst_meta_api_type_register("GstEllipseSearchMetaAPI", kTags);
  return kType;
}

static gboolean search_meta_init(GstMeta* meta, gpointer, GstBuffer*) {
  reinterpret_cast<GstEllipseSearchMeta*>(meta)->processing_time = GST_CLOCK_TIME_NONE;
  return TRUE;
}

static gboolean search_meta_transform(
    GstBuffer* to, GstMeta* meta, GstBuffer*, GQuark type, gpointer data) {
  const bool is_whole_copy =
      GST_META_TRANSFORM_IS_COPY(type) && !static_cast<const GstMetaTransformCopy*>(data)->region;
  if (!is_whole_copy && !GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) return FALSE;
  const auto* source = reinterpret_cast<const GstEllipseSearchMeta*>(meta);
  return gst_buffer_add_ellipse_search_meta(to, source->processing_time) != nullptr;
}

/**
 * gst_ellipse_search_meta_get_info:
 *
 * What GStreamer knows of the metadata: its size, and how it is copied. Thread-safe.
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
 * @processing_time: time spent on the frame, in ns; %GST_CLOCK_TIME_NONE where it is not known
 *
 * Notes on a buffer that its frame was searched.
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
 * Tells whether the frame of a buffer was searched.
 *
 * Returns: (transfer none) (nullable): what is known of the frame's search, %NULL where it was not
 * searched or an element has lost its metadata
 *
 * Since: 0.1
 */
GstEllipseSearchMeta* gst_buffer_get_ellipse_search_meta(GstBuffer* buffer) {
  g_return_val_if_fail(GST_IS_BUFFER(buffer), nullptr);
  return reinterpret_cast<GstEllipseSearchMeta*>(
      gst_buffer_get_meta(buffer, GST_ELLIPSE_SEARCH_META_API_TYPE));
}
