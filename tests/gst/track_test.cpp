// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>

#include "gst/meta_ellipse.hpp"
#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using support::buffer_of;
using support::BusTap;
using support::caps_of;
using support::element_of;
using support::gray_buffer_of;
using support::GrayPicture;
using support::info_of;
using support::kRing;
using support::Owned;
using support::push;
using support::ring_picture;
using support::stat;
using support::structure_property;
using support::target_on;
using support::tracker;

TEST(EllipseTrack, AttachesTheTarget) {
  const auto harness = tracker();
  const auto out = push(harness, gray_buffer_of(ring_picture()));
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->cx, kRing.cx, 0.1);
  EXPECT_NEAR(meta->cy, kRing.cy, 0.1);
  EXPECT_NEAR(meta->semi_major, kRing.semi_major, 0.2);
  EXPECT_NEAR(meta->semi_minor, kRing.semi_minor, 0.2);
  EXPECT_NEAR(meta->angle_rad, kRing.angle_rad, 0.02);
  EXPECT_EQ(meta->state, GST_ELLIPSE_STATE_DETECTED);
  EXPECT_EQ(meta->id, 1U);
  EXPECT_EQ(meta->frame_width, 320U);
  EXPECT_EQ(meta->pts, 0U);
  EXPECT_GT(meta->processing_time, 0U);
  EXPECT_NEAR(meta->visible_fraction, 1.0, 1e-9);
}

TEST(EllipseTrack, AttachesNothingToEmptyPictures) {
  const auto harness = tracker();
  const auto out = push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  EXPECT_EQ(target_on(out), nullptr);
}

TEST(EllipseTrack, AttachesCandidatesOnRequest) {
  for (const char* detector : {"contours", "arcs"}) {
    const auto harness = tracker("detector=" + std::string(detector) + " candidates=true");
    const auto out = push(harness, gray_buffer_of(ring_picture()));
    ASSERT_NE(target_on(out), nullptr) << detector;
    const GstEllipseMeta* inner =
        gst_buffer_get_ellipse_meta(out.get(), GST_ELLIPSE_ROLE_CANDIDATE);
    ASSERT_NE(inner, nullptr) << detector;
    EXPECT_NEAR(inner->semi_major, kRing.semi_major * (1.0 - 0.205), 0.5) << detector;
    EXPECT_EQ(inner->frame_width, 320U);
    const auto without = tracker("detector=" + std::string(detector));
    const auto plain = push(without, gray_buffer_of(ring_picture()));
    EXPECT_EQ(gst_buffer_get_ellipse_meta(plain.get(), GST_ELLIPSE_ROLE_CANDIDATE), nullptr);
  }
}

// With GST_DEBUG=ellipsetrack:6.
TEST(EllipseTrack, LogsALineForEachFrame) {
  GstDebugCategory* category = nullptr;
  const auto harness = tracker("interval=2");
  GST_DEBUG_CATEGORY_GET(category, "ellipsetrack");
  ASSERT_NE(category, nullptr);
  std::vector<std::string> lines;
  const GstLogFunction note = [](GstDebugCategory* of,
                                 GstDebugLevel level,
                                 const gchar*,
                                 const gchar*,
                                 gint,
                                 GObject*,
                                 GstDebugMessage* message,
                                 gpointer to) {
    const bool is_ours = g_str_equal(gst_debug_category_get_name(of), "ellipsetrack") != FALSE;
    if (!is_ours || level != GST_LEVEL_LOG) return;
    static_cast<std::vector<std::string>*>(to)->push_back(gst_debug_message_get(message));
  };
  gst_debug_add_log_function(note, &lines, nullptr);
  gst_debug_category_set_threshold(category, GST_LEVEL_LOG);
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  gst_debug_category_reset_threshold(category);
  gst_debug_remove_log_function(note);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[0].starts_with("detected 1 at ")) << lines[0];
  EXPECT_EQ(lines[1], "passes without analysis: interval");
  EXPECT_TRUE(lines[2].starts_with("nothing found, ")) << lines[2];
}

