/* SPDX-License-Identifier: MIT
 *
 * Reads the target's metadata in a pad probe, as a control application would.
 *   ./02_read_metadata
 */
#include <gst/ellipse/gstellipsemeta.h>
#include <gst/gst.h>

static GstPadProbeReturn on_buffer(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
  (void)pad;
  (void)data;
  GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
  const GstEllipseMeta* target = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  if (target != NULL) {
    g_print("%" GST_TIME_FORMAT "  target %" G_GUINT64_FORMAT " at %.1f, %.1f\n",
            GST_TIME_ARGS(GST_BUFFER_PTS(buffer)),
            target->id,
            target->cx,
            target->cy);
  }
  return GST_PAD_PROBE_OK;
}

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  GError* error = NULL;
  GstElement* pipeline = gst_parse_launch(
      "ellipsetestsrc num-buffers=30 ! ellipsetrack name=track ! fakesink", &error);
  if (error != NULL) {
    g_printerr("%s\n", error->message);
    g_clear_error(&error);
    return 1;
  }
  GstElement* track = gst_bin_get_by_name(GST_BIN(pipeline), "track");
  GstPad* pad = gst_element_get_static_pad(track, "src");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, on_buffer, NULL, NULL);
  gst_object_unref(pad);
  gst_object_unref(track);

  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* end =
      gst_bus_timed_pop_filtered(bus, GST_CLOCK_TIME_NONE, GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
  const gboolean has_failed = GST_MESSAGE_TYPE(end) == GST_MESSAGE_ERROR;
  if (has_failed) {
    gst_message_parse_error(end, &error, NULL);
    g_printerr("%s\n", error->message);
    g_clear_error(&error);
  }
  gst_message_unref(end);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return has_failed ? 1 : 0;
}
