// SPDX-License-Identifier: MIT
//
// Ellipses as detected objects in GStreamer's analytics metadata, as GStreamer reads and draws
// them, and the property in a build without the analytics library.
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gst/track/analytics_meta.hpp"
#include "tests/gst/tracker_harness.hpp"

#ifdef ELLIPSE_HAS_ANALYTICS
#include <gst/analytics/analytics.h>

#include "core/scene/random.hpp"
#endif

namespace {

using support::BusTap;
using support::element_of;
using support::gray_buffer_of;
using support::GrayPicture;
using support::Owned;
using support::push;
using support::ring_picture;
using support::run_pipeline;
using support::target_on;
using support::tracker;

ellipse::Target target(std::uint64_t id, ellipse::TargetState state) {
  ellipse::Target target;
  target.id = id;
  target.state = state;
  return target;
}

TEST(Sighting, EndsWithTheLastFrameWithAVisibleTarget) {
  Sighting sighting;
  sighting.add(target(1, ellipse::TargetState::kDetected), 100);
  sighting.add(target(1, ellipse::TargetState::kTracked), 200);
  sighting.add(target(1, ellipse::TargetState::kPredicted), 300);
  EXPECT_EQ(sighting.id, 1U);
  EXPECT_EQ(sighting.first, 100U);
  EXPECT_EQ(sighting.last, 200U);
  sighting.add(target(2, ellipse::TargetState::kDetected), 400);
  EXPECT_EQ(sighting.id, 2U);
  EXPECT_EQ(sighting.first, 400U);
  EXPECT_EQ(sighting.last, 400U);
}

#ifndef ELLIPSE_HAS_ANALYTICS

TEST(EllipseTrackAnalytics, WarningNamesTheRequiredVersion) {
  const auto harness = tracker();
  BusTap bus(element_of(harness));
  g_object_set(element_of(harness), "attach-analytics", TRUE, nullptr);
  const auto message = bus.pop(GST_MESSAGE_WARNING);
  ASSERT_TRUE(message);
  GError* warning = nullptr;
  gst_message_parse_warning(message.get(), &warning, nullptr);
  EXPECT_STREQ(warning->message,
               "Setting rejected: attach-analytics needs a build with GStreamer 1.24 or later and "
               "gstreamer-analytics-1.0");
  g_error_free(warning);
  EXPECT_FALSE(bus.pop(GST_MESSAGE_WARNING));
  gboolean is_on = TRUE;
  g_object_get(element_of(harness), "attach-analytics", &is_on, nullptr);
  EXPECT_FALSE(is_on);
}

TEST(EllipseTrackAnalytics, UnsupportedAnalyticsFailTheStart) {
  const std::string error =
      run_pipeline("ellipsetestsrc num-buffers=1 ! ellipsetrack attach-analytics=true ! fakesink");
  EXPECT_NE(error.find("attach-analytics needs a build with GStreamer 1.24"), std::string::npos)
      << error;
}

#else

// An object as other elements read it.
struct Object {
  guint id = 0;
  std::string type;
  ellipse::Rect upright;
  ellipse::Rect oriented;  // before its rotation
  gfloat angle_rad = 0.0F;
  gfloat confidence = 0.0F;
};

Object read(GstAnalyticsODMtd& mtd) {
  Object object;
  object.id = mtd.id;
  object.type = g_quark_to_string(gst_analytics_od_mtd_get_obj_type(&mtd));
  ellipse::Rect& upright = object.upright;
  gst_analytics_od_mtd_get_location(
      &mtd, &upright.x, &upright.y, &upright.width, &upright.height, &object.confidence);
#if GST_CHECK_VERSION(1, 26, 0)
  ellipse::Rect& box = object.oriented;
  gst_analytics_od_mtd_get_oriented_location(
      &mtd, &box.x, &box.y, &box.width, &box.height, &object.angle_rad, nullptr);
#endif
  return object;
}

std::vector<Object> objects_on(GstBuffer* buffer) {
  std::vector<Object> objects;
  GstAnalyticsRelationMeta* relations = gst_buffer_get_analytics_relation_meta(buffer);
  gpointer state = nullptr;
  GstAnalyticsODMtd mtd;
  while (relations != nullptr &&
         gst_analytics_relation_meta_iterate(
             relations, &state, gst_analytics_od_mtd_get_mtd_type(), &mtd)) {
    objects.push_back(read(mtd));
  }
  return objects;
}

// The tracking metadata related to an object.
std::optional<Sighting> track_of(GstBuffer* buffer, const Object& object) {
  GstAnalyticsTrackingMtd track;
  const gboolean has_track =
      gst_analytics_relation_meta_get_direct_related(gst_buffer_get_analytics_relation_meta(buffer),
                                                     object.id,
                                                     GST_ANALYTICS_REL_TYPE_RELATE_TO,
                                                     gst_analytics_tracking_mtd_get_mtd_type(),
                                                     nullptr,
                                                     &track);
  if (has_track == FALSE) return std::nullopt;
  Sighting sighting;
  gboolean is_lost = TRUE;
  gst_analytics_tracking_mtd_get_info(
      &track, &sighting.id, &sighting.first, &sighting.last, &is_lost);
  EXPECT_FALSE(is_lost);
  return sighting;
}

Owned<GstBuffer> frame_at(const GrayPicture& picture, GstClockTime pts) {
  auto buffer = gray_buffer_of(picture);
  GST_BUFFER_PTS(buffer.get()) = pts;
  return buffer;
}

TEST(EllipseTrackAnalytics, AreOffByDefault) {
  const auto out = push(tracker(), gray_buffer_of(ring_picture()));
  ASSERT_NE(target_on(out), nullptr);
  EXPECT_EQ(gst_buffer_get_analytics_relation_meta(out.get()), nullptr);
}

TEST(EllipseTrackAnalytics, TargetsAreTrackedObjects) {
  const auto harness = tracker("attach-analytics=true");
  push(harness, frame_at(ring_picture(), 1000));
  const auto out = push(harness, frame_at(ring_picture(), 2000));
  const GstEllipseMeta* meta = target_on(out);
  const std::vector<Object> objects = objects_on(out.get());
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].type, "ellipse");
  EXPECT_FLOAT_EQ(objects[0].confidence, static_cast<float>(meta->probability));
  const auto track = track_of(out.get(), objects[0]);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->id, meta->id);
  EXPECT_EQ(track->first, 1000U);
  EXPECT_EQ(track->last, 2000U);
}

