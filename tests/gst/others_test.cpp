// SPDX-License-Identifier: MIT
//
// ellipseoverlay, ellipsejson and ellipsetestsrc.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/ellipse.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::buffer_of;
using support::caps_of;
using support::info_of;
using support::object_of;
using support::Owned;
using support::Picture;

Owned<GstHarness> harness_of(const std::string& element,
                             const std::string& in,
                             const std::string& out) {
  Owned<GstHarness> harness(gst_harness_new_parse(element.c_str()));
  gst_harness_set_caps_str(harness.get(), in.c_str(), out.c_str());
  return harness;
}

void add_circle(GstBuffer* buffer, double cx, double cy, double radius) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->id = 1;
  meta->cx = cx;
  meta->cy = cy;
  meta->semi_major = radius;
  meta->semi_minor = radius;
  meta->roi_width = 10;
  meta->roi_height = 10;
}

// The luma (or red) plane after an overlay has drawn on an even picture.
Picture drawn(const std::string& format, int width, int height, const std::string& settings) {
  const std::string caps = caps_of(format, width, height);
  const auto harness = harness_of("ellipseoverlay " + settings, caps, caps);
  auto buffer = buffer_of(Picture(width, height, 128), info_of(format, width, height));
  add_circle(buffer.get(), width / 2.0, height / 2.0, 30.0);
  const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
  return support::picture_of(out.get(), info_of(format, width, height));
}

TEST(EllipseOverlay, DrawsOnTheEllipseAndNowhereElse) {
  for (const char* format : {"GRAY8", "I420", "NV12", "YUY2", "BGR", "ARGB", "Y41B"}) {
    const Picture picture = drawn(format, 161, 121, "overlay=ellipse overlay-color=0xffffffff");
    const ellipse::Ellipse circle{80.5, 60.5, 30.0, 30.0, 0.0};
    int on_line = 0;
    for (int y = 0; y < 121; ++y) {
      for (int x = 0; x < 161; ++x) {
        const double d = std::abs(ellipse::sampson_distance(circle, {x, y}));
        const int level = picture.view().row(y)[x];
        if (d < 0.5) {
          EXPECT_GT(level, 220) << format << ' ' << x << ' ' << y;
          ++on_line;
        } else if (d > 2.0) {
          EXPECT_EQ(level, 128) << format << ' ' << x << ' ' << y;
        }
      }
    }
    EXPECT_GT(on_line, 150) << format;
  }
}

TEST(EllipseOverlay, DrawsAllPartsInTheSmallestFrames) {
  for (const int size : {1, 2, 3, 16}) {
    const Picture picture = drawn("I420", size, size, "overlay=ellipse+axes+centre+roi+label");
    EXPECT_EQ(picture.width, size);
  }
}

TEST(EllipseOverlay, SurvivesStatesThatItDoesNotKnow) {
  const std::string caps = caps_of("GRAY8", 64, 64);
  const auto harness = harness_of("ellipseoverlay overlay=label", caps, caps);
  auto buffer = buffer_of(Picture(64, 64, 50), info_of("GRAY8", 64, 64));
  add_circle(buffer.get(), 32.0, 32.0, 10.0);
  const gint foreign = 7;
  std::memcpy(&gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->state,
              &foreign,
              sizeof foreign);
  const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
  EXPECT_TRUE(out);
}

TEST(EllipseOverlay, TransparentColourDrawsNothing) {
  const Picture picture = drawn("GRAY8", 100, 100, "overlay=ellipse overlay-color=0x00ffffff");
  for (const auto level : picture.pixels) EXPECT_EQ(level, 128);
}

TEST(EllipseOverlay, LeavesBuffersWithoutEllipseAlone) {
  const std::string caps = caps_of("GRAY8", 64, 64);
  const auto harness = harness_of("ellipseoverlay", caps, caps);
  auto buffer = buffer_of(Picture(64, 64, 50), info_of("GRAY8", 64, 64));
  GstBuffer* same = gst_buffer_ref(buffer.get());
  GstMemory* memory = gst_buffer_peek_memory(same, 0);
  const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
  EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), memory);
  gst_buffer_unref(same);
}

