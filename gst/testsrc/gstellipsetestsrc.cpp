/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipsetestsrc
 * @title: ellipsetestsrc
 *
 * Renders a drone's view of a landing pad: scenes from a plain approach to dusk, glare, occlusion,
 * motion blur and clutter without a pad. Each buffer carries the exact ellipse of the pad's outer
 * edge as a #GstEllipseMeta with the role "truth". The scene "wild" is random: the seed defines it,
 * and each of its ellipses has such metadata, targets first. With a distorting lens the ellipse is
 * in undistorted coordinates and the outline in distorted image coordinates, as from #ellipsetrack.
 * The same properties give the same frames on any x86-64 machine.
 *
 * |[
 * gst-launch-1.0 ellipsetestsrc is-live=true ! ellipsetrack ! ellipseoverlay truth=true \
 *     ! videoconvert ! autovideosink
 * ]|
 *
 * Since: 0.1
 */

#include "gst/testsrc/gstellipsetestsrc.h"

#include <gst/video/video.h>

#include <cstring>
#include <exception>
#include <optional>
#include <utility>

#include "core/scene/renderer.hpp"
#include "core/scene/true_ellipses.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/meta_ellipse.hpp"
#include "gst/testsrc/scene_properties.hpp"
#include "gst/track/video_view.hpp"

enum { PROP_0, PROP_FIRST_OF_SCENE, PROP_IS_LIVE = PROP_FIRST_OF_SCENE + SceneProperties::kCount };

static constexpr guint8 kNeutralChroma = 128;

struct _GstEllipseTestSrc {
  GstPushSrc parent;

  // Under the object lock.
  SceneProperties properties;
  gboolean is_changed;  // since the renderer was created

  ellipse::SceneRenderer* renderer;
  GstVideoInfo info;
  guint64 frame;
  guint64 first_frame;      // since the last change of the frame rate
  GstClockTime first_time;  // time stamp of that frame
};

G_DEFINE_TYPE(GstEllipseTestSrc, gst_ellipse_test_src, GST_TYPE_PUSH_SRC)

GST_ELEMENT_REGISTER_DEFINE(ellipsetestsrc,
                            "ellipsetestsrc",
                            GST_RANK_NONE,
                            GST_TYPE_ELLIPSE_TEST_SRC)

static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src",
    GST_PAD_SRC,
    GST_PAD_ALWAYS,
    GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("{ GRAY8, I420, YV12, NV12, NV21, Y42B, Y444 }")));

