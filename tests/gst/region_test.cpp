// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"

#ifdef ELLIPSE_HAS_ANALYTICS
#include <gst/analytics/analytics.h>
#endif

namespace {

using support::BusTap;
using support::caps_of;
using support::element_of;
using support::gray_buffer_of;
using support::GrayPicture;
using support::Owned;
using support::plain_ring;
using support::push;
using support::rendered;
using support::ring_picture;
using support::stat;
using support::target_on;
using support::tracker;

const ellipse::Ellipse kLeft{80.0, 110.0, 40.0, 32.0, 0.3};
const ellipse::Ellipse kRight{240.0, 130.0, 36.0, 30.0, -0.4};
constexpr int kLeftHalf[] = {0, 0, 160, 240};
constexpr int kRightHalf[] = {160, 0, 160, 240};

Owned<GstBuffer> two_rings() {
  GrayPicture picture = rendered(plain_ring(), kLeft);
  const GrayPicture other = rendered(plain_ring(), kRight);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    picture.pixels[i] = std::min(picture.pixels[i], other.pixels[i]);
  }
  return gray_buffer_of(picture);
}

void add_region(const Owned<GstBuffer>& buffer, const char* type, std::array<guint, 4> box) {
  gst_buffer_add_video_region_of_interest_meta(buffer.get(), type, box[0], box[1], box[2], box[3]);
}

void expect_at(const Owned<GstBuffer>& buffer, const ellipse::Ellipse& truth) {
  const GstEllipseMeta* meta = target_on(buffer);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->cx, truth.cx, 0.2);
  EXPECT_NEAR(meta->cy, truth.cy, 0.2);
  EXPECT_NEAR(meta->semi_major, truth.semi_major, 0.3);
}

TEST(EllipseTrackRegion, IsTakenFromTheProperty) {
  const auto left = tracker("roi-source=property roi=\"<0,0,160,240>\"");
  const auto right = tracker("roi-source=property roi=\"<160,0,160,240>\"");
  for (int i = 0; i < 12; ++i) {  // the detector searches again at the ninth
    expect_at(push(left, two_rings()), kLeft);
    expect_at(push(right, two_rings()), kRight);
  }
}

TEST(EllipseTrackRegion, IsIgnoredUnlessSelected) {
  const auto harness = tracker("roi=\"<0,0,4,4>\"");
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
}

TEST(EllipseTrackRegion, LimitsTheSearchAlsoWhileTracking) {
  for (const char* tracking : {"none", "redetect", "edges"}) {
    const auto harness =
        tracker("roi-source=property roi=\"<30,60,110,100>\" tracking=" + std::string(tracking));
    for (int i = 0; i < 10; ++i) {
      const auto out = push(harness, two_rings());
      const GstEllipseMeta* meta = target_on(out);
      ASSERT_NE(meta, nullptr) << tracking << i;
      EXPECT_GE(meta->roi_x, 30) << tracking;
      EXPECT_GE(meta->roi_y, 60) << tracking;
      EXPECT_LE(meta->roi_x + static_cast<int>(meta->roi_width), 140) << tracking;
      EXPECT_LE(meta->roi_y + static_cast<int>(meta->roi_height), 160) << tracking;
    }
  }
}

TEST(EllipseTrackRegion, IsClampedToTheFrame) {
  for (const char* roi : {"<-50,-60,5000,6000>", "<-2147483648,0,2147483647,2147483647>"}) {
    const auto harness =
        tracker("roi-source=property roi=\"" + std::string(roi) + "\"", caps_of("GRAY8", 320, 240));
    const auto out = push(harness, gray_buffer_of(ring_picture()));
    EXPECT_EQ(target_on(out) != nullptr, roi[1] == '-' && roi[2] == '5') << roi;
  }
}

TEST(EllipseTrackRegion, EmptyAndOutsideRegionsSkipTheAnalysis) {
  for (const char* roi : {"<0,0,0,0>", "<320,0,10,10>", "<-20,-20,20,20>"}) {
    const auto harness = tracker("roi-source=property roi=\"" + std::string(roi) + "\"");
    BusTap bus(element_of(harness));
    for (int i = 0; i < 2; ++i) {
      const auto out = push(harness, gray_buffer_of(ring_picture()));
      EXPECT_EQ(target_on(out), nullptr) << roi;
    }
    EXPECT_EQ(stat(element_of(harness), "analysed"), 0U) << roi;
    EXPECT_EQ(stat(element_of(harness), "skipped-region"), 2U) << roi;
    EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING)) << roi;
    EXPECT_FALSE(bus.pop(GST_MESSAGE_WARNING)) << roi;
  }
}