TEST(EllipseTrack, DetectorCanChangeWhilePlaying) {
  const auto harness = tracker();
  ASSERT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
  for (const char* detector : {"arcs", "contours", "arcs"}) {
    gst_util_set_object_arg(G_OBJECT(element_of(harness)), "detector", detector);
    const auto out = push(harness, gray_buffer_of(ring_picture()));
    const GstEllipseMeta* meta = target_on(out);
    ASSERT_NE(meta, nullptr) << detector;
    EXPECT_NEAR(meta->semi_major, kRing.semi_major, 0.2) << detector;
  }
}

TEST(EllipseTrack, RoiMetaSurroundsTheTarget) {
  const auto harness = tracker();
  const auto out = push(harness, gray_buffer_of(ring_picture()));
  const auto* roi = reinterpret_cast<GstVideoRegionOfInterestMeta*>(
      gst_buffer_get_meta(out.get(), GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE));
  ASSERT_NE(roi, nullptr);
  EXPECT_LE(roi->x, 103U);
  EXPECT_GE(roi->x + roi->w, 197U);
  EXPECT_LE(roi->y + roi->h, 240U);
  const auto without = tracker("attach-roi-meta=false");
  const auto bare = push(without, gray_buffer_of(ring_picture()));
  EXPECT_EQ(gst_buffer_get_meta(bare.get(), GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE), nullptr);
}

ellipse::Ellipse found_in(const std::string& format, int width) {
  const auto harness = tracker("", caps_of(format, width, 240));
  const auto out = push(harness, buffer_of(ring_picture(width, 240), info_of(format, width, 240)));
  const GstEllipseMeta* meta = target_on(out);
  return meta != nullptr ? ellipse_of(*meta) : ellipse::Ellipse{};
}

class Formats : public testing::TestWithParam<int> {};

TEST_P(Formats, PlanarFormatsGiveIdenticalEllipses) {
  const ellipse::Ellipse gray = found_in("GRAY8", GetParam());
  ASSERT_GT(gray.semi_major, 0.0);
  for (const char* format : support::kPlanarFormats) {
    EXPECT_EQ(found_in(format, GetParam()), gray) << format;
  }
}