static void gst_ellipse_test_src_set_property(GObject* object,
                                              guint id,
                                              const GValue* value,
                                              GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TEST_SRC(object);
  if (id == PROP_IS_LIVE) {
    gst_base_src_set_live(GST_BASE_SRC(self), g_value_get_boolean(value));
  } else if (id >= PROP_FIRST_OF_SCENE && id < PROP_IS_LIVE) {
    GST_OBJECT_LOCK(self);
    self->properties.set(id - PROP_FIRST_OF_SCENE, value);
    self->is_changed = TRUE;
    GST_OBJECT_UNLOCK(self);
  } else {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
}

static void gst_ellipse_test_src_get_property(GObject* object,
                                              guint id,
                                              GValue* value,
                                              GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TEST_SRC(object);
  if (id == PROP_IS_LIVE) {
    g_value_set_boolean(value, gst_base_src_is_live(GST_BASE_SRC(self)));
  } else if (id >= PROP_FIRST_OF_SCENE && id < PROP_IS_LIVE) {
    GST_OBJECT_LOCK(self);
    self->properties.get(id - PROP_FIRST_OF_SCENE, value);
    GST_OBJECT_UNLOCK(self);
  } else {
    G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
}

static SceneProperties properties_of(GstEllipseTestSrc* self) {
  GST_OBJECT_LOCK(self);
  const SceneProperties properties = self->properties;
  GST_OBJECT_UNLOCK(self);
  return properties;
}

static GstCaps* gst_ellipse_test_src_fixate(GstBaseSrc* base, GstCaps* caps) {
  const SceneFormat format = properties_of(GST_ELLIPSE_TEST_SRC(base)).preferred_format();
  caps = gst_caps_make_writable(gst_caps_truncate(caps));
  GstStructure* structure = gst_caps_get_structure(caps, 0);
  gst_structure_fixate_field_nearest_int(structure, "width", format.width);
  gst_structure_fixate_field_nearest_int(structure, "height", format.height);
  gst_structure_fixate_field_nearest_fraction(structure, "framerate", format.rate_n, format.rate_d);
  if (gst_structure_has_field(structure, "pixel-aspect-ratio")) {
    gst_structure_fixate_field_nearest_fraction(structure, "pixel-aspect-ratio", 1, 1);
  }
  return GST_BASE_SRC_CLASS(gst_ellipse_test_src_parent_class)->fixate(base, caps);
}

// Frame rate 0/1 means a still picture or a variable rate: time then advances at 30 frames/s.
static GstClockTime time_of(GstEllipseTestSrc* self, guint64 frame) {
  const gint n = GST_VIDEO_INFO_FPS_N(&self->info);
  const auto per_second = static_cast<guint64>(n > 0 ? n : 30);
  const auto seconds = static_cast<guint64>(n > 0 ? GST_VIDEO_INFO_FPS_D(&self->info) : 1);
  return self->first_time +
         gst_util_uint64_scale(frame - self->first_frame, seconds * GST_SECOND, per_second);
}

static gboolean gst_ellipse_test_src_set_caps(GstBaseSrc* base, GstCaps* caps) {
  auto* self = GST_ELLIPSE_TEST_SRC(base);
  const GstClockTime now = time_of(self, self->frame);
  if (!gst_video_info_from_caps(&self->info, caps)) return FALSE;
  self->first_frame = self->frame;
  self->first_time = now;
  gst_base_src_set_blocksize(base, static_cast<guint>(GST_VIDEO_INFO_SIZE(&self->info)));
  return TRUE;
}

static gboolean gst_ellipse_test_src_start(GstBaseSrc* base) {
  auto* self = GST_ELLIPSE_TEST_SRC(base);
  self->frame = 0;
  self->first_frame = 0;
  self->first_time = 0;
  return TRUE;
}

// A live source waits for the time stamp of each frame.
static void gst_ellipse_test_src_get_times(GstBaseSrc* base,
                                           GstBuffer* buffer,
                                           GstClockTime* start,
                                           GstClockTime* end) {
  *start = GST_CLOCK_TIME_NONE;
  *end = GST_CLOCK_TIME_NONE;
  if (!gst_base_src_is_live(base)) return;
  *start = GST_BUFFER_PTS(buffer);
  *end = *start + GST_BUFFER_DURATION(buffer);
}

static void fill_chroma(GstVideoFrame& frame) {
  for (guint plane = 1; plane < GST_VIDEO_FRAME_N_PLANES(&frame); ++plane) {
    const gint height = GST_VIDEO_FRAME_COMP_HEIGHT(&frame, static_cast<gint>(plane));
    const gint stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, plane);
    std::memset(GST_VIDEO_FRAME_PLANE_DATA(&frame, plane),
                kNeutralChroma,
                static_cast<gsize>(stride) * static_cast<gsize>(height));
  }
}

static void attach_true_ellipse(GstEllipseTestSrc* self,
                                GstBuffer* buffer,
                                const ellipse::Ellipse& ellipse,
                                double visible_fraction) {
  const ellipse::Lens* lens = self->renderer->distorting_lens();
  const ellipse::LensView view = lens != nullptr ? ellipse::LensView(*lens) : ellipse::LensView();
  GstEllipseMeta* meta = attach_ellipse(buffer, GST_ELLIPSE_ROLE_TRUTH, ellipse, view, self->info);
  meta->visible_fraction = visible_fraction;
}

// The pad's outer edge; for a random scene all its ellipses, targets first.
static void attach_truth(GstEllipseTestSrc* self, GstBuffer* buffer, const ellipse::Truth& truth) {
  const ellipse::Scene& scene = self->renderer->scene();
  if (scene.sheets.empty()) {
    if (truth.outer_edge)
      attach_true_ellipse(self, buffer, *truth.outer_edge, truth.visible_fraction);
    return;
  }
  const double time_s = static_cast<double>(GST_BUFFER_PTS(buffer)) / GST_SECOND;
  const gint width = GST_VIDEO_INFO_WIDTH(&self->info);
  const gint height = GST_VIDEO_INFO_HEIGHT(&self->info);
  for (const ellipse::TrueEllipse& one : true_ellipses(scene, time_s, width, height)) {
    attach_true_ellipse(self, buffer, one.ellipse, one.visible_fraction);
  }
}

// The scene of the properties; nullopt if they have not changed.
static std::optional<ellipse::Scene> changed_scene(GstEllipseTestSrc* self) {
  GST_OBJECT_LOCK(self);
  const SceneProperties properties = self->properties;
  const bool is_changed = self->is_changed != FALSE;
  self->is_changed = FALSE;
  GST_OBJECT_UNLOCK(self);
  return is_changed ? std::optional(properties.make()) : std::nullopt;
}

static ellipse::Truth render(GstEllipseTestSrc* self, GstVideoFrame& frame, GstClockTime pts) {
  if (const auto scene = changed_scene(self)) {
    delete std::exchange(self->renderer, nullptr);
    self->renderer = new ellipse::SceneRenderer(*scene);
  }
  return self->renderer->render(static_cast<double>(pts) / GST_SECOND,
                                self->frame,
                                {static_cast<std::uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)),
                                 GST_VIDEO_FRAME_WIDTH(&frame),
                                 GST_VIDEO_FRAME_HEIGHT(&frame),
                                 GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)});
}

