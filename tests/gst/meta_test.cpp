// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/geometry/ellipse.hpp"
#include "gst/ellipse/gstellipsesearchmeta.h"
#include "tests/gst/support.hpp"

namespace {

using support::Owned;

GstEllipseMeta* add_example(GstBuffer* buffer) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->state = GST_ELLIPSE_STATE_TRACKED;
  meta->id = 7;
  meta->cx = 99.5;
  meta->cy = 49.5;
  meta->semi_major = 40.0;
  meta->semi_minor = 20.0;
  meta->angle_rad = 0.7;
  meta->roi_x = 11;
  meta->roi_y = 20;
  meta->roi_width = 101;
  meta->roi_height = 60;
  meta->frame_width = 320;
  meta->frame_height = 240;
  meta->pts = 123;
  return meta;
}

Owned<GstBuffer> empty_buffer() {
  return Owned<GstBuffer>(gst_buffer_new_allocate(nullptr, 16, nullptr));
}

// Transforms the metadata as a scaler does, to this size and pixel aspect ratio.
GstEllipseMeta* scaled_to(
    GstBuffer* from, GstBuffer* to, int width, int height, int par_n = 1, int par_d = 1) {
  GstVideoInfo in = support::info_of("GRAY8", 320, 240);
  GstVideoInfo out = support::info_of("GRAY8", width, height);
  out.par_n = par_n;
  out.par_d = par_d;
  GstVideoMetaTransform transform = {&in, &out};
  GstMeta* meta = gst_buffer_get_meta(from, GST_ELLIPSE_META_API_TYPE);
  meta->info->transform_func(
      to, meta, from, gst_video_meta_transform_scale_get_quark(), &transform);
  return gst_buffer_get_ellipse_meta(to, GST_ELLIPSE_ROLE_TARGET);
}

TEST(EllipseMeta, StartsEmpty) {
  const auto buffer = empty_buffer();
  const GstEllipseMeta* meta =
      gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_CANDIDATE);
  EXPECT_EQ(meta->role, GST_ELLIPSE_ROLE_CANDIDATE);
  EXPECT_EQ(meta->scale, 1U);
  EXPECT_EQ(meta->cx, 0.0);
  EXPECT_EQ(meta->pts, GST_CLOCK_TIME_NONE);
}

TEST(EllipseMeta, SeveralRolesFitOnOneBuffer) {
  const auto buffer = empty_buffer();
  gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH)->cx = 1.0;
  gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->cx = 2.0;
  EXPECT_EQ(gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->cx, 2.0);
  EXPECT_EQ(gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_CANDIDATE), nullptr);
  gpointer state = nullptr;
  int count = 0;
  while (gst_buffer_iterate_ellipse_meta(buffer.get(), &state) != nullptr) ++count;
  EXPECT_EQ(count, 2);
}

TEST(EllipseMeta, AreListedInInsertionOrder) {
  const auto buffer = empty_buffer();
  EXPECT_EQ(gst_buffer_list_ellipse_meta(buffer.get()), nullptr);
  GstEllipseMeta* first = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH);
  gst_buffer_add_video_region_of_interest_meta(buffer.get(), "other", 0, 0, 1, 1);
  GstEllipseMeta* second = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
  GList* list = gst_buffer_list_ellipse_meta(buffer.get());
  ASSERT_EQ(g_list_length(list), 2U);
  EXPECT_EQ(list->data, first);
  EXPECT_EQ(list->next->data, second);
  g_list_free(list);
}

TEST(EllipseMeta, IsCopiedWithTheBuffer) {
  const auto buffer = empty_buffer();
  add_example(buffer.get());
  const Owned<GstBuffer> copy(gst_buffer_copy(buffer.get()));
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(copy.get(), GST_ELLIPSE_ROLE_TARGET);
  ASSERT_NE(meta, nullptr);
  EXPECT_EQ(meta->id, 7U);
  EXPECT_EQ(meta->angle_rad, 0.7);
  EXPECT_EQ(meta->pts, 123U);
}

