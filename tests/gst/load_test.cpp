// SPDX-License-Identifier: MIT
//
// Load handling without real time: tests of the element set a limit that every frame exceeds.
#include <gtest/gtest.h>

#include <string>

#include "gst/track/lateness.hpp"
#include "gst/track/load_watch.hpp"
#include "gst/track/track_stats.hpp"
#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using support::BusTap;
using support::caps_of;
using support::element_of;
using support::gray_buffer_of;
using support::GrayPicture;
using support::Owned;
using support::push;
using support::ring_picture;
using support::stat;
using support::target_on;
using support::tracker;

constexpr GstClockTime kLimit = 10 * GST_MSECOND;

int frames_until_change(LoadWatch& load, GstClockTime processing_time) {
  for (int frame = 1; frame < 1000; ++frame) {
    if (load.add(processing_time, kLimit)) return frame;
  }
  return 0;
}

TEST(LoadWatch, CoarsensTheSearchBeforeItSkips) {
  LoadWatch load;
  std::string steps;
  for (int step = 0; step < 5; ++step) {
    EXPECT_EQ(frames_until_change(load, kLimit + 1), 3) << step;
    steps += std::to_string(load.scale()) + "/" + std::to_string(load.skipped_in_a_row()) + " ";
  }
  EXPECT_EQ(steps, "2/0 4/0 8/0 8/1 8/3 ");
  EXPECT_EQ(frames_until_change(load, kLimit + 1), 0);  // no further reduction
}

TEST(LoadWatch, UndoesOneStepAfterALongRest) {
  LoadWatch load;
  frames_until_change(load, 2 * kLimit);
  frames_until_change(load, 2 * kLimit);
  EXPECT_EQ(frames_until_change(load, kLimit / 3), 128);
  EXPECT_EQ(load.scale(), 2);
  EXPECT_EQ(frames_until_change(load, kLimit / 3), 128);
  EXPECT_FALSE(load.is_overloaded());
}

TEST(LoadWatch, KeepsItsStepBetweenHalfAndTheWholeLimit) {
  LoadWatch load;
  frames_until_change(load, 2 * kLimit);
  EXPECT_EQ(frames_until_change(load, kLimit), 0);
  EXPECT_EQ(frames_until_change(load, kLimit / 2), 0);
  EXPECT_EQ(load.scale(), 2);
}

TEST(LoadWatch, OccasionalLateFramesAreNoOverload) {
  LoadWatch load;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(load.add(i % 30 == 0 ? 5 * kLimit : kLimit / 5, kLimit)) << i;
  }
}

TEST(LoadWatch, EveryEighthFrameLateIsAnOverload) {
  LoadWatch load;
  for (int i = 0; i < 300 && !load.is_overloaded(); ++i) {
    load.add(i % 8 == 0 ? 2 * kLimit : kLimit / 5, kLimit);
  }
  EXPECT_EQ(load.scale(), 2);
}

TEST(LoadWatch, IsResetWithoutALimit) {
  LoadWatch load;
  EXPECT_FALSE(load.add(GST_SECOND, 0));
  frames_until_change(load, 2 * kLimit);
  EXPECT_TRUE(load.add(GST_SECOND, 0));
  EXPECT_FALSE(load.is_overloaded());
}

TEST(LoadWatch, SkipsEvenly) {
  LoadWatch load;
  for (int step = 0; step < 5; ++step) frames_until_change(load, 2 * kLimit);
  std::string pattern;
  for (int i = 0; i < 9; ++i) pattern += load.skips_next() ? '.' : 'x';
  EXPECT_EQ(pattern, "...x...x.");
}

TEST(Lateness, KeepsOneFrameInFive) {
  Lateness lateness;
  EXPECT_FALSE(lateness.skips_next(0));
  lateness.observe(100, 1000);
  std::string pattern;
  for (GstClockTime time = 200; time < 212; ++time) {
    pattern += lateness.skips_next(time) ? '.' : 'x';
  }
  EXPECT_EQ(pattern, "....x....x..");
  EXPECT_FALSE(lateness.skips_next(2101));  // 100 + 2 x 1000 has passed
  EXPECT_FALSE(lateness.skips_next(GST_CLOCK_TIME_NONE));
  lateness.observe(100, -50);
  EXPECT_FALSE(lateness.skips_next(50));
}