static GstFlowReturn gst_ellipse_test_src_fill(GstPushSrc* push, GstBuffer* buffer) {
  auto* self = GST_ELLIPSE_TEST_SRC(push);
  GST_BUFFER_PTS(buffer) = time_of(self, self->frame);
  GST_BUFFER_DURATION(buffer) = time_of(self, self->frame + 1) - GST_BUFFER_PTS(buffer);
  GST_BUFFER_OFFSET(buffer) = self->frame;
  GST_BUFFER_OFFSET_END(buffer) = self->frame + 1;

  MappedFrame mapped(self->info, buffer, GST_MAP_WRITE);
  if (!mapped.is_mapped()) {
    GST_ELEMENT_ERROR(self, RESOURCE, WRITE, ("Cannot map a buffer for writing."), (nullptr));
    return GST_FLOW_ERROR;
  }
  try {
    const ellipse::Truth truth = render(self, mapped.frame(), GST_BUFFER_PTS(buffer));
    fill_chroma(mapped.frame());
    attach_truth(self, buffer, truth);
  } catch (const std::exception& error) {
    GST_ELEMENT_ERROR(self, LIBRARY, FAILED, ("Cannot render the scene."), ("%s", error.what()));
    return GST_FLOW_ERROR;
  }
  ++self->frame;
  return GST_FLOW_OK;
}

static void gst_ellipse_test_src_finalize(GObject* object) {
  delete GST_ELLIPSE_TEST_SRC(object)->renderer;
  G_OBJECT_CLASS(gst_ellipse_test_src_parent_class)->finalize(object);
}

static void gst_ellipse_test_src_init(GstEllipseTestSrc* self) {
  self->properties = {};
  self->is_changed = TRUE;
  gst_video_info_init(&self->info);
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void gst_ellipse_test_src_class_init(GstEllipseTestSrcClass* klass) {
  auto* object_class = G_OBJECT_CLASS(klass);
  object_class->set_property = gst_ellipse_test_src_set_property;
  object_class->get_property = gst_ellipse_test_src_get_property;
  object_class->finalize = gst_ellipse_test_src_finalize;
  SceneProperties::install(object_class, PROP_FIRST_OF_SCENE);
  g_object_class_install_property(
      object_class,
      PROP_IS_LIVE,
      g_param_spec_boolean("is-live",
                           "Is live",
                           "Deliver each frame at its time stamp, as a camera does",
                           FALSE,
                           static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                    GST_PARAM_MUTABLE_READY)));

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipse test source",
                                        "Source/Video",
                                        "Renders a drone's view of a landing pad with ground truth",
                                        "The gst-ellipse authors");
  gst_element_class_add_static_pad_template(element_class, &src_template);

  auto* base_class = GST_BASE_SRC_CLASS(klass);
  base_class->fixate = gst_ellipse_test_src_fixate;
  base_class->set_caps = gst_ellipse_test_src_set_caps;
  base_class->start = gst_ellipse_test_src_start;
  base_class->get_times = gst_ellipse_test_src_get_times;
  GST_PUSH_SRC_CLASS(klass)->fill = gst_ellipse_test_src_fill;
}
