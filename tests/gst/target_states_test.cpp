// SPDX-License-Identifier: MIT
//
// The reported states of a target that is visible, half hidden, hidden, gone and back.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "gst/ellipse/gstellipsesearchmeta.h"
#include "tests/gst/tracker_harness.hpp"
#include "tests/gst/verdicts.hpp"

namespace {

using support::BusTap;
using support::GrayPicture;
using support::object_of;
using support::Owned;
using support::Verdict;

enum class Sight { kClear, kHalfHidden, kHidden };

struct Shot {
  Sight sight;
  int frames;
};

// The last hidden shot exceeds the time for which a target is kept.
const std::vector<Shot> kShots{{Sight::kClear, 20},
                               {Sight::kHalfHidden, 8},
                               {Sight::kClear, 10},
                               {Sight::kHidden, 4},
                               {Sight::kClear, 16},
                               {Sight::kHidden, 20},
                               {Sight::kClear, 10}};

// A drifting pad; a bar hides more than half of it on request.
GrayPicture picture_of(Sight sight, int frame) {
  if (sight == Sight::kHidden) return GrayPicture(320, 240, 90);
  ellipse::Scene scene;
  if (sight == Sight::kHalfHidden) {
    scene.bars.push_back(support::bar_px({0.0, 120.0}, {320.0, 120.0}, 39.5, 60.0));
  }
  const ellipse::Ellipse pad{120.0 + 0.5 * frame, 110.0 + 0.2 * frame, 40.0, 32.0, 0.4};
  return support::rendered(scene, pad, 320, 240, static_cast<std::uint64_t>(frame));
}

// State and id of a target, and the tracker's state, as reported in one of the three ways.
using Report = std::string;

Report report(const std::string& state, std::uint64_t id, const std::string& tracker) {
  return (id == 0 ? "lost" : state + " " + std::to_string(id)) + ", " + tracker;
}

Report by_metadata(GstBuffer* buffer) {
  const GstEllipseSearchMeta* search = gst_buffer_get_ellipse_search_meta(buffer);
  const char* tracker = gst_ellipse_search_meta_get_tracker_state_name(search);
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  if (meta == nullptr) return report("", 0, tracker);
  const Owned<GstStructure> structure(gst_ellipse_meta_to_structure(meta));
  return report(gst_structure_get_string(structure.get(), "state"), meta->id, tracker);
}

Report by_message(BusTap& bus) {
  const auto message = bus.pop(GST_MESSAGE_ELEMENT);
  if (!message) return "nothing";
  const GstStructure* structure = gst_message_get_structure(message.get());
  guint64 id = 0;
  gst_structure_get_uint64(structure, "id", &id);
  return report(gst_structure_get_string(structure, "state"),
                id,
                gst_structure_get_string(structure, "tracker"));
}

Report by_line(GstBuffer* line) {
  const auto lines = support::parse_ndjson(std::istringstream(support::bytes_of(line)));
  JsonObject* frame = object_of(lines.at(0));
  const char* tracker = json_object_get_string_member(frame, "tracker");
  JsonArray* targets = json_object_get_array_member(frame, "targets");
  if (json_array_get_length(targets) == 0) return report("", 0, tracker);
  JsonObject* target = json_array_get_object_element(targets, 0);
  return report(json_object_get_string_member(target, "state"),
                static_cast<std::uint64_t>(json_object_get_int_member(target, "id")),
                tracker);
}

std::string tracker_in_stats(GstElement* element) {
  const Owned<GstStructure> stats(support::structure_property(element, "stats"));
  return gst_structure_get_string(stats.get(), "tracker");
}

GstPadProbeReturn note_metadata(GstPad*, GstPadProbeInfo* info, gpointer data) {
  *static_cast<Report*>(data) = by_metadata(GST_PAD_PROBE_INFO_BUFFER(info));
  return GST_PAD_PROBE_OK;
}

// The states in the metadata of each frame; fails if messages or lines differ.
std::vector<Report> story() {
  // With .99 or less, half a pad would be detected again: a lost target has a prior.
  const auto harness = support::harness_of(
      "ellipsetrack name=t min-probability=0.999 "
      "messages=every-frame ! ellipsejson",
      support::caps_of("GRAY8", 320, 240),
      "application/x-ndjson");
  GstElement* element = support::element_of(harness);
  BusTap bus(element);
  Report on_buffer;
  GstPad* pad = gst_element_get_static_pad(element, "src");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, note_metadata, &on_buffer, nullptr);
  gst_object_unref(pad);
  std::vector<Report> story;
  for (const Shot& shot : kShots) {
    for (int i = 0; i < shot.frames; ++i) {
      const int frame = static_cast<int>(story.size());
      auto buffer = support::gray_buffer_of(picture_of(shot.sight, frame));
      GST_BUFFER_PTS(buffer.get()) =
          gst_util_uint64_scale(static_cast<guint64>(frame), GST_SECOND, 30);
      const auto line = support::push(harness, std::move(buffer));
      EXPECT_EQ(by_message(bus), on_buffer) << frame;
      EXPECT_EQ(by_line(line.get()), on_buffer) << frame;
      EXPECT_TRUE(on_buffer.ends_with(", " + tracker_in_stats(element))) << frame;
      story.push_back(on_buffer);
    }
  }
  return story;
}