TEST(EllipseMeta, IsNotCopiedWithPartialBuffers) {
  const auto buffer = empty_buffer();
  add_example(buffer.get());
  const Owned<GstBuffer> part(gst_buffer_copy_region(
      buffer.get(), static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_ALL), 0, 8));
  EXPECT_EQ(gst_buffer_get_ellipse_meta(part.get(), GST_ELLIPSE_ROLE_TARGET), nullptr);
}

TEST(EllipseMeta, FollowsAScaler) {
  const auto from = empty_buffer();
  const auto to = empty_buffer();
  add_example(from.get());
  const GstEllipseMeta* meta = scaled_to(from.get(), to.get(), 640, 480);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->cx, 199.5, 1e-9);  // (99.5 + 0.5) 2 - 0.5
  EXPECT_NEAR(meta->cy, 99.5, 1e-9);
  EXPECT_NEAR(meta->semi_major, 80.0, 1e-9);
  EXPECT_NEAR(meta->angle_rad, 0.7, 1e-9);
  EXPECT_EQ(meta->roi_x, 22);
  EXPECT_EQ(meta->roi_width, 202U);
  EXPECT_EQ(meta->frame_width, 640U);
  EXPECT_EQ(meta->id, 7U);
}

TEST(EllipseMeta, CovarianceFollowsAScaler) {
  const auto from = empty_buffer();
  GstEllipseMeta* before = add_example(from.get());
  before->sigma_px = 0.3;
  gdouble* to = before->covariance;
  for (int i = 0; i < 5; ++i) {
    for (int k = i; k < 5; ++k) *to++ = i == k ? 0.09 : 0.01;
  }
  const auto doubled = empty_buffer();
  const GstEllipseMeta* meta = scaled_to(from.get(), doubled.get(), 640, 480);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->covariance[0], 0.36, 1e-6);
  EXPECT_NEAR(meta->covariance[1], 0.04, 1e-6);
  EXPECT_NEAR(meta->covariance[4], 0.02, 1e-6);   // of cx and the angle
  EXPECT_NEAR(meta->covariance[14], 0.09, 1e-6);  // of the angle
  EXPECT_NEAR(meta->sigma_px, 2.0 * std::sqrt(0.1), 1e-6);
  // Twice as wide: only the centre's error along x doubles.
  const auto wide = empty_buffer();
  const GstEllipseMeta* stretched = scaled_to(from.get(), wide.get(), 640, 240, 1, 2);
  ASSERT_NE(stretched, nullptr);
  EXPECT_NEAR(stretched->covariance[0], 0.36, 1e-6);
  EXPECT_NEAR(stretched->covariance[5], 0.09, 1e-6);
}

TEST(EllipseMeta, RotatesUnderANonUniformScale) {
  const auto from = empty_buffer();
  const auto to = empty_buffer();
  const GstEllipseMeta* before = add_example(from.get());
  const GstEllipseMeta* after = scaled_to(from.get(), to.get(), 640, 120, 1, 4);
  ASSERT_NE(after, nullptr);
  const ellipse::Ellipse a{before->cx, before->cy, 40.0, 20.0, 0.7};
  const ellipse::Ellipse b{
      after->cx, after->cy, after->semi_major, after->semi_minor, after->angle_rad};
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d p = a.point_at(0.5 * i);
    const Eigen::Vector2d q((p.x() + 0.5) * 2.0 - 0.5, (p.y() + 0.5) * 0.5 - 0.5);
    EXPECT_NEAR(ellipse::sampson_distance(b, q), 0.0, 1e-9);
  }
}

