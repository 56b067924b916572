// SPDX-License-Identifier: MIT
//
// ellipsejson and ellipsetestsrc.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/scene/catalog.hpp"
#include "core/scene/true_ellipses.hpp"
#include "core/scene/wild.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::add_circle;
using support::buffer_of;
using support::caps_of;
using support::GrayPicture;
using support::harness_of;
using support::info_of;
using support::object_of;
using support::Owned;

TEST(EllipseJson, WritesOneLinePerFrame) {
  const auto harness = harness_of("ellipsejson", caps_of("GRAY8", 64, 48), "application/x-ndjson");
  std::string text;
  for (int i = 0; i < 2; ++i) {
    auto buffer = buffer_of(GrayPicture(64, 48, 50), info_of("GRAY8", 64, 48));
    if (i == 1) add_circle(buffer.get(), 32.25, 24.5, 10.0);
    GST_BUFFER_PTS(buffer.get()) = static_cast<guint64>(i) * 40 * GST_MSECOND;
    const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
    EXPECT_EQ(GST_BUFFER_PTS(out.get()), static_cast<guint64>(i) * 40 * GST_MSECOND);
    text += support::bytes_of(out.get());
  }
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "{\"frame\":0,\"pts_ns\":0,\"width\":64,\"height\":48,\"processing_ns\":null,"
            "\"tracker\":null,\"targets\":[]}");
  EXPECT_NE(text.find("{\"frame\":1,\"pts_ns\":40000000,"), std::string::npos);
  EXPECT_NE(text.find("\"cx\":32.2500,\"cy\":24.5000,\"semi_major\":10.0000"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
}

TEST(EllipseJson, DistinguishesAnEmptySearchFromNone) {
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
    EXPECT_EQ(json_object_get_null_member(line, "tracker"), i % 2 == 1) << i;
    if (i % 2 == 0) {
      EXPECT_STREQ(json_object_get_string_member(line, "tracker"), "searching") << i;
    }
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

TEST(EllipseJson, TakesMosaics) {
  const auto harness = harness_of("ellipsejson",
                                  "video/x-bayer,format=bggr,width=64,height=48,framerate=30/1",
                                  "application/x-ndjson");
  auto buffer = buffer_of(GrayPicture(64, 48, 50), info_of("GRAY8", 64, 48));
  const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
  EXPECT_NE(support::bytes_of(out.get()).find("\"width\":64,\"height\":48"), std::string::npos);
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

TEST(EllipseTestSrc, AttachesTheTruth) {
  const auto buffer = first_frame("num-buffers=1", caps_of("GRAY8", 320, 180));
  const GstEllipseMeta* truth = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH);
  ASSERT_NE(truth, nullptr);
  EXPECT_GT(truth->semi_minor, 5.0);
  EXPECT_GE(truth->semi_major, truth->semi_minor);
  EXPECT_EQ(truth->visible_fraction, 1.0);
}

TEST(EllipseTestSrc, IsDeterministicAndEqualInEachFormat) {
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
  std::set<std::string> distinct;
  for (const ellipse::NamedScene& scene : ellipse::scene_catalog()) {
    const std::string name = scene.name;
    const auto buffer = first_frame("scene=" + name, caps_of("GRAY8", 160, 90));
    EXPECT_TRUE(distinct.insert(bytes_of(buffer)).second) << name;
    const bool has_truth =
        gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH) != nullptr;
    EXPECT_EQ(has_truth, name != "negative") << name;
  }
  EXPECT_GE(distinct.size(), 18U);
}

TEST(EllipseTestSrc, PropertiesOverrideTheScene) {
  const auto of = [](const char* settings) {
    return bytes_of(first_frame(settings, caps_of("GRAY8", 160, 90)));
  };
  const std::string plain = of("scene=approach");
  EXPECT_EQ(plain, of("scene=approach pattern=scene ground=scene noise=-1 lens=none"));
  EXPECT_EQ(plain, of("scene=approach pattern=ring-x ground=asphalt noise=2"));
  for (const char* change :
       {"pattern=bullseye", "ground=grass", "noise=9", "seed=2", "lens=barrel", "lens=fisheye"}) {
    EXPECT_NE(plain, of(change)) << change;
  }
}

// Same form as ellipsetrack's outline for a distorting lens.
TEST(EllipseTestSrc, TruthThroughALensHasAnOutline) {
  for (const char* name : {"none", "barrel", "fisheye"}) {
    const auto buffer =
        first_frame("scene=hover lens=" + std::string(name), caps_of("GRAY8", 320, 180));
    const GstEllipseMeta* truth = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH);
    ASSERT_NE(truth, nullptr);
    ellipse::Scene scene = ellipse::scene_by_name("hover");
    if (std::string(name) == "none") {
      EXPECT_EQ(truth->n_outline, 0U);
      continue;
    }
    ellipse::put_on_lens(scene, name);
    const ellipse::Lens lens(ellipse::camera_of(scene, 320, 180));
    const ellipse::Ellipse ideal{
        truth->cx, truth->cy, truth->semi_major, truth->semi_minor, truth->angle_rad};
    ASSERT_EQ(truth->n_outline, 64U) << name;
    for (guint i = 0; i < truth->n_outline; ++i) {
      const auto point =
          lens.ideal_from_picture({truth->outline[2 * i], truth->outline[2 * i + 1]});
      ASSERT_TRUE(point) << name;
      EXPECT_NEAR(ellipse::sampson_distance(ideal, *point), 0.0, 1e-3) << name;
    }
  }
}