// Run-length encoding of the states.
std::string summary_of(const std::vector<Report>& story) {
  std::string summary;
  for (std::size_t first = 0, i = 0; i < story.size(); ++i) {
    if (i + 1 < story.size() && story[i + 1] == story[first]) continue;
    summary += std::to_string(i + 1 - first) + " x " + story[first] + "\n";
    first = i + 1;
  }
  return summary;
}

TEST(TargetStates, AreTheSameInMetadataMessagesAndLines) {
  // Hidden briefly, the target keeps its id; hidden for longer than it is kept, it gets a new one.
  EXPECT_EQ(summary_of(story()),
            "6 x lost, confirming\n"
            "14 x tracked 1, following\n"
            "8 x predicted 1, coasting\n"
            "10 x tracked 1, following\n"
            "4 x lost, searching\n"
            "16 x tracked 1, following\n"
            "20 x lost, searching\n"
            "6 x lost, confirming\n"
            "4 x tracked 2, following\n");
}

// A disc that slowly enters the frame: its odds pass through the range of the state "confirming".
TEST(TargetStates, AreConfirmedBeforeTheyAreReported) {
  const auto harness = support::harness_of(
      "ellipsetrack name=t min-probability=0.98 messages=every-frame ! ellipsejson",
      support::caps_of("GRAY8", 320, 240),
      "application/x-ndjson");
  BusTap bus(support::element_of(harness));
  ellipse::Scene scene = support::plain_ring();
  scene.pad.pattern = ellipse::Pattern::kDisc;
  std::vector<Report> story;
  for (int frame = 0; frame < 60; ++frame) {
    auto buffer = support::gray_buffer_of(
        support::rendered(scene, {-8.0 + 0.1 * frame, 110.0, 40.0, 32.0, 0.3}));
    GST_BUFFER_PTS(buffer.get()) =
        gst_util_uint64_scale(static_cast<guint64>(frame), GST_SECOND, 30);
    story.push_back(by_line(support::push(harness, std::move(buffer)).get()));
    EXPECT_EQ(by_message(bus), story.back()) << frame;
  }
  const auto confirming = std::find(story.begin(), story.end(), "lost, confirming");
  const auto following = std::find(story.begin(), story.end(), "detected 1, following");
  EXPECT_LT(confirming, following);
  EXPECT_NE(following, story.end());
}

TEST(TargetStates, AreFollowingOrSearchingWithoutEdgeTracking) {
  for (const std::string tracking : {"redetect", "none"}) {
    const auto harness = support::harness_of("ellipsetrack name=t ! ellipsejson",
                                             support::caps_of("GRAY8", 320, 240),
                                             "application/x-ndjson");
    gst_util_set_object_arg(G_OBJECT(support::element_of(harness)), "tracking", tracking.c_str());
    const auto report_of = [&](Sight sight) {
      auto buffer = support::gray_buffer_of(picture_of(sight, 0));
      return by_line(support::push(harness, std::move(buffer)).get());
    };
    EXPECT_EQ(report_of(Sight::kClear), "detected 1, following") << tracking;
    EXPECT_EQ(report_of(Sight::kHidden), "lost, searching") << tracking;
  }
}

