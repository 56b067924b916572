/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipsetestsrc
 * @title: ellipsetestsrc
 *
 * Renders what a drone's camera sees while it comes down to a landing pad and climbs again. Each
 * buffer carries the exact ellipse of the pad's outer edge as a #GstEllipseMeta with the role
 * "truth". The same properties give the same frames on any machine.
 *
 * |[
 * gst-launch-1.0 ellipsetestsrc is-live=true ! ellipsetrack ! ellipseoverlay truth=true \
 *     ! videoconvert ! autovideosink
 * ]|
 */

#include "gst/gstellipsetestsrc.h"

#include <gst/video/video.h>

#include <cstring>
#include <optional>

#include "core/scene.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/video_view.hpp"

enum { PROP_0, PROP_SCENE, PROP_PATTERN, PROP_NOISE, PROP_SEED, PROP_IS_LIVE };

enum { SCENE_APPROACH };

static constexpr double kHorizontalFieldOfViewRad = 1.012;  // 58 degrees
static constexpr double kApproachSeconds = 10.0;
static constexpr guint8 kNeutralChroma = 128;

struct _GstEllipseTestSrc {
  GstPushSrc parent;

  // Under the object lock.
  ellipse::Scene* scene;
  gint path;

  GstVideoInfo info;
  guint64 frame;
  guint64 first_frame;      // since the frame rate was last set
  GstClockTime first_time;  // of that frame
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

static GType gst_ellipse_scene_get_type(void) {
  static const GEnumValue kValues[] = {
      {SCENE_APPROACH, "Down from 20 radii to 2.6 and up again, 10 s each", "approach"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipseScene", kValues);
  return kType;
}

static GType gst_ellipse_pattern_get_type(void) {
  static const GEnumValue kValues[] = {
      {int(ellipse::Pattern::kRingX), "A ring with an X inside", "ring-x"},
      {int(ellipse::Pattern::kRing), "A ring", "ring"},
      {int(ellipse::Pattern::kDisc), "A disc", "disc"},
      {0, nullptr, nullptr},
  };
  static const GType kType = g_enum_register_static("GstEllipsePattern", kValues);
  return kType;
}

static void gst_ellipse_test_src_set_property(GObject* object,
                                              guint id,
                                              const GValue* value,
                                              GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TEST_SRC(object);
  if (id == PROP_IS_LIVE) {
    gst_base_src_set_live(GST_BASE_SRC(self), g_value_get_boolean(value));
    return;
  }
  GST_OBJECT_LOCK(self);
  switch (id) {
    case PROP_SCENE:
      self->path = g_value_get_enum(value);
      break;
    case PROP_PATTERN:
      self->scene->pattern = static_cast<ellipse::Pattern>(g_value_get_enum(value));
      break;
    case PROP_NOISE:
      self->scene->noise = g_value_get_double(value);
      break;
    case PROP_SEED:
      self->scene->seed = g_value_get_uint(value);
      break;
    default:
      G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
  GST_OBJECT_UNLOCK(self);
}

static void gst_ellipse_test_src_get_property(GObject* object,
                                              guint id,
                                              GValue* value,
                                              GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_TEST_SRC(object);
  if (id == PROP_IS_LIVE) {
    g_value_set_boolean(value, gst_base_src_is_live(GST_BASE_SRC(self)));
    return;
  }
  GST_OBJECT_LOCK(self);
  switch (id) {
    case PROP_SCENE:
      g_value_set_enum(value, self->path);
      break;
    case PROP_PATTERN:
      g_value_set_enum(value, static_cast<gint>(self->scene->pattern));
      break;
    case PROP_NOISE:
      g_value_set_double(value, self->scene->noise);
      break;
    case PROP_SEED:
      g_value_set_uint(value, static_cast<guint>(self->scene->seed));
      break;
    default:
      G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
  }
  GST_OBJECT_UNLOCK(self);
}

static GstCaps* gst_ellipse_test_src_fixate(GstBaseSrc* base, GstCaps* caps) {
  caps = gst_caps_make_writable(gst_caps_truncate(caps));
  GstStructure* structure = gst_caps_get_structure(caps, 0);
  gst_structure_fixate_field_nearest_int(structure, "width", 640);
  gst_structure_fixate_field_nearest_int(structure, "height", 360);
  gst_structure_fixate_field_nearest_fraction(structure, "framerate", 30, 1);
  if (gst_structure_has_field(structure, "pixel-aspect-ratio")) {
    gst_structure_fixate_field_nearest_fraction(structure, "pixel-aspect-ratio", 1, 1);
  }
  return GST_BASE_SRC_CLASS(gst_ellipse_test_src_parent_class)->fixate(base, caps);
}

// Frame rate 0/1 says "one picture, or any rate": then time goes on at 30 frames a second.
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

// A live source waits for each frame's time.
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

static void attach_truth(GstEllipseTestSrc* self,
                         GstBuffer* buffer,
                         const Eigen::Matrix3d& image_from_pad) {
  const auto outer_edge = ellipse::project_circle(image_from_pad, 1.0);
  if (!outer_edge) return;
  const gint width = GST_VIDEO_INFO_WIDTH(&self->info);
  const gint height = GST_VIDEO_INFO_HEIGHT(&self->info);
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TRUTH);
  meta->cx = outer_edge->cx;
  meta->cy = outer_edge->cy;
  meta->semi_major = outer_edge->semi_major;
  meta->semi_minor = outer_edge->semi_minor;
  meta->angle_rad = outer_edge->angle_rad;
  meta->visible_fraction = ellipse::visible_fraction(*outer_edge, width, height);
  meta->frame_width = static_cast<guint>(width);
  meta->frame_height = static_cast<guint>(height);
  meta->pts = GST_BUFFER_PTS(buffer);
}

static GstFlowReturn gst_ellipse_test_src_fill(GstPushSrc* push, GstBuffer* buffer) {
  auto* self = GST_ELLIPSE_TEST_SRC(push);
  GST_OBJECT_LOCK(self);
  const ellipse::Scene scene = *self->scene;
  GST_OBJECT_UNLOCK(self);

  GST_BUFFER_PTS(buffer) = time_of(self, self->frame);
  GST_BUFFER_DURATION(buffer) = time_of(self, self->frame + 1) - GST_BUFFER_PTS(buffer);
  GST_BUFFER_OFFSET(buffer) = self->frame;
  GST_BUFFER_OFFSET_END(buffer) = self->frame + 1;

  MappedFrame mapped(self->info, buffer, GST_MAP_WRITE);
  if (!mapped.is_mapped()) {
    GST_ELEMENT_ERROR(self, RESOURCE, WRITE, ("A buffer cannot be written."), (nullptr));
    return GST_FLOW_ERROR;
  }
  GstVideoFrame& frame = mapped.frame();
  const double seconds = static_cast<double>(GST_BUFFER_PTS(buffer)) / GST_SECOND;
  const Eigen::Matrix3d view =
      ellipse::image_from_pad(ellipse::approach_pose(seconds, kApproachSeconds),
                              kHorizontalFieldOfViewRad,
                              GST_VIDEO_FRAME_WIDTH(&frame),
                              GST_VIDEO_FRAME_HEIGHT(&frame));
  ellipse::render(scene,
                  view,
                  self->frame,
                  {static_cast<std::uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)),
                   GST_VIDEO_FRAME_WIDTH(&frame),
                   GST_VIDEO_FRAME_HEIGHT(&frame),
                   GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)});
  fill_chroma(frame);
  attach_truth(self, buffer, view);
  ++self->frame;
  return GST_FLOW_OK;
}