TEST(EllipseMeta, KeepsItsShapeWithBorders) {
  const auto from = empty_buffer();
  const auto wide = empty_buffer();
  const auto high = empty_buffer();
  add_example(from.get());
  const GstEllipseMeta* beside = scaled_to(from.get(), wide.get(), 161, 60);  // 80 x 60 at x = 40
  ASSERT_NE(beside, nullptr);
  EXPECT_NEAR(beside->cx, 40.0 + 100.0 / 4.0 - 0.5, 1e-9);
  EXPECT_NEAR(beside->cy, 50.0 / 4.0 - 0.5, 1e-9);
  EXPECT_NEAR(beside->semi_major, 10.0, 1e-9);
  EXPECT_NEAR(beside->angle_rad, 0.7, 1e-9);
  EXPECT_EQ(beside->roi_x, 40 + 2);
  EXPECT_EQ(beside->frame_width, 161U);
  const GstEllipseMeta* below = scaled_to(from.get(), high.get(), 320, 305);  // at y = 32
  ASSERT_NE(below, nullptr);
  EXPECT_NEAR(below->cx, 99.5, 1e-9);
  EXPECT_NEAR(below->cy, 32.0 + 49.5, 1e-9);
  EXPECT_EQ(below->roi_y, 32 + 20);
  EXPECT_EQ(below->roi_height, 60U);
}

TEST(EllipseMeta, IsRemovedIfBordersLeaveNothingOfThePicture) {
  const auto from = empty_buffer();
  const auto to = empty_buffer();
  add_example(from.get());
  EXPECT_EQ(scaled_to(from.get(), to.get(), 640, 480, 1, 1000), nullptr);
  EXPECT_EQ(scaled_to(from.get(), to.get(), 640, 480, 1000, 1), nullptr);
}

TEST(EllipseMeta, FillsTheFrameIfTheShapeIsUnknown) {
  const auto from = empty_buffer();
  const auto to = empty_buffer();
  add_example(from.get());
  const GstEllipseMeta* meta = scaled_to(from.get(), to.get(), 640, 480, 1, G_MAXINT);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->cx, 199.5, 1e-9);
}

TEST(EllipseMeta, StructureHasAllFields) {
  const auto buffer = empty_buffer();
  const Owned<GstStructure> s(gst_ellipse_meta_to_structure(add_example(buffer.get())));
  double cx = 0.0;
  guint64 id = 0;
  EXPECT_STREQ(gst_structure_get_name(s.get()), "ellipse");
  EXPECT_TRUE(gst_structure_get_double(s.get(), "cx", &cx));
  EXPECT_TRUE(gst_structure_get_uint64(s.get(), "id", &id));
  EXPECT_EQ(cx, 99.5);
  EXPECT_EQ(id, 7U);
  EXPECT_STREQ(gst_structure_get_string(s.get(), "state"), "tracked");
  EXPECT_STREQ(gst_structure_get_string(s.get(), "role"), "target");
}

TEST(EllipseMeta, JsonIsOneValidObjectWithoutNaN) {
  const auto buffer = empty_buffer();
  GstEllipseMeta* meta = add_example(buffer.get());
  meta->contour_overlap = std::numeric_limits<double>::quiet_NaN();
  gchar* text = gst_ellipse_meta_to_json(meta);
  const Owned<JsonParser> parser(json_parser_new());
  ASSERT_TRUE(json_parser_load_from_data(parser.get(), text, -1, nullptr)) << text;
  JsonObject* object = json_node_get_object(json_parser_get_root(parser.get()));
  EXPECT_DOUBLE_EQ(json_object_get_double_member(object, "cx"), 99.5);
  EXPECT_STREQ(json_object_get_string_member(object, "state"), "tracked");
  EXPECT_TRUE(json_object_get_null_member(object, "contour_overlap"));
  EXPECT_EQ(json_array_get_int_element(json_object_get_array_member(object, "roi"), 2), 101);
  EXPECT_EQ(std::strchr(text, '\n'), nullptr);
  g_free(text);
}

TEST(EllipseMeta, JsonOfAFrameListsAllOfItsEllipses) {
  const auto buffer = empty_buffer();
  add_example(buffer.get());
  gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_CANDIDATE);
  gst_buffer_add_ellipse_search_meta(buffer.get(), 250)->tracker_state =
      GST_ELLIPSE_TRACKER_STATE_COASTING;
  gchar* text = gst_buffer_ellipses_to_json(buffer.get(), 17, 320, 240);
  const Owned<JsonParser> parser(json_parser_new());
  ASSERT_TRUE(json_parser_load_from_data(parser.get(), text, -1, nullptr)) << text;
  JsonObject* object = json_node_get_object(json_parser_get_root(parser.get()));
  EXPECT_EQ(json_object_get_int_member(object, "frame"), 17);
  EXPECT_EQ(json_object_get_int_member(object, "processing_ns"), 250);
  EXPECT_STREQ(json_object_get_string_member(object, "tracker"), "coasting");
  EXPECT_TRUE(json_object_get_null_member(object, "pts_ns"));
  EXPECT_EQ(json_array_get_length(json_object_get_array_member(object, "targets")), 2U);
  g_free(text);
}