// A drifting pad; a bar hides half of it on request.
GrayPicture drifting_pad(int frame, bool is_half_hidden) {
  ellipse::Scene scene;
  if (is_half_hidden) {
    scene.bars.push_back(support::bar_px({0.0, 120.0}, {320.0, 120.0}, 40.0, 60.0));
  }
  const ellipse::Ellipse pad{120.0 + 0.5 * frame, 110.0 + 0.2 * frame, 40.0, 32.0, 0.4};
  return support::rendered(scene, pad, 320, 240, static_cast<std::uint64_t>(frame));
}

TEST(EllipseTrackAnalytics, PredictedTargetsWereSeenBefore) {
  // With .99 or less, half a pad would be detected again: a lost target has a prior.
  const auto harness = tracker("attach-analytics=true min-probability=0.999");
  const auto pts_of = [](int frame) { return static_cast<GstClockTime>(frame) * GST_SECOND / 30; };
  int unreported = 0;  // frames before the target is reported
  for (int i = 0; i < 20; ++i) {
    const auto out = push(harness, frame_at(drifting_pad(i, false), pts_of(i)));
    unreported += target_on(out) == nullptr ? 1 : 0;
  }
  ASSERT_LT(unreported, 19);
  const auto out = push(harness, frame_at(drifting_pad(20, true), pts_of(20)));
  ASSERT_NE(target_on(out), nullptr);
  ASSERT_EQ(target_on(out)->state, GST_ELLIPSE_STATE_PREDICTED);
  const auto track = track_of(out.get(), objects_on(out.get()).at(0));
  ASSERT_TRUE(track);
  EXPECT_EQ(track->first, pts_of(unreported));
  EXPECT_EQ(track->last, pts_of(19));
}

TEST(EllipseTrackAnalytics, CandidatesAreObjectsWithoutATrack) {
  const auto harness = tracker("attach-analytics=true candidates=true");
  const auto out = push(harness, gray_buffer_of(ring_picture()));
  const std::vector<Object> objects = objects_on(out.get());
  ASSERT_EQ(objects.size(), gst_buffer_get_n_meta(out.get(), GST_ELLIPSE_META_API_TYPE));
  ASSERT_GE(objects.size(), 2U);  // the ring's inner edge
  EXPECT_TRUE(track_of(out.get(), objects[0]));
  EXPECT_FALSE(track_of(out.get(), objects[1]));
}

TEST(EllipseTrackAnalytics, AreAddedToThoseOfOtherElements) {
  const auto harness = tracker("attach-analytics=true");
  auto buffer = gray_buffer_of(ring_picture());
  GstAnalyticsODMtd face;
  gst_analytics_relation_meta_add_od_mtd(gst_buffer_add_analytics_relation_meta(buffer.get()),
                                         g_quark_from_string("face"),
                                         1,
                                         2,
                                         3,
                                         4,
                                         0.5F,
                                         &face);
  const std::vector<Object> objects = objects_on(push(harness, std::move(buffer)).get());
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].type, "face");
  EXPECT_EQ(objects[1].type, "ellipse");
}

#if GST_CHECK_VERSION(1, 26, 0)
// A point of the picture relative to a box's centre, along the box's axes.
Eigen::Vector2d in_box(const Object& object, const Eigen::Vector2d& point) {
  const ellipse::Rect& box = object.oriented;
  const Eigen::Vector2d half(0.5 * box.width, 0.5 * box.height);
  const Eigen::Vector2d centre = Eigen::Vector2d(box.x, box.y) + half;
  return Eigen::Rotation2Dd(-object.angle_rad) * (point + Eigen::Vector2d(0.5, 0.5) - centre);
}

