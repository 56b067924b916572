// SPDX-License-Identifier: MIT
//
// ellipsetrack under continuous changes: states, properties, caps, positions, starts.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "core/scene/random.hpp"
#include "tests/gst/any_property.hpp"
#include "tests/gst/tracker_harness.hpp"
#include "tests/gst/verdicts.hpp"

namespace {

using support::caps_of;
using support::element_of;
using support::GrayPicture;
using support::harness_of;
using support::info_of;
using support::kRing;
using support::Owned;
using support::Pipeline;
using support::ring_picture;
using support::stat;
using support::target_on;
using support::tracker;
using support::Verdict;
using support::Verdicts;

void open_stream(const Owned<GstHarness>& harness, const std::string& caps) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  GstCaps* wanted = gst_caps_from_string(caps.c_str());
  gst_harness_push_event(harness.get(), gst_event_new_stream_start("stress"));
  gst_harness_push_event(harness.get(), gst_event_new_caps(wanted));
  gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
  gst_caps_unref(wanted);
}

TEST(Stress, EachStateTakesPropertiesAndOnlyRunningOnesTakeBuffers) {
  const std::array states{GST_STATE_NULL, GST_STATE_READY, GST_STATE_PAUSED, GST_STATE_PLAYING};
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  ellipse::Random random(1);
  support::QuietWarnings quiet;
  for (int i = 0; i < 300; ++i) {
    const GstState state = states.at(static_cast<std::size_t>(random.below(4)));
    ASSERT_EQ(gst_element_set_state(element, state), GST_STATE_CHANGE_SUCCESS);
    for (GParamSpec* spec : support::settings_of(element)) {
      support::set_at_random(element, spec, random);
      support::set_default(element, spec);
    }
    const bool is_running = state >= GST_STATE_PAUSED;
    if (is_running) open_stream(harness, caps_of("GRAY8", 320, 240));
    const guint64 before = stat(element, "frames");
    const GstFlowReturn flow =
        gst_harness_push(harness.get(), support::gray_buffer_of(ring_picture()).release());
    EXPECT_EQ(flow, is_running ? GST_FLOW_OK : GST_FLOW_FLUSHING)
        << gst_element_state_get_name(state);
    EXPECT_EQ(stat(element, "frames"), before + (is_running ? 1U : 0U));
    if (!is_running) continue;
    const Owned<GstBuffer> out(gst_harness_pull(harness.get()));
    EXPECT_NE(target_on(out), nullptr);
  }
}

TEST(Stress, PropertiesAreWrittenTenThousandTimesWhilePlaying) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  support::QuietWarnings quiet;
  constexpr int kWrites = 10'000;
  constexpr int kWritesAFrame = 20;  // on average
  std::atomic<int> writes = 0;
  std::atomic<int> frames = 0;
  std::thread writer([&] {
    ellipse::Random random(2);
    const std::vector<GParamSpec*> specs = support::settings_of(element);
    for (; writes < kWrites; ++writes) {
      while (writes > kWritesAFrame * (frames + 1)) std::this_thread::yield();
      const int which = random.below(static_cast<int>(specs.size()));
      support::set_at_random(element, specs.at(static_cast<std::size_t>(which)), random);
      if (writes % 50 == 0) {
        for (const char* name : {"stats", "target"}) {
          const Owned<GstStructure> read(support::structure_property(element, name));
        }
      }
      if (writes % 200 == 0) g_signal_emit_by_name(element, "reset");
    }
  });
  const GrayPicture picture = ring_picture();
  for (; writes < kWrites; ++frames) support::push(harness, support::gray_buffer_of(picture));
  writer.join();
  EXPECT_EQ(stat(element, "frames"), static_cast<guint64>(frames));
  EXPECT_GE(frames, kWrites / kWritesAFrame - 1);
  for (GParamSpec* spec : support::settings_of(element)) support::set_default(element, spec);
  EXPECT_NE(target_on(support::push(harness, support::gray_buffer_of(picture))), nullptr);
}

TEST(Stress, SurvivesNaNAndExtremeNumbers) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  support::QuietWarnings quiet;
  guint64 frames = 0;
  for (GParamSpec* spec : support::settings_of(element)) {
    for (const double number : support::kExtremes) {
      support::set_number(element, spec, number);
      for (int i = 0; i < 2; ++i, ++frames) {
        EXPECT_TRUE(support::push(harness, support::gray_buffer_of(ring_picture()))) << spec->name;
      }
    }
    support::set_default(element, spec);
  }
  EXPECT_EQ(stat(element, "frames"), frames);
  g_signal_emit_by_name(element, "reset");
  const auto out = support::push(harness, support::gray_buffer_of(ring_picture()));
  ASSERT_NE(target_on(out), nullptr);
  EXPECT_NEAR(target_on(out)->cx, kRing.cx, 0.1);
}

// A centred ring in proportion to the picture.
ellipse::Ellipse ring_of(int width, int height) {
  const double radius = 0.35 * std::min(width, height);
  return {0.5 * width, 0.5 * height, radius, 0.8 * radius, 0.3};
}

TEST(Stress, CapsChangeAtEachBuffer) {
  const std::vector<const char*> formats = support::raw_formats();
  const auto harness = tracker("! ellipseoverlay");
  ellipse::Random random(3);
  for (int i = 0; i < 400; ++i) {
    const std::string format =
        formats.at(static_cast<std::size_t>(random.below(static_cast<int>(formats.size()))));
    const int width = 90 + random.below(200);
    const int height = 90 + random.below(150);
    const std::string caps = caps_of(format, width, height);
    gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
    const ellipse::Ellipse ring = ring_of(width, height);
    const GrayPicture picture = support::rendered(support::plain_ring(), ring, width, height);
    const auto out =
        support::push(harness, support::buffer_of(picture, info_of(format, width, height)));
    ASSERT_TRUE(out);
    const GstEllipseMeta* meta = target_on(out);
    ASSERT_NE(meta, nullptr) << caps;
    EXPECT_NEAR(meta->cx, ring.cx, 0.2) << caps;
    EXPECT_NEAR(meta->semi_major, ring.semi_major, 0.3) << caps;
    EXPECT_EQ(meta->frame_width, guint(width));
  }
}