TEST(EllipseTrackRegion, IsReadBackAsSet) {
  const auto harness = tracker("roi=\"<-1,2,30,4>\"");
  GValue value = G_VALUE_INIT;
  g_object_get_property(G_OBJECT(element_of(harness)), "roi", &value);
  gchar* text = gst_value_serialize(&value);
  EXPECT_STREQ(text, "< (int)-1, (int)2, (int)30, (int)4 >");
  g_free(text);
  g_value_unset(&value);
}

TEST(EllipseTrackRegion, RejectsMalformedBoxes) {
  const auto harness = tracker("roi=\"<1,2,3,4>\"");
  BusTap bus(element_of(harness));
  for (const char* roi : {"<1,2,3>", "<10,10,-5,20>", "<10,10,5,-20>"}) {
    gst_util_set_object_arg(G_OBJECT(element_of(harness)), "roi", roi);
    EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING)) << roi;
    GValue value = G_VALUE_INIT;
    g_object_get_property(G_OBJECT(element_of(harness)), "roi", &value);
    gchar* text = gst_value_serialize(&value);
    EXPECT_STREQ(text, "< (int)1, (int)2, (int)3, (int)4 >") << roi;
    g_free(text);
    g_value_unset(&value);
  }
}

TEST(EllipseTrackRegion, FollowsTheMetadataOfEachBuffer) {
  const auto harness = tracker("roi-source=meta");
  auto left = two_rings();
  add_region(left, "pad", {0, 0, 160, 240});
  expect_at(push(harness, std::move(left)), kLeft);
  auto right = two_rings();
  add_region(right, "pad", {160, 0, 4000000000U, 4000000000U});
  expect_at(push(harness, std::move(right)), kRight);
  EXPECT_EQ(stat(element_of(harness), "lost"), 1U);
}

TEST(EllipseTrackRegion, TargetIsReportedLostWithoutMetadata) {
  const auto harness = tracker("roi-source=meta");
  auto marked = two_rings();
  add_region(marked, "pad", {0, 0, 160, 240});
  push(harness, std::move(marked));
  BusTap bus(element_of(harness));
  auto bare = two_rings();
  GST_BUFFER_PTS(bare.get()) = 40 * GST_MSECOND;
  EXPECT_EQ(target_on(push(harness, std::move(bare))), nullptr);
  const auto lost = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(lost);
  const GstStructure* s = gst_message_get_structure(lost.get());
  EXPECT_STREQ(gst_structure_get_string(s, "state"), "lost");
  guint64 timestamp = 0;
  gst_structure_get_uint64(s, "timestamp", &timestamp);
  EXPECT_EQ(timestamp, 40 * GST_MSECOND);
  EXPECT_EQ(stat(element_of(harness), "lost"), 1U);
}

TEST(EllipseTrackRegion, IgnoresRegionsOfOtherTypes) {
  const auto harness = tracker("roi-source=meta roi-type=pad");
  auto buffer = two_rings();
  add_region(buffer, "face", {0, 0, 160, 240});
  add_region(buffer, "pad", {160, 0, 160, 240});
  expect_at(push(harness, std::move(buffer)), kRight);
}

// GLib never frees a quark; a program that sets types from external input would grow.
TEST(EllipseTrackRegion, UnusedTypesCreateNoQuark) {
  const auto harness = tracker("roi-source=meta");  // properties in a launch line become quarks
  g_object_set(element_of(harness), "roi-type", "never-seen-before", nullptr);
  auto buffer = two_rings();
  add_region(buffer, "face", {0, 0, 160, 240});
  EXPECT_EQ(target_on(push(harness, std::move(buffer))), nullptr);
  EXPECT_EQ(g_quark_try_string("never-seen-before"), 0U);
}

TEST(EllipseTrackRegion, EnclosesAllRegions) {
  const auto harness = tracker("roi-source=meta");
  auto buffer = gray_buffer_of(ring_picture());  // its bounding box: 103 to 197, 71 to 149
  add_region(buffer, "pad", {90, 60, 20, 20});
  add_region(buffer, "pad", {190, 150, 20, 10});
  const auto out = push(harness, std::move(buffer));
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_EQ(meta->roi_x, 90);
  EXPECT_EQ(meta->roi_y, 60);
  EXPECT_EQ(meta->roi_width, 120U);
  EXPECT_EQ(meta->roi_height, 100U);
}

#ifdef ELLIPSE_HAS_ANALYTICS

// Attaches objects as a detector does.
GstPadProbeReturn detect_objects(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer /*data*/) {
  GstBuffer* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
  info->data = buffer;
  GstAnalyticsRelationMeta* relations = gst_buffer_add_analytics_relation_meta(buffer);
  const auto add = [&](const char* type, const int(&box)[4]) {
    GstAnalyticsODMtd object;
    gst_analytics_relation_meta_add_od_mtd(
        relations, g_quark_from_string(type), box[0], box[1], box[2], box[3], 0.9F, &object);
  };
  add("face", kLeftHalf);
  add("pad", kRightHalf);
  return GST_PAD_PROBE_OK;
}