TEST(TrackStats, ReportsTimesOfTheLastFrames) {
  TrackStats stats;
  EXPECT_EQ(stats.latency(), 0U);
  for (guint64 i = 0; i < 50; ++i) stats.add_analysed(std::nullopt, GST_SECOND);
  for (guint64 i = 1; i <= 1024; ++i) stats.add_analysed(std::nullopt, i * GST_USECOND);
  const Owned<GstStructure> structure(stats.to_structure());
  const auto time = [&](const char* name) {
    guint64 value = 0;
    EXPECT_TRUE(gst_structure_get_uint64(structure.get(), name, &value)) << name;
    return value;
  };
  EXPECT_EQ(time("processing-time-median"), 513 * GST_USECOND);
  EXPECT_EQ(time("processing-time-p99"), 1014 * GST_USECOND);
  EXPECT_EQ(time("processing-time-max"), 1024 * GST_USECOND);
  EXPECT_EQ(time("latency"), 2 * GST_MSECOND);
}

TEST(TrackStats, CountsPredictedApartFromTracked) {
  TrackStats stats;
  ellipse::Target target;
  for (const auto state : {ellipse::TargetState::kDetected,
                           ellipse::TargetState::kTracked,
                           ellipse::TargetState::kTracked,
                           ellipse::TargetState::kPredicted}) {
    target.state = state;
    stats.add_analysed(target, 1);
  }
  stats.add_analysed(std::nullopt, 1);
  stats.add_skipped(Skip::kLate);
  const Owned<GstStructure> structure(stats.to_structure());
  gchar* text = gst_structure_to_string(structure.get());
  for (const char* part : {"frames=(guint64)6",
                           "detected=(guint64)1",
                           " tracked=(guint64)2",
                           "predicted=(guint64)1",
                           "lost=(guint64)1",
                           "skipped-late=(guint64)1"}) {
    EXPECT_NE(std::string(text).find(part), std::string::npos) << part;
  }
  g_free(text);
}

TEST(EllipseTrackLoad, CoarsensThenSkipsAndReportsIt) {
  const auto harness = tracker("max-processing-time=1 tracking=none messages=none");
  GstElement* element = element_of(harness);
  BusTap bus(element);
  std::string steps;
  for (int i = 0; i < 22; ++i) {
    const auto out = push(harness, gray_buffer_of(ring_picture()));
    ASSERT_TRUE(out);  // no frame is dropped
    if (i == 2 || i == 3) {
      EXPECT_EQ(target_on(out)->scale, i == 2 ? 1U : 2U);
    }
    const auto message = bus.pop(GST_MESSAGE_ELEMENT);
    if (!message) continue;
    const GstStructure* s = gst_message_get_structure(message.get());
    EXPECT_TRUE(gst_structure_has_name(s, "ellipse-load"));
    guint scale = 0;
    guint skipped = 0;
    gboolean is_overloaded = FALSE;
    EXPECT_TRUE(gst_structure_get(s,
                                  "overloaded",
                                  G_TYPE_BOOLEAN,
                                  &is_overloaded,
                                  "scale",
                                  G_TYPE_UINT,
                                  &scale,
                                  "skipped-in-a-row",
                                  G_TYPE_UINT,
                                  &skipped,
                                  nullptr));
    EXPECT_TRUE(is_overloaded);
    steps += std::to_string(i) + ":" + std::to_string(scale) + "/" + std::to_string(skipped) + " ";
  }
  EXPECT_EQ(steps, "2:2/0 5:4/0 8:8/0 11:8/1 17:8/3 ");
  EXPECT_EQ(stat(element, "analysed"), 16U);
  EXPECT_EQ(stat(element, "skipped-load"), 6U);
}

TEST(EllipseTrackLoad, RemovingTheLimitEndsTheOverload) {
  const auto harness = tracker("max-processing-time=1 tracking=none messages=none");
  for (int i = 0; i < 4; ++i) push(harness, gray_buffer_of(ring_picture()));
  BusTap bus(element_of(harness));
  g_object_set(element_of(harness), "max-processing-time", guint64{0}, nullptr);
  push(harness, gray_buffer_of(ring_picture()));
  const auto message = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(message);
  gboolean is_overloaded = TRUE;
  gst_structure_get_boolean(gst_message_get_structure(message.get()), "overloaded", &is_overloaded);
  EXPECT_FALSE(is_overloaded);
  EXPECT_EQ(target_on(push(harness, gray_buffer_of(ring_picture())))->scale, 1U);
}