TEST_P(Formats, PackedFormatsGiveEqualEllipsesWithinRounding) {
  const ellipse::Ellipse gray = found_in("GRAY8", GetParam());
  for (const char* format : support::kPackedFormats) {
    const ellipse::Ellipse found = found_in(format, GetParam());
    EXPECT_NEAR(found.cx, gray.cx, 0.1) << format;
    EXPECT_NEAR(found.cy, gray.cy, 0.1) << format;
    EXPECT_NEAR(found.semi_major, gray.semi_major, 0.1) << format;
    EXPECT_NEAR(found.semi_minor, gray.semi_minor, 0.1) << format;
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Formats, testing::Values(320, 321, 322));

TEST(EllipseTrack, HonoursStrideAndOffsetOfTheVideoMeta) {
  // The picture starts 37 bytes into the buffer with a row stride of 400 bytes; the padding is
  // filled with 0xa5.
  const GrayPicture picture = ring_picture(321, 240);
  constexpr gsize kOffset = 37;
  constexpr gint kStride = 400;
  Owned<GstBuffer> buffer(gst_buffer_new_allocate(nullptr, kOffset + kStride * 240, nullptr));
  gst_buffer_memset(buffer.get(), 0, 0xa5, kOffset + kStride * 240);
  for (int y = 0; y < 240; ++y) {
    gst_buffer_fill(buffer.get(),
                    kOffset + static_cast<gsize>(kStride) * static_cast<gsize>(y),
                    picture.view().row(y),
                    321);
  }
  gsize offsets[GST_VIDEO_MAX_PLANES] = {kOffset};
  gint strides[GST_VIDEO_MAX_PLANES] = {kStride};
  gst_buffer_add_video_meta_full(buffer.get(),
                                 GST_VIDEO_FRAME_FLAG_NONE,
                                 GST_VIDEO_FORMAT_GRAY8,
                                 321,
                                 240,
                                 1,
                                 offsets,
                                 strides);
  const auto harness = tracker("", caps_of("GRAY8", 321, 240));
  const auto out = push(harness, std::move(buffer));
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_EQ(meta->cx, found_in("GRAY8", 321).cx);
}

TEST(EllipseTrack, DrawsOnACopyOfSharedPixels) {
  const auto harness = tracker("overlay=ellipse");
  auto buffer = gray_buffer_of(ring_picture());
  Owned<GstBuffer> shared(gst_buffer_ref(buffer.get()));
  const auto out = push(harness, std::move(buffer));
  const auto untouched = gray_buffer_of(ring_picture());
  GstMapInfo before;
  GstMapInfo kept;
  GstMapInfo drawn;
  gst_buffer_map(untouched.get(), &before, GST_MAP_READ);
  gst_buffer_map(shared.get(), &kept, GST_MAP_READ);
  gst_buffer_map(out.get(), &drawn, GST_MAP_READ);
  EXPECT_EQ(std::memcmp(before.data, kept.data, before.size), 0);
  EXPECT_NE(std::memcmp(before.data, drawn.data, before.size), 0);
  gst_buffer_unmap(untouched.get(), &before);
  gst_buffer_unmap(shared.get(), &kept);
  gst_buffer_unmap(out.get(), &drawn);
}

TEST(EllipseTrack, AnalysesEveryNthFrame) {
  const auto harness = tracker("interval=3");
  std::string pattern;
  for (int i = 0; i < 7; ++i) {
    pattern += target_on(push(harness, gray_buffer_of(ring_picture()))) != nullptr ? 'x' : '.';
  }
  EXPECT_EQ(pattern, "x..x..x");
  EXPECT_EQ(stat(element_of(harness), "analysed"), 3U);
  EXPECT_EQ(stat(element_of(harness), "skipped"), 4U);
  EXPECT_EQ(stat(element_of(harness), "frames"), 7U);
}

TEST(EllipseTrack, LateFramesPassWithoutAnalysis) {
  const auto harness = tracker();
  push(harness, gray_buffer_of(ring_picture()));
  gst_harness_push_upstream_event(
      harness.get(),
      gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 0.5, 40 * GST_MSECOND, 20 * GST_MSECOND));
  auto late = gray_buffer_of(ring_picture());
  GST_BUFFER_PTS(late.get()) = 50 * GST_MSECOND;
  EXPECT_EQ(target_on(push(harness, std::move(late))), nullptr);
  auto on_time = gray_buffer_of(ring_picture());
  GST_BUFFER_PTS(on_time.get()) = 120 * GST_MSECOND;
  EXPECT_NE(target_on(push(harness, std::move(on_time))), nullptr);
  EXPECT_EQ(stat(element_of(harness), "skipped"), 1U);
}

TEST(EllipseTrack, PropertiesChangeWhilePlaying) {
  const auto harness = tracker();
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
  g_object_set(element_of(harness), "max-axis", 20.0, nullptr);
  EXPECT_EQ(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
  g_object_set(element_of(harness), "max-axis", 32768.0, nullptr);
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
}

TEST(EllipseTrack, RejectsInvertedPairsWithAWarning) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  BusTap bus(element);
  g_object_set(element, "max-axis", 700.0, "min-axis", 800.0, nullptr);
  double kept = 0.0;
  g_object_get(element, "min-axis", &kept, nullptr);
  EXPECT_EQ(kept, 5.0);
  const auto warning = bus.pop(GST_MESSAGE_WARNING);
  ASSERT_TRUE(warning);
  GError* error = nullptr;
  gst_message_parse_warning(warning.get(), &error, nullptr);
  EXPECT_NE(std::string(error->message).find("max-axis"), std::string::npos) << error->message;
  g_error_free(error);
}