bool seek(GstElement* pipeline, double to_s) {
  const auto position = static_cast<gint64>(to_s * GST_SECOND);
  return gst_element_seek_simple(pipeline, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, position) != FALSE;
}

// Ids keep counting through a flush.
std::vector<Verdict> numbered_from_one(std::vector<Verdict> verdicts) {
  std::uint64_t first = 0;
  for (Verdict& verdict : verdicts) {
    if (first == 0) first = verdict.id;
    if (verdict.id != 0) verdict.id -= first - 1;
  }
  return verdicts;
}

TEST(Stress, ManySeeksLeaveTheResultUnchanged) {
  const support::TemporaryFolder folder;
  const std::string video = folder.file("landing.avi");
  ASSERT_EQ(support::run_pipeline("ellipsetestsrc num-buffers=60 ! "
                                  "video/x-raw,width=240,height=180 ! jpegenc ! avimux ! "
                                  "filesink location=" +
                                  video),
            "");
  const std::string description = "filesrc location=" + video +
                                  " ! avidemux ! jpegdec ! ellipsetrack ! "
                                  "fakesink sync=false name=out";
  const std::vector<Verdict> undisturbed = support::verdicts_of(description);
  ASSERT_EQ(undisturbed.size(), 60U);

  Pipeline pipeline(description);
  Verdicts verdicts;
  verdicts.watch(pipeline.get());
  pipeline.pause();
  ellipse::Random random(4);
  for (int i = 0; i < 200; ++i) {
    gst_element_set_state(pipeline.get(),
                          random.below(2) == 0 ? GST_STATE_PAUSED : GST_STATE_PLAYING);
    ASSERT_TRUE(seek(pipeline.get(), random.between(0.0, 2.0))) << i;
  }
  pipeline.pause();
  ASSERT_TRUE(seek(pipeline.get(), 0.0));
  pipeline.pause();
  pipeline.clear_messages();  // including the EOS of an earlier seek
  pipeline.play();
  ASSERT_EQ(pipeline.wait_for_end(), "");
  EXPECT_EQ(numbered_from_one(verdicts.all()), undisturbed);
}

// async=false: a sink with preroll loses its state in each flush, and the bin's thread that
// restores it races with the next flush. That would test the bin.
TEST(Stress, SurvivesManyFlushesFromTheSource) {
  Pipeline pipeline(
      "ellipsetestsrc name=src ! video/x-raw,width=160,height=120 ! ellipsetrack name=t ! "
      "ellipsejson ! fakesink name=out async=false");
  Verdicts verdicts;
  verdicts.watch(pipeline.get(), "t");
  pipeline.pause();
  pipeline.play();
  const auto source = pipeline.element("src");
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(gst_element_send_event(source.get(), gst_event_new_flush_start()));
    ASSERT_TRUE(gst_element_send_event(source.get(), gst_event_new_flush_stop(i % 2)));
    // A flush before the first buffer disturbs nothing.
    while (i % 10 == 0 && verdicts.all().empty()) std::this_thread::yield();
  }
  ASSERT_TRUE(gst_element_send_event(source.get(), gst_event_new_eos()));
  EXPECT_EQ(pipeline.wait_for_end(), "");
}

std::size_t open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(Stress, StartsAndEndsAThousandTimes) {
  Pipeline pipeline(
      "ellipsetestsrc num-buffers=2 ! video/x-raw,width=64,height=48 ! ellipsetrack name=t ! "
      "ellipsejson ! fakesink name=out");
  const auto element = pipeline.element("t");
  std::size_t files = 0;
  for (int i = 0; i < 1000; ++i) {
    pipeline.play();
    ASSERT_EQ(pipeline.wait_for_end(), "") << i;
    ASSERT_EQ(stat(element.get(), "frames"), 2U) << i;
    gst_element_set_state(pipeline.get(), i % 2 == 0 ? GST_STATE_NULL : GST_STATE_READY);
    if (i == 10) files = open_files();
  }
  // One descriptor leaked per start would be a thousand; GLib's threads open some at any time.
  EXPECT_LE(open_files(), files + 4);
}

TEST(Stress, EightTrackersInOneProcessDoNotDisturbEachOther) {
  const std::array scenes{
      "approach", "oblique", "dusk", "thin", "disc", "bullseye", "orbit", "hover"};
  std::vector<std::vector<Verdict>> alone(scenes.size());
  std::vector<std::vector<Verdict>> together(scenes.size());
  const auto run = [&](std::size_t i, std::vector<std::vector<Verdict>>& into) {
    into[i] =
        support::verdicts_of("ellipsetestsrc num-buffers=40 scene=" + std::string(scenes.at(i)) +
                             " ! video/x-raw,width=320,height=180 ! ellipsetrack ! fakesink "
                             "name=out");
  };
  for (std::size_t i = 0; i < scenes.size(); ++i) run(i, alone);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < scenes.size(); ++i) threads.emplace_back(run, i, std::ref(together));
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    EXPECT_EQ(alone[i].size(), 40U) << scenes.at(i);
    EXPECT_EQ(together[i], alone[i]) << scenes.at(i);
  }
}

}  // namespace
