/* SPDX-License-Identifier: MIT
 *
 * Prints the ellipses of each frame from a pad probe, until the stream ends or Ctrl-C. The C
 * version of 03_probe.py.
 *   ./05_probe                            a rendered landing
 *   ./05_probe "v4l2src ! videoconvert"   a camera, or any source in gst-launch-1.0 syntax
 */
#include <glib-unix.h>
#include <gst/ellipse/gstellipsemeta.h>
#include <gst/gst.h>

static void print_ellipse(guint64 frame, const GstEllipseMeta* ellipse) {
  const gboolean is_truth = ellipse->role == GST_ELLIPSE_ROLE_TRUTH;
  g_print("frame %4" G_GUINT64_FORMAT
          "  %-9s  %-9s  centre %7.2f %7.2f  semi-axes %6.2f %6.2f  angle %6.3f\n",
          frame,
          gst_ellipse_meta_get_role_name(ellipse),
          is_truth ? "" : gst_ellipse_meta_get_state_name(ellipse),
          ellipse->cx,
          ellipse->cy,
          ellipse->semi_major,
          ellipse->semi_minor,
          ellipse->angle_rad);
}

static GstPadProbeReturn on_buffer(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
  (void)pad;
  GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
  guint64* frame = data;
  gpointer state = NULL;
  const GstEllipseMeta* ellipse = gst_buffer_iterate_ellipse_meta(buffer, &state);
  if (ellipse == NULL) g_print("frame %4" G_GUINT64_FORMAT "  nothing\n", *frame);
  for (; ellipse != NULL; ellipse = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    print_ellipse(*frame, ellipse);
  }
  ++*frame;
  return GST_PAD_PROBE_OK;
}

typedef struct {
  GMainLoop* loop;
  int status;
} Program;

static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data) {
  (void)bus;
  Program* program = data;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    GError* error = NULL;
    gst_message_parse_error(message, &error, NULL);
    gchar* path = gst_object_get_path_string(GST_MESSAGE_SRC(message));
    g_printerr("%s: %s\n", path, error->message);
    g_free(path);
    g_clear_error(&error);
    program->status = 1;
    g_main_loop_quit(program->loop);
  } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
    g_main_loop_quit(program->loop);
  }
  return G_SOURCE_CONTINUE;
}

static gboolean on_interrupt(gpointer loop) {
  g_main_loop_quit(loop);
  return G_SOURCE_CONTINUE;
}

/* Runs a pipeline until it ends. Returns the exit status. */
static int run(GstElement* pipeline) {
  Program program = {.loop = g_main_loop_new(NULL, FALSE), .status = 0};
  GstBus* bus = gst_element_get_bus(pipeline);
  const guint watch = gst_bus_add_watch(bus, on_message, &program);
  const guint interrupt = g_unix_signal_add(SIGINT, on_interrupt, program.loop);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  g_main_loop_run(program.loop);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  g_source_remove(interrupt);
  g_source_remove(watch);
  g_main_loop_unref(program.loop);
  return program.status;
}

static gboolean has_element(const gchar* name) {
  GstElementFactory* factory = gst_element_factory_find(name);
  if (factory == NULL) return FALSE;
  gst_object_unref(factory);
  return TRUE;
}

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  if (!has_element("ellipsetrack")) {
    g_printerr("no element ellipsetrack: is gst-ellipse installed, or GST_PLUGIN_PATH set?\n");
    return 1;
  }
  const gchar* source = argc > 1 ? argv[1] : "ellipsetestsrc num-buffers=60";
  gchar* description = g_strdup_printf("%s ! ellipsetrack name=track ! fakesink", source);
  GError* error = NULL;
  GstElement* pipeline = gst_parse_launch(description, &error);
  g_free(description);
  if (error != NULL) {
    g_printerr("%s\n", error->message);
    g_clear_error(&error);
    gst_clear_object(&pipeline);
    return 1;
  }
  guint64 frame = 0;
  GstElement* track = gst_bin_get_by_name(GST_BIN(pipeline), "track");
  GstPad* pad = gst_element_get_static_pad(track, "src");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, on_buffer, &frame, NULL);
  gst_object_unref(pad);
  gst_object_unref(track);
  const int status = run(pipeline);
  gst_object_unref(pipeline);
  return status;
}