TEST(EllipseTrack, ReportsItsOwnTargetAfterAnotherTracker) {
  const auto harness = tracker("overlay=ellipse");
  BusTap bus(element_of(harness));
  auto buffer = gray_buffer_of(ring_picture());
  gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->cx = -1.0;
  const auto out = push(harness, std::move(buffer));
  double cx = 0.0;
  const auto message = bus.pop(GST_MESSAGE_ELEMENT);
  gst_structure_get_double(gst_message_get_structure(message.get()), "cx", &cx);
  EXPECT_NEAR(cx, kRing.cx, 0.1);
  const Owned<GstStructure> target(structure_property(element_of(harness), "target"));
  gst_structure_get_double(target.get(), "cx", &cx);
  EXPECT_NEAR(cx, kRing.cx, 0.1);
}

TEST(EllipseTrack, IgnoresNaN) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  for (const char* name : {"roi-expansion", "detect-contour-overlap", "edge-high", "max-axis"}) {
    double before = 0.0;
    double after = 0.0;
    g_object_get(element, name, &before, nullptr);
    g_object_set(element, name, std::nan(""), nullptr);  // GLib warns and names the property
    g_object_get(element, name, &after, nullptr);
    EXPECT_EQ(before, after) << name;
  }
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
}

TEST(EllipseTrack, RunsWithExtremeSettings) {
  const auto harness = tracker(
      "max-scale=128 roi-expansion=10 min-contour-size=5 max-axis-ratio=100 min-axis=1 "
      "max-axis=32768 min-target-size=1 max-target-size=1 track-contour-overlap=0.0001");
  for (int i = 0; i < 20; ++i) push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(stat(element_of(harness), "frames"), 20U);
}

TEST(EllipseTrack, TakesPropertiesFromOtherThreads) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  std::atomic<bool> is_done = false;
  std::thread writer([&] {
    for (int i = 0; !is_done; ++i) {
      g_object_set(element, "max-axis", 100.0 + i % 500, "interval", 1 + i % 2, nullptr);
      g_object_set(element, "tracking", i % 2, "overlay", i % 32, "messages", i % 3, nullptr);
      for (const char* name : {"stats", "target"}) {
        const Owned<GstStructure> read(structure_property(element, name));
      }
      g_signal_emit_by_name(element, "reset");
    }
  });
  for (int i = 0; i < 60; ++i) push(harness, gray_buffer_of(ring_picture()));
  is_done = true;
  writer.join();
  EXPECT_EQ(stat(element, "frames"), 60U);
}

TEST(EllipseTrack, PostsAMessageOnChange) {
  const auto harness = tracker();
  BusTap bus(element_of(harness));
  push(harness, gray_buffer_of(ring_picture()));
  const auto detected = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(detected);
  const GstStructure* s = gst_message_get_structure(detected.get());
  EXPECT_TRUE(gst_structure_has_name(s, "ellipse"));
  EXPECT_STREQ(gst_structure_get_string(s, "state"), "detected");
  for (const char* field : {"timestamp", "stream-time", "running-time", "duration"}) {
    EXPECT_TRUE(gst_structure_has_field_typed(s, field, G_TYPE_UINT64)) << field;
  }
  EXPECT_TRUE(gst_structure_has_field_typed(s, "cx", G_TYPE_DOUBLE));
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_STREQ(gst_structure_get_string(
                   gst_message_get_structure(bus.pop(GST_MESSAGE_ELEMENT).get()), "state"),
               "tracked");
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_FALSE(bus.pop(GST_MESSAGE_ELEMENT));
  push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  const auto lost = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(lost);
  EXPECT_STREQ(gst_structure_get_string(gst_message_get_structure(lost.get()), "state"), "lost");
}

TEST(EllipseTrack, PostsMessagesInEveryFrameOrNever) {
  const auto count = [](const char* setting) {
    const auto harness = tracker(setting);
    BusTap bus(element_of(harness));
    for (int i = 0; i < 4; ++i) push(harness, gray_buffer_of(ring_picture()));
    int messages = 0;
    while (bus.pop(GST_MESSAGE_ELEMENT)) ++messages;
    return messages;
  };
  EXPECT_EQ(count("messages=every-frame"), 4);
  EXPECT_EQ(count("messages=none"), 0);
}