TEST(EllipseOverlay, SurvivesAbsurdEllipses) {
  const std::string caps = caps_of("GRAY8", 64, 64);
  const auto harness =
      harness_of("ellipseoverlay overlay=ellipse+axes+centre+roi+label", caps, caps);
  for (const double value : {std::nan(""), 1e300, -1e300, 0.0, 1e-300}) {
    auto buffer = buffer_of(Picture(64, 64, 50), info_of("GRAY8", 64, 64));
    add_circle(buffer.get(), value, 32.0, 10.0);
    add_circle(buffer.get(), 32.0, 32.0, value);
    const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
    EXPECT_TRUE(out);
  }
}

TEST(EllipseJson, WritesALineAFrame) {
  const auto harness = harness_of("ellipsejson", caps_of("GRAY8", 64, 48), "application/x-ndjson");
  std::string text;
  for (int i = 0; i < 2; ++i) {
    auto buffer = buffer_of(Picture(64, 48, 50), info_of("GRAY8", 64, 48));
    if (i == 1) add_circle(buffer.get(), 32.25, 24.5, 10.0);
    GST_BUFFER_PTS(buffer.get()) = static_cast<guint64>(i) * 40 * GST_MSECOND;
    const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
    EXPECT_EQ(GST_BUFFER_PTS(out.get()), static_cast<guint64>(i) * 40 * GST_MSECOND);
    text += support::bytes_of(out.get());
  }
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "{\"frame\":0,\"pts_ns\":0,\"width\":64,\"height\":48,\"processing_ns\":null,"
            "\"targets\":[]}");
  EXPECT_NE(text.find("{\"frame\":1,\"pts_ns\":40000000,"), std::string::npos);
  EXPECT_NE(text.find("\"cx\":32.2500,\"cy\":24.5000,\"semi_major\":10.0000"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
}

TEST(EllipseJson, TellsAFruitlessSearchFromNone) {
  const support::TemporaryFolder folder;
  ASSERT_EQ(support::run_pipeline("ellipsetestsrc scene=negative ground=plain num-buffers=4 ! "
                                  "ellipsetrack interval=2 ! ellipsejson ! filesink location=" +
                                  folder.file("lines")),
            "");
  const auto lines = support::read_ndjson(folder.file("lines"));
  ASSERT_EQ(lines.size(), 4U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    JsonObject* line = object_of(lines[i]);
    EXPECT_EQ(json_array_get_length(json_object_get_array_member(line, "targets")), 0U) << i;
    EXPECT_EQ(json_object_get_null_member(line, "processing_ns"), i % 2 == 1) << i;
  }
}

TEST(EllipseJson, TakesAnyRawVideo) {
  for (const char* format : {"v210", "GRAY16_LE", "P010_10LE"}) {
    EXPECT_EQ(support::run_pipeline("videotestsrc num-buffers=2 ! video/x-raw,format=" +
                                    std::string(format) + " ! ellipsejson ! fakesink"),
              "")
        << format;
  }
}

Owned<GstBuffer> first_frame(const std::string& settings, const std::string& caps) {
  Owned<GstHarness> harness(gst_harness_new_parse(("ellipsetestsrc " + settings).c_str()));
  gst_harness_set_sink_caps_str(harness.get(), caps.c_str());
  gst_harness_play(harness.get());
  return Owned<GstBuffer>(gst_harness_pull(harness.get()));
}

std::string bytes_of(const Owned<GstBuffer>& buffer) {
  return support::bytes_of(buffer.get());
}

TEST(EllipseTestSrc, CarriesTheTruth) {
  const auto buffer = first_frame("num-buffers=1", caps_of("GRAY8", 320, 180));
  const GstEllipseMeta* truth = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH);
  ASSERT_NE(truth, nullptr);
  EXPECT_GT(truth->semi_minor, 5.0);
  EXPECT_GE(truth->semi_major, truth->semi_minor);
  EXPECT_EQ(truth->visible_fraction, 1.0);
}