std::vector<const GstEllipseMeta*> truths_of(GstBuffer* buffer) {
  std::vector<const GstEllipseMeta*> truths;
  gpointer state = nullptr;
  while (GstMeta* meta =
             gst_buffer_iterate_meta_filtered(buffer, &state, GST_ELLIPSE_META_API_TYPE)) {
    const auto* ellipse = reinterpret_cast<const GstEllipseMeta*>(meta);
    if (ellipse->role == GST_ELLIPSE_ROLE_TRUTH) truths.push_back(ellipse);
  }
  return truths;
}

TEST(EllipseTestSrc, WildScenesCarryAllTheirEllipses) {
  std::size_t max_truths = 0;
  bool has_none = false;
  for (const int seed : {1, 2, 8, 24, 40}) {
    const auto buffer =
        first_frame("scene=wild seed=" + std::to_string(seed), caps_of("GRAY8", 320, 180));
    const auto expected =
        true_ellipses(ellipse::wild_scene(static_cast<std::uint64_t>(seed)), 0.0, 320, 180);
    const auto truths = truths_of(buffer.get());
    ASSERT_EQ(truths.size(), expected.size()) << seed;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      EXPECT_EQ(truths[i]->cx, expected[i].ellipse.cx) << seed;
      EXPECT_EQ(truths[i]->semi_minor, expected[i].ellipse.semi_minor) << seed;
      EXPECT_EQ(truths[i]->visible_fraction, expected[i].visible_fraction) << seed;
    }
    max_truths = std::max(max_truths, truths.size());
    has_none = has_none || truths.empty();
  }
  EXPECT_GT(max_truths, 20U);
  EXPECT_TRUE(has_none);
}

TEST(EllipseTestSrc, WildScenesHaveTheirOwnSizeAndRate) {
  const ellipse::Wild wild = ellipse::make_wild(9);
  const auto buffer = first_frame("scene=wild seed=9", "video/x-raw,format=GRAY8");
  ASSERT_NE(wild.width, 640);
  EXPECT_EQ(gst_buffer_get_size(buffer.get()),
            static_cast<gsize>((wild.width + 3) / 4 * 4) * static_cast<gsize>(wild.height));
  EXPECT_NEAR(static_cast<double>(GST_BUFFER_DURATION(buffer.get())),
              GST_SECOND / wild.frames_per_second,
              1.0);
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

TEST(EllipseTestSrc, LiveModeProducesFramesInRealTime) {
  const GstClockTime start = gst_util_get_timestamp();
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc is-live=true num-buffers=10 ! "
                                  "video/x-raw,width=64,height=36,framerate=30/1 ! fakesink"),
            "");
  EXPECT_GE(gst_util_get_timestamp() - start, 290 * GST_MSECOND);
}

}  // namespace