TEST(EllipseTrack, SignalsAcquisitionAndLoss) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  std::string heard;
  g_signal_connect(element,
                   "target-acquired",
                   G_CALLBACK(+[](GstElement*, GstStructure* target, std::string* to) {
                     *to += gst_structure_has_field(target, "cx") ? '+' : '?';
                   }),
                   &heard);
  g_signal_connect(element,
                   "target-lost",
                   G_CALLBACK(+[](GstElement*, std::string* to) { *to += '-'; }),
                   &heard);
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(heard, "+-+");
}

TEST(EllipseTrack, AnalysesSomeFramesIfOtherElementsAreLate) {
  const auto harness = tracker();
  std::string pattern;
  for (guint64 i = 0; i < 12; ++i) {
    // The sink reports each frame as a second late.
    gst_harness_push_upstream_event(
        harness.get(),
        gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 0.5, GST_SECOND, i * 33 * GST_MSECOND));
    auto buffer = gray_buffer_of(ring_picture());
    GST_BUFFER_PTS(buffer.get()) = i * 33 * GST_MSECOND;
    pattern += target_on(push(harness, std::move(buffer))) != nullptr ? 'x' : '.';
  }
  EXPECT_EQ(pattern, "....x....x..");
}

TEST(EllipseTrack, ResetReportsTheLoss) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  push(harness, gray_buffer_of(ring_picture()));
  BusTap bus(element);
  int losses = 0;
  g_signal_connect(
      element, "target-lost", G_CALLBACK(+[](GstElement*, int* count) { ++*count; }), &losses);
  g_signal_emit_by_name(element, "reset");
  push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  EXPECT_EQ(losses, 1);
  EXPECT_EQ(stat(element, "lost"), 1U);
  EXPECT_EQ(structure_property(element, "target"), nullptr);
  const auto lost = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(lost);
  EXPECT_STREQ(gst_structure_get_string(gst_message_get_structure(lost.get()), "state"), "lost");
  EXPECT_FALSE(bus.pop(GST_MESSAGE_ELEMENT));
}

TEST(EllipseTrack, AcceptsSegmentsInBytes) {
  const auto harness = tracker("messages=every-frame");
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_BYTES);
  gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
}

TEST(EllipseTrack, ReportsNoAxisBeyondItsLimit) {
  for (const char* detector : {"contours", "arcs"}) {
    const auto harness = tracker("tracking=redetect detector=" + std::string(detector));
    for (double limit = 99.9; limit < 100.1; limit += 0.005) {  // the ring is 100 px across
      g_object_set(element_of(harness), "max-axis", limit, nullptr);
      const auto out = push(harness, gray_buffer_of(ring_picture()));
      const GstEllipseMeta* meta = target_on(out);
      EXPECT_LE(meta != nullptr ? 2.0 * meta->semi_major : 0.0, limit) << detector;
    }
  }
}

TEST(EllipseTrack, LoweringMaxScaleTakesEffectInTheNextFrame) {
  const auto harness = tracker("tracking=redetect max-target-size=40 min-target-size=10");
  for (int i = 0; i < 4; ++i) push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(target_on(push(harness, gray_buffer_of(ring_picture())))->scale, 4U);
  g_object_set(element_of(harness), "max-scale", 2, nullptr);
  EXPECT_EQ(target_on(push(harness, gray_buffer_of(ring_picture())))->scale, 2U);
}

TEST(EllipseTrack, ResetSignalStartsANewTarget) {
  const auto harness = tracker();
  push(harness, gray_buffer_of(ring_picture()));
  g_signal_emit_by_name(element_of(harness), "reset");
  const auto out = push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(target_on(out)->state, GST_ELLIPSE_STATE_DETECTED);
  EXPECT_EQ(target_on(out)->id, 2U);
}