TEST(EllipseSearchMeta, IsCopiedAsTheEllipsesAre) {
  const auto buffer = empty_buffer();
  EXPECT_EQ(gst_buffer_get_ellipse_search_meta(buffer.get()), nullptr);
  gst_buffer_add_ellipse_search_meta(buffer.get(), 250)->tracker_state =
      GST_ELLIPSE_TRACKER_STATE_CONFIRMING;
  const Owned<GstBuffer> copy(gst_buffer_copy(buffer.get()));
  const Owned<GstBuffer> part(gst_buffer_copy_region(
      buffer.get(), static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_ALL), 0, 8));
  ASSERT_NE(gst_buffer_get_ellipse_search_meta(copy.get()), nullptr);
  EXPECT_EQ(gst_buffer_get_ellipse_search_meta(copy.get())->processing_time, 250U);
  EXPECT_EQ(gst_buffer_get_ellipse_search_meta(copy.get())->tracker_state,
            GST_ELLIPSE_TRACKER_STATE_CONFIRMING);
  EXPECT_EQ(gst_buffer_get_ellipse_search_meta(part.get()), nullptr);
  for (guint i = 0; gst_meta_api_type_get_tags(GST_ELLIPSE_META_API_TYPE)[i] != nullptr; ++i) {
    const gchar* tag = gst_meta_api_type_get_tags(GST_ELLIPSE_META_API_TYPE)[i];
    EXPECT_TRUE(
        gst_meta_api_type_has_tag(GST_ELLIPSE_SEARCH_META_API_TYPE, g_quark_from_string(tag)))
        << tag;
  }
}

TEST(EllipseSearchMeta, NamesTheStateOfTheTracker) {
  const auto buffer = empty_buffer();
  GstEllipseSearchMeta* meta = gst_buffer_add_ellipse_search_meta(buffer.get(), 250);
  const auto name_of = [&](int state) {
    std::memcpy(&meta->tracker_state, &state, sizeof state);
    return std::string(gst_ellipse_search_meta_get_tracker_state_name(meta));
  };
  EXPECT_EQ(meta->tracker_state, GST_ELLIPSE_TRACKER_STATE_UNKNOWN);
  EXPECT_EQ(name_of(GST_ELLIPSE_TRACKER_STATE_SEARCHING), "searching");
  EXPECT_EQ(name_of(GST_ELLIPSE_TRACKER_STATE_FOLLOWING), "following");
  EXPECT_EQ(name_of(GST_ELLIPSE_TRACKER_STATE_UNKNOWN), "unknown");
  EXPECT_EQ(name_of(77), "unknown");
}

TEST(EllipseMeta, NamesRoleAndState) {
  const auto buffer = empty_buffer();
  GstEllipseMeta* meta = add_example(buffer.get());
  EXPECT_STREQ(gst_ellipse_meta_get_role_name(meta), "target");
  EXPECT_STREQ(gst_ellipse_meta_get_state_name(meta), "tracked");
  const gint foreign = 7;
  std::memcpy(&meta->state, &foreign, sizeof foreign);
  EXPECT_STREQ(gst_ellipse_meta_get_state_name(meta), "unknown");
}

TEST(EllipseMeta, TypesAreNamed) {
  EXPECT_STREQ(g_type_name(GST_TYPE_ELLIPSE_ROLE), "GstEllipseRole");
  EXPECT_STREQ(g_type_name(GST_TYPE_ELLIPSE_STATE), "GstEllipseState");
  EXPECT_TRUE(gst_meta_api_type_has_tag(GST_ELLIPSE_META_API_TYPE,
                                        g_quark_from_static_string(GST_META_TAG_VIDEO_SIZE_STR)));
}

}  // namespace