TEST(EllipseTrackLoad, AFlushEndsTheOverload) {
  const auto harness = tracker("max-processing-time=1 tracking=none messages=none");
  for (int i = 0; i < 4; ++i) push(harness, gray_buffer_of(ring_picture()));
  BusTap bus(element_of(harness));
  gst_harness_push_event(harness.get(), gst_event_new_flush_start());
  gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
  const auto message = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(message);
  gboolean is_overloaded = TRUE;
  gst_structure_get_boolean(gst_message_get_structure(message.get()), "overloaded", &is_overloaded);
  EXPECT_FALSE(is_overloaded);
}

TEST(EllipseTrackLoad, KeepsTheTarget) {
  const auto harness = tracker("max-processing-time=1 messages=none");
  for (int i = 0; i < 60; ++i) {
    const auto out = push(harness, gray_buffer_of(ring_picture()));
    const GstEllipseMeta* meta = target_on(out);
    EXPECT_TRUE(meta == nullptr || meta->id == 1U) << i;
  }
  EXPECT_EQ(stat(element_of(harness), "lost"), 0U);
}

TEST(EllipseTrackLatency, IsThatOfUpstreamPlusTheMeasured) {
  const auto harness = tracker("messages=none");
  GstElement* element = element_of(harness);
  gst_harness_set_upstream_latency(harness.get(), 20 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(harness.get()), 20 * GST_MSECOND);
  BusTap bus(element);
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_FALSE(bus.pop(GST_MESSAGE_LATENCY)) << "one frame tells nothing";
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_TRUE(bus.pop(GST_MESSAGE_LATENCY));
  const GstClockTime own = stat(element, "latency");
  EXPECT_GE(own, GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(harness.get()), 20 * GST_MSECOND + own);
}

// Skipped frames leave fewer analyses; the latency message must come nonetheless.
TEST(EllipseTrackLatency, IsReportedWithSkippedFrames) {
  const auto harness = tracker("messages=none interval=1000");
  GstElement* element = element_of(harness);
  gst_harness_set_upstream_latency(harness.get(), 0);
  EXPECT_EQ(gst_harness_query_latency(harness.get()), 0U);
  BusTap bus(element);
  push(harness, gray_buffer_of(ring_picture()));
  g_object_set(element, "interval", 2U, nullptr);
  push(harness, gray_buffer_of(ring_picture()));
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(stat(element, "analysed"), 2U);
  push(harness, gray_buffer_of(ring_picture()));
  EXPECT_EQ(stat(element, "analysed"), 2U);
  EXPECT_TRUE(bus.pop(GST_MESSAGE_LATENCY));
}

TEST(TrackStats, LatencyExcludesTheFirstFrame) {
  TrackStats stats;
  stats.add_analysed(std::nullopt, 90 * GST_MSECOND);
  EXPECT_EQ(stats.latency(), 0U);
  stats.add_analysed(std::nullopt, 3 * GST_MSECOND);
  EXPECT_EQ(stats.latency(), 3 * GST_MSECOND);
  for (int i = 0; i < 500; ++i) stats.add_analysed(std::nullopt, (i % 5) * GST_MSECOND);
  EXPECT_EQ(stats.latency(), 4 * GST_MSECOND);
}

TEST(EllipseTrackLatency, IsZeroInNonLivePipelines) {
  support::Pipeline pipeline(
      "ellipsetestsrc num-buffers=40 ! ellipsetrack name=t ! fakesink sync=false");
  pipeline.play();
  EXPECT_EQ(pipeline.wait_for_end(), "");
  GstQuery* query = gst_query_new_latency();
  const auto element = pipeline.element("t");
  GstPad* pad = gst_element_get_static_pad(element.get(), "src");
  ASSERT_TRUE(gst_pad_query(pad, query));
  gboolean is_live = TRUE;
  GstClockTime min = 1;
  gst_query_parse_latency(query, &is_live, &min, nullptr);
  EXPECT_FALSE(is_live);
  EXPECT_EQ(min, 0U);
  EXPECT_GT(stat(element.get(), "latency"), 0U);
  gst_object_unref(pad);
  gst_query_unref(query);
}

}  // namespace