TEST(EllipseTrackRegion, IsTakenFromDetectedObjects) {
  const auto harness = tracker("roi-source=meta roi-type=pad");
  const auto of_any_type = tracker("roi-source=meta");
  for (GstHarness* each : {harness.get(), of_any_type.get()}) {
    gst_pad_add_probe(each->srcpad, GST_PAD_PROBE_TYPE_BUFFER, detect_objects, nullptr, nullptr);
  }
  const auto out = push(harness, two_rings());
  expect_at(out, kRight);
  EXPECT_GE(target_on(out)->roi_x, 160);
  EXPECT_EQ(target_on(push(of_any_type, two_rings()))->roi_width, 320U);
}

TEST(EllipseTrackRegion, EnclosesObjectsAndRegions) {
  const auto harness = tracker("roi-source=meta");
  auto buffer = gray_buffer_of(ring_picture());  // its bounding box: 103 to 197, 71 to 149
  add_region(buffer, "pad", {90, 60, 20, 20});
  GstAnalyticsODMtd object;
  gst_analytics_relation_meta_add_od_mtd(gst_buffer_add_analytics_relation_meta(buffer.get()),
                                         g_quark_from_string("pad"),
                                         190,
                                         150,
                                         1000,
                                         10,
                                         0.9F,
                                         &object);
  const auto out = push(harness, std::move(buffer));
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_EQ(meta->roi_x, 90);
  EXPECT_EQ(meta->roi_y, 60);
  EXPECT_EQ(meta->roi_width, 230U);
  EXPECT_EQ(meta->roi_height, 100U);
}

#endif

Owned<GstBuffer> cropped(Owned<GstBuffer> buffer, const int (&box)[4]) {
  GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(buffer.get());
  crop->x = static_cast<guint>(box[0]);
  crop->y = static_cast<guint>(box[1]);
  crop->width = static_cast<guint>(box[2]);
  crop->height = static_cast<guint>(box[3]);
  return buffer;
}

TEST(EllipseTrackRegion, CropsAreReportedInFullFramePixels) {
  const auto left = tracker();
  const auto right = tracker();
  expect_at(push(left, cropped(two_rings(), kLeftHalf)), kLeft);
  const auto out = push(right, cropped(two_rings(), kRightHalf));
  expect_at(out, kRight);
  EXPECT_EQ(target_on(out)->frame_width, 320U);
  const GstVideoCropMeta* kept = gst_buffer_get_video_crop_meta(out.get());
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->x, 160U);
}

// The caps then have the size of the crop.
TEST(EllipseTrackRegion, VideocropMayLeaveCroppingToDownstream) {
  const Owned<GstHarness> harness(
      gst_harness_new_parse("videocrop left=170 ! ellipsetrack name=t"));
  gst_harness_add_propose_allocation_meta(harness.get(), GST_VIDEO_CROP_META_API_TYPE, nullptr);
  gst_harness_add_propose_allocation_meta(harness.get(), GST_VIDEO_META_API_TYPE, nullptr);
  gst_harness_set_src_caps_str(harness.get(), caps_of("GRAY8", 320, 240).c_str());
  const auto out = push(harness, two_rings());
  ASSERT_NE(gst_buffer_get_video_crop_meta(out.get()), nullptr) << "cropped by software";
  expect_at(out, kRight);
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_EQ(meta->frame_width, 320U);
  EXPECT_EQ(meta->roi_x, 170);
  EXPECT_EQ(meta->roi_width, 150U);
  EXPECT_EQ(meta->visible_fraction, 1.0);
}

TEST(EllipseTrackRegion, RegionsOutsideTheCropFindNothing) {
  const auto harness = tracker("roi-source=property roi=\"<0,0,160,240>\"");
  EXPECT_EQ(target_on(push(harness, cropped(two_rings(), kRightHalf))), nullptr);
}

// Upstream may leave cropping to downstream elements only if all of them support it.
TEST(EllipseTrackRegion, CroppingIsOfferedIfDownstreamOffersIt) {
  for (const bool is_offered : {false, true}) {
    Owned<GstHarness> harness(gst_harness_new_parse("ellipsetrack name=t"));
    if (is_offered) {
      gst_harness_add_propose_allocation_meta(harness.get(), GST_VIDEO_CROP_META_API_TYPE, nullptr);
    }
    const std::string caps = caps_of("GRAY8", 320, 240);
    gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
    push(harness, gray_buffer_of(ring_picture()));
    GstCaps* asked = gst_caps_from_string(caps.c_str());
    GstQuery* query = gst_query_new_allocation(asked, FALSE);
    EXPECT_TRUE(gst_pad_peer_query(harness->srcpad, query));
    EXPECT_EQ(gst_query_find_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, nullptr) != FALSE,
              is_offered);
    gst_query_unref(query);
    gst_caps_unref(asked);
  }
}

}  // namespace