TEST(TargetStates, ReturnToSearchingAfterAFlush) {
  const auto harness = support::tracker();
  GstElement* element = support::element_of(harness);
  (void)support::push(harness, support::gray_buffer_of(picture_of(Sight::kClear, 0)));
  EXPECT_EQ(tracker_in_stats(element), "following");
  gst_harness_push_event(harness.get(), gst_event_new_flush_start());
  gst_harness_push_event(harness.get(), gst_event_new_flush_stop(TRUE));
  EXPECT_EQ(tracker_in_stats(element), "searching");
}

struct ShownFrame {
  std::uint64_t id;
  double visible;  // of the true ellipse
};

GstPadProbeReturn note_truth(GstPad*, GstPadProbeInfo* info, gpointer data) {
  GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
  const GstEllipseMeta* truth = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TRUTH);
  static_cast<std::vector<ShownFrame>*>(data)->push_back(
      {support::verdict_on(buffer).id, truth != nullptr ? truth->visible_fraction : 0.0});
  return GST_PAD_PROBE_OK;
}

double in_line(GstBuffer* line, const char* name) {
  const auto lines = support::parse_ndjson(std::istringstream(support::bytes_of(line)));
  JsonArray* targets = json_object_get_array_member(object_of(lines.at(0)), "targets");
  return json_object_get_double_member(json_array_get_object_element(targets, 0), name);
}

TEST(TargetStates, AccumulateTheProbabilityOverFrames) {
  const auto harness = support::harness_of("ellipsetrack name=t ! ellipsejson",
                                           support::caps_of("GRAY8", 320, 240),
                                           "application/x-ndjson");
  const auto probability_in = [&](int frame) {
    const auto line =
        support::push(harness, support::gray_buffer_of(picture_of(Sight::kClear, frame)));
    return in_line(line.get(), "probability");
  };
  const double detected = probability_in(0);
  EXPECT_GT(detected, 0.5);
  EXPECT_LT(detected, 1.0);
  for (int frame = 1; frame < 4; ++frame) EXPECT_GT(probability_in(frame), 0.5);
  gst_util_set_object_arg(G_OBJECT(support::element_of(harness)), "detector", "contours");
  gst_util_set_object_arg(G_OBJECT(support::element_of(harness)), "tracking", "redetect");
  EXPECT_EQ(probability_in(4), 1.0);
}

TEST(TargetStates, IdsChangeOnlyWhileThePadIsOutOfThePicture) {
  std::vector<ShownFrame> frames;
  ASSERT_EQ(support::run_pipeline(
                "ellipsetestsrc scene=reenter num-buffers=400 ! "
                "video/x-raw,width=320,height=180 ! ellipsetrack ! fakesink name=out",
                [&](GstElement* pipeline) {
                  GstElement* out = gst_bin_get_by_name(GST_BIN(pipeline), "out");
                  GstPad* pad = gst_element_get_static_pad(out, "sink");
                  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, note_truth, &frames, nullptr);
                  gst_object_unref(pad);
                  gst_object_unref(out);
                }),
            "");
  ASSERT_EQ(frames.size(), 400U);
  std::uint64_t last_id = 0;
  double min_visible = 1.0;  // since a target was found
  int changes = 0;
  for (const ShownFrame& frame : frames) {
    min_visible = std::min(min_visible, frame.visible);
    if (frame.id == 0) continue;
    if (last_id != 0 && frame.id != last_id) {
      EXPECT_LT(min_visible, 0.1);
      ++changes;
    }
    last_id = frame.id;
    min_visible = 1.0;
  }
  EXPECT_GE(changes, 1);
}

}  // namespace