TEST(EllipseTrack, TargetAndStatsAreReadable) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  EXPECT_EQ(structure_property(element, "target"), nullptr);
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(ring_picture()));
  const Owned<GstStructure> target(structure_property(element, "target"));
  ASSERT_TRUE(target);
  EXPECT_STREQ(gst_structure_get_string(target.get(), "state"), "tracked");
  EXPECT_EQ(stat(element, "detected"), 1U);
  EXPECT_EQ(stat(element, "tracked"), 1U);
  EXPECT_GT(stat(element, "processing-time-median"), 0U);
  EXPECT_GE(stat(element, "processing-time-p99"), stat(element, "processing-time-median"));
  push(harness, gray_buffer_of(GrayPicture(320, 240, 90)));
  EXPECT_EQ(structure_property(element, "target"), nullptr);
  EXPECT_EQ(stat(element, "lost"), 1U);
}

TEST(EllipseTrack, AcceptsNewCapsAtEachBuffer) {
  const auto harness = tracker();
  for (const char* format : {"I420", "BGR", "GRAY8", "YUY2"}) {
    for (const int width : {320, 91, 322}) {
      const std::string caps = caps_of(format, width, 240);
      gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
      const auto out =
          push(harness, buffer_of(ring_picture(width, 240), info_of(format, width, 240)));
      ASSERT_TRUE(out);
      EXPECT_EQ(target_on(out) != nullptr, width > 91) << format << width;
    }
  }
}

TEST(EllipseTrack, UnsupportedCapsFailNegotiation) {
  for (const char* format : {"RGB16", "v210", "AYUV64", "P010_10BE"}) {
    const std::string error = support::run_pipeline(
        "videotestsrc num-buffers=1 ! video/x-raw,format=" + std::string(format) +
        " ! ellipsetrack ! fakesink");
    EXPECT_FALSE(error.empty()) << format;
  }
}

TEST(EllipseTrack, TakesFramesOfAnySize) {
  for (const int width : {1, 2, 3, 7, 33}) {
    for (const int height : {1, 2, 5, 34}) {
      for (const char* format : {"GRAY8", "I420", "YUY2", "BGR"}) {
        const auto harness = tracker("overlay=ellipse+label", caps_of(format, width, height));
        const auto out = push(
            harness, buffer_of(GrayPicture(width, height, 200), info_of(format, width, height)));
        EXPECT_TRUE(out) << width << 'x' << height << format;
      }
    }
  }
}

TEST(EllipseTrack, PassesTooSmallBuffersWithAWarning) {
  const auto harness = tracker();
  BusTap bus(element_of(harness));
  Owned<GstBuffer> small(gst_buffer_new_allocate(nullptr, 100, nullptr));
  EXPECT_TRUE(push(harness, std::move(small)));
  EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING));
  EXPECT_NE(target_on(push(harness, gray_buffer_of(ring_picture()))), nullptr);
}

TEST(EllipseTrack, FlushResetsTheTracker) {
  const auto harness = tracker();
  push(harness, gray_buffer_of(ring_picture()));
  gst_harness_push_event(harness.get(), gst_event_new_flush_start());
  gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
  const auto out = push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(target_on(out)->state, GST_ELLIPSE_STATE_DETECTED);
}

TEST(EllipseTrack, AcceptsBuffersWithoutTimestamps) {
  const auto harness = tracker("messages=every-frame");
  auto buffer = gray_buffer_of(ring_picture());
  GST_BUFFER_PTS(buffer.get()) = GST_CLOCK_TIME_NONE;
  GST_BUFFER_DURATION(buffer.get()) = GST_CLOCK_TIME_NONE;
  const auto out = push(harness, std::move(buffer));
  ASSERT_NE(target_on(out), nullptr);
  EXPECT_EQ(target_on(out)->pts, GST_CLOCK_TIME_NONE);
}

TEST(EllipseTrack, OffersVideoMetaUpstream) {
  const auto harness = tracker();
  GstCaps* caps = gst_caps_from_string(caps_of("GRAY8", 320, 240).c_str());
  GstQuery* query = gst_query_new_allocation(caps, FALSE);
  GstPad* sink = gst_element_get_static_pad(element_of(harness), "sink");
  EXPECT_TRUE(gst_pad_query(sink, query));
  EXPECT_TRUE(gst_query_find_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr));
  gst_object_unref(sink);
  gst_query_unref(query);
  gst_caps_unref(caps);
}

}  // namespace