TEST(EllipseTestSrc, IsTheSameEachTimeAndInEachFormat) {
  const std::string gray = bytes_of(first_frame("seed=5", caps_of("GRAY8", 160, 90)));
  EXPECT_EQ(gray, bytes_of(first_frame("seed=5", caps_of("GRAY8", 160, 90))));
  EXPECT_NE(gray, bytes_of(first_frame("seed=6", caps_of("GRAY8", 160, 90))));
  EXPECT_EQ(gray, bytes_of(first_frame("seed=5", caps_of("I420", 160, 90))).substr(0, 160 * 90));
}

TEST(EllipseTestSrc, HasEachPattern) {
  const auto of = [](const char* pattern) {
    return bytes_of(first_frame("pattern=" + std::string(pattern), caps_of("GRAY8", 320, 180)));
  };
  EXPECT_NE(of("ring-x"), of("ring"));
  EXPECT_NE(of("ring"), of("disc"));
}

TEST(EllipseTestSrc, HasEachSceneByName) {
  std::set<std::string> seen;
  for (const char* scene : {"approach",
                            "oblique",
                            "dusk",
                            "glare",
                            "occluded",
                            "dash",
                            "touchdown",
                            "reenter",
                            "thin",
                            "disc",
                            "bullseye",
                            "crumpled",
                            "noise",
                            "negative",
                            "orbit",
                            "shake",
                            "hover"}) {
    const auto buffer = first_frame("scene=" + std::string(scene), caps_of("GRAY8", 160, 90));
    EXPECT_TRUE(seen.insert(bytes_of(buffer)).second) << scene;
    const bool has_truth =
        gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH) != nullptr;
    EXPECT_EQ(has_truth, std::string(scene) != "negative") << scene;
  }
}

TEST(EllipseTestSrc, PropertiesReplaceWhatTheSceneHas) {
  const auto of = [](const char* settings) {
    return bytes_of(first_frame(settings, caps_of("GRAY8", 160, 90)));
  };
  const std::string plain = of("scene=approach");
  EXPECT_EQ(plain, of("scene=approach pattern=scene ground=scene noise=-1"));
  EXPECT_EQ(plain, of("scene=approach pattern=ring-x ground=asphalt noise=2"));
  for (const char* change : {"pattern=bullseye", "ground=grass", "noise=9", "seed=2"}) {
    EXPECT_NE(plain, of(change)) << change;
  }
}

TEST(EllipseTestSrc, SceneCanChangeWhilePlaying) {
  Owned<GstHarness> harness(gst_harness_new_parse("ellipsetestsrc name=src"));
  gst_harness_set_sink_caps_str(harness.get(), caps_of("GRAY8", 160, 90).c_str());
  gst_harness_play(harness.get());
  Owned<GstBuffer>(gst_harness_pull(harness.get()));
  Owned<GstElement> source(gst_harness_find_element(harness.get(), "ellipsetestsrc"));
  gst_util_set_object_arg(G_OBJECT(source.get()), "scene", "negative");
  bool has_changed = false;
  for (int i = 0; i < 20 && !has_changed; ++i) {
    const Owned<GstBuffer> buffer(gst_harness_pull(harness.get()));
    has_changed = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH) == nullptr;
  }
  EXPECT_TRUE(has_changed);
}

TEST(EllipseTestSrc, TakesSizeAndRateFromCaps) {
  const auto buffer = first_frame("", "video/x-raw,format=NV12,width=33,height=17,framerate=50/1");
  EXPECT_EQ(GST_BUFFER_DURATION(buffer.get()), 20 * GST_MSECOND);
}

TEST(EllipseTestSrc, LiveGivesFramesAtTheirTime) {
  const GstClockTime start = gst_util_get_timestamp();
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc is-live=true num-buffers=10 ! "
                                  "video/x-raw,width=64,height=36,framerate=30/1 ! fakesink"),
            "");
  EXPECT_GE(gst_util_get_timestamp() - start, 290 * GST_MSECOND);
}

}  // namespace