TEST(AnalyticsObject, IsTheOrientedBoxAroundTheEllipse) {
  ellipse::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Owned<GstBuffer> buffer(gst_buffer_new());
    GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
    const double semi_major = random.between(5.0, 90.0);
    const ellipse::Ellipse e{random.between(-40.0, 600.0),
                             random.between(-40.0, 400.0),
                             semi_major,
                             semi_major * random.between(0.2, 1.0),
                             random.between(-1.57, 1.57)};
    meta->cx = e.cx;
    meta->cy = e.cy;
    meta->semi_major = e.semi_major;
    meta->semi_minor = e.semi_minor;
    meta->angle_rad = e.angle_rad;
    attach_object(buffer.get(), *meta, {0, 0, 1, 1}, {});
    const Object object = objects_on(buffer.get()).at(0);
    EXPECT_GE(object.angle_rad, 0.0F);
    EXPECT_LE(object.oriented.width, 2.0 * e.semi_major + 2.5);
    EXPECT_LE(object.oriented.height, 2.0 * e.semi_minor + 2.5);
    for (double t = 0.0; t < ellipse::kTwoPi; t += 0.1) {
      const Eigen::Vector2d point = in_box(object, e.point_at(t)).cwiseAbs();
      EXPECT_LE(point.x(), 0.5 * object.oriented.width + 1e-3) << i;
      EXPECT_LE(point.y(), 0.5 * object.oriented.height + 1e-3) << i;
    }
  }
}
#endif

// The metadata's axes are those of the ideal plane, not of the picture.
TEST(AnalyticsObject, DistortedOutlinesGiveTheirUprightBox) {
  const Owned<GstBuffer> buffer(gst_buffer_new());
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_CANDIDATE);
  meta->semi_major = 30.0;
  meta->semi_minor = 20.0;
  meta->angle_rad = 0.5;
  meta->n_outline = 64;
  attach_object(buffer.get(), *meta, {10, 20, 62, 43}, {});
  const Object object = objects_on(buffer.get()).at(0);
  EXPECT_EQ(object.upright, (ellipse::Rect{10, 20, 62, 43}));
  EXPECT_EQ(object.angle_rad, 0.0F);
}

TEST(AnalyticsObject, IsAbsentOutsideTheFrame) {
  const Owned<GstBuffer> buffer(gst_buffer_new());
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
  attach_object(buffer.get(), *meta, {0, 0, 0, 0}, {});
  EXPECT_TRUE(objects_on(buffer.get()).empty());
}

// Records the pictures and objects on a pad of an element.
class PadWatch {
 public:
  PadWatch(const Owned<GstElement>& element, const char* name) {
    GstPad* pad = gst_element_get_static_pad(element.get(), name);
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, on_buffer, this, nullptr);
    gst_object_unref(pad);
  }
  PadWatch(const PadWatch&) = delete;
  PadWatch& operator=(const PadWatch&) = delete;

  std::vector<GrayPicture> pictures;
  std::vector<std::vector<Object>> objects;

 private:
  static GstPadProbeReturn on_buffer(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    GstVideoInfo video;
    gst_video_info_from_caps(&video, caps);
    gst_caps_unref(caps);
    auto* self = static_cast<PadWatch*>(data);
    GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
    self->pictures.push_back(support::picture_of(buffer, video));
    self->objects.push_back(objects_on(buffer));
    return GST_PAD_PROBE_OK;
  }
};

// Whether a pixel is on a line of two pixels along the border of a box.
bool is_on_border(const ellipse::Rect& box, int x, int y) {
  const auto grown = [&](int by) {
    return ellipse::Rect{box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
  };
  return grown(1).contains(x, y) && !grown(-1).contains(x, y);
}

TEST(EllipseTrackAnalytics, AreDrawnByObjectDetectionOverlay) {
  support::Pipeline pipeline(
      "ellipsetestsrc num-buffers=5 ! ellipsetrack attach-analytics=true ! videoconvert ! "
      "objectdetectionoverlay name=overlay draw-labels=false "
      "object-detection-outline-color=0xff0000ff ! video/x-raw,format=RGB ! fakesink");
  if (pipeline.failure().starts_with(support::Pipeline::kNotInstalled)) {
    GTEST_SKIP() << pipeline.failure();
  }
  const auto overlay = pipeline.element("overlay");
  const PadWatch before(overlay, "sink");
  const PadWatch after(overlay, "src");
  pipeline.play();
  ASSERT_EQ(pipeline.wait_for_end(), "");
  ASSERT_EQ(after.pictures.size(), 5U);
  for (std::size_t i = 0; i < after.pictures.size(); ++i) {
    ASSERT_EQ(before.objects[i].size(), 1U) << i;
    const ellipse::Rect box = before.objects[i][0].upright;
    int wrong = 0;
    for (int y = 0; y < after.pictures[i].height; ++y) {
      for (int x = 0; x < after.pictures[i].width; ++x) {
        const bool has_changed =
            before.pictures[i].view().row(y)[x] != after.pictures[i].view().row(y)[x];
        if (has_changed != is_on_border(box, x, y)) ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0) << i;
  }
}

#endif

}  // namespace