static void gst_ellipse_test_src_finalize(GObject* object) {
  delete GST_ELLIPSE_TEST_SRC(object)->scene;
  G_OBJECT_CLASS(gst_ellipse_test_src_parent_class)->finalize(object);
}

static void gst_ellipse_test_src_init(GstEllipseTestSrc* self) {
  self->scene = new ellipse::Scene();
  gst_video_info_init(&self->info);
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void install_properties(GObjectClass* object_class) {
  const ellipse::Scene initial;
  const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
  const auto install = [&](guint id, GParamSpec* spec) {
    g_object_class_install_property(object_class, id, spec);
  };
  install(PROP_SCENE,
          g_param_spec_enum("scene",
                            "Scene",
                            "What the camera does",
                            gst_ellipse_scene_get_type(),
                            SCENE_APPROACH,
                            flags));
  install(PROP_PATTERN,
          g_param_spec_enum("pattern",
                            "Pattern",
                            "What is painted on the pad",
                            gst_ellipse_pattern_get_type(),
                            static_cast<gint>(initial.pattern),
                            flags));
  install(PROP_NOISE,
          g_param_spec_double("noise",
                              "Noise",
                              "Standard deviation of the sensor's noise, in grey levels",
                              0.0,
                              100.0,
                              initial.noise,
                              flags));
  install(PROP_SEED,
          g_param_spec_uint("seed",
                            "Seed",
                            "Of all that is random: ground and noise",
                            0,
                            G_MAXUINT32,
                            static_cast<guint>(initial.seed),
                            flags));
  install(PROP_IS_LIVE,
          g_param_spec_boolean(
              "is-live", "Is live", "Give each frame at its time, as a camera does", FALSE, flags));
}

static void gst_ellipse_test_src_class_init(GstEllipseTestSrcClass* klass) {
  auto* object_class = G_OBJECT_CLASS(klass);
  object_class->set_property = gst_ellipse_test_src_set_property;
  object_class->get_property = gst_ellipse_test_src_get_property;
  object_class->finalize = gst_ellipse_test_src_finalize;
  install_properties(object_class);

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipse test source",
                                        "Source/Video",
                                        "Renders a landing pad as a drone sees it, with the truth",
                                        "The gst-ellipse authors");
  gst_element_class_add_static_pad_template(element_class, &src_template);

  auto* base_class = GST_BASE_SRC_CLASS(klass);
  base_class->fixate = gst_ellipse_test_src_fixate;
  base_class->set_caps = gst_ellipse_test_src_set_caps;
  base_class->start = gst_ellipse_test_src_start;
  base_class->get_times = gst_ellipse_test_src_get_times;
  GST_PUSH_SRC_CLASS(klass)->fill = gst_ellipse_test_src_fill;
  gst_type_mark_as_plugin_api(gst_ellipse_scene_get_type(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(gst_ellipse_pattern_get_type(), static_cast<GstPluginAPIFlags>(0));
}
