// SPDX-License-Identifier: MIT
//
// Whole pipelines with real files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "tests/gst/own_tests.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::object_of;
using support::read_ndjson;
using support::run_pipeline;
using support::TemporaryFolder;

// The ellipse with a role on a line, if any.
std::optional<ellipse::Ellipse> ellipse_on(JsonObject* line, const std::string& role) {
  JsonArray* targets = json_object_get_array_member(line, "targets");
  for (guint i = 0; i < json_array_get_length(targets); ++i) {
    JsonObject* t = json_array_get_object_element(targets, i);
    if (json_object_get_string_member(t, "role") != role) continue;
    return ellipse::Ellipse{json_object_get_double_member(t, "cx"),
                            json_object_get_double_member(t, "cy"),
                            json_object_get_double_member(t, "semi_major"),
                            json_object_get_double_member(t, "semi_minor"),
                            json_object_get_double_member(t, "angle_rad")};
  }
  return std::nullopt;
}

TEST(Pipeline, TracksAVideoFileReadBackFromDisk) {
  const TemporaryFolder folder;
  const std::string video = folder.file("approach.avi");
  const std::string truth_file = folder.file("truth.ndjson");
  const std::string found_file = folder.file("found.ndjson");
  ASSERT_EQ(run_pipeline("ellipsetestsrc num-buffers=60 ! tee name=t t. ! queue ! jpegenc "
                         "quality=90 ! avimux ! filesink location=" +
                         video + " t. ! queue ! ellipsejson ! filesink location=" + truth_file),
            "");
  ASSERT_EQ(run_pipeline("filesrc location=" + video +
                         " ! decodebin ! videoconvert ! ellipsetrack ! ellipsejson ! filesink "
                         "location=" +
                         found_file),
            "");
  const auto truth = read_ndjson(truth_file);
  const auto found = read_ndjson(found_file);
  ASSERT_EQ(truth.size(), 60U);
  ASSERT_EQ(found.size(), 60U);
  int right = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto a = ellipse_on(object_of(truth[i]), "truth");
    const auto b = ellipse_on(object_of(found[i]), "target");
    right += a && b && ellipse::iou_inside(*a, *b, 640, 360) >= 0.9 ? 1 : 0;
  }
  EXPECT_GE(right, 59);
}

// Records the memory of each buffer that passes a pad.
GstPadProbeReturn note_memory(GstPad*, GstPadProbeInfo* info, gpointer data) {
  static_cast<std::vector<GstMemory*>*>(data)->push_back(
      gst_buffer_peek_memory(GST_PAD_PROBE_INFO_BUFFER(info), 0));
  return GST_PAD_PROBE_OK;
}

TEST(Pipeline, MemoryIsUnchangedBehindATee) {
  std::vector<GstMemory*> before;
  std::vector<GstMemory*> behind;
  const auto watch = [&](GstElement* pipeline) {
    GstElement* track = gst_bin_get_by_name(GST_BIN(pipeline), "track");
    const auto probe = [&](const char* name, std::vector<GstMemory*>* memories) {
      GstPad* pad = gst_element_get_static_pad(track, name);
      gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, note_memory, memories, nullptr);
      gst_object_unref(pad);
    };
    probe("sink", &before);
    probe("src", &behind);
    gst_object_unref(track);
  };
  ASSERT_EQ(run_pipeline("ellipsetestsrc num-buffers=20 ! tee name=t t. ! queue ! fakesink "
                         "t. ! queue ! ellipsetrack name=track ! fakesink",
                         watch),
            "");
  EXPECT_EQ(before.size(), 20U);
  EXPECT_EQ(before, behind);
}

TEST(Pipeline, TwoTrackersShareAFrameAfterATee) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_pipeline("ellipsetestsrc num-buffers=20 ! tee name=t "
                         "t. ! queue ! ellipsetrack ! ellipsejson ! filesink location=" +
                         folder.file("a") +
                         " t. ! queue ! ellipsetrack detector=contours tracking=none ! ellipsejson "
                         "! filesink location=" +
                         folder.file("b")),
            "");
  EXPECT_EQ(read_ndjson(folder.file("a")).size(), 20U);
  EXPECT_EQ(read_ndjson(folder.file("b")).size(), 20U);
}

// Runs in a separate process, because the tracer watches a whole process. @return The objects alive
// at its end.
std::string leaks_of(const std::string& tests) {
  const TemporaryFolder folder;
  const std::string log = folder.file("leaks.log");
  const std::string tracer = "GST_TRACERS=leaks GST_DEBUG=GST_TRACER:7 GST_DEBUG_FILE=" + log;
  const std::string output = folder.file("output");
  if (!support::run_own_tests(tracer, tests, output)) {
    return "the tests failed:\n" + support::contents_of(output);
  }
  std::ifstream in(log);
  std::string alive;
  for (std::string line; std::getline(in, line);) {
    if (line.find("object-alive, type-name=(string)Gst") != std::string::npos) alive += line + "\n";
  }
  return alive;
}

TEST(Pipeline, DISABLED_LeavesABuffer) {
  gst_buffer_new();
}

TEST(Pipeline, LeaksNothing) {
  EXPECT_NE(leaks_of("Pipeline.DISABLED_LeavesABuffer"), "");  // the tracer works
  EXPECT_EQ(leaks_of("Pipeline.T*:Pipeline.M*:EllipseTrack.*:EllipseOverlay.*:EllipseJson.*:"
                     "EllipseTestSrc.*:EllipseMeta.*"),
            "");
}

TEST(Pipeline, AirLabFramesGiveTheSameAsTheEvaluation) {
  const char* sources = std::getenv("ELLIPSE_REAL_SOURCES");
  const char* evaluate = std::getenv("ELLIPSE_EVALUATE");
  const std::string folder_name = std::string(sources != nullptr ? sources : "") + "/airlab-mbzirc";
  if (sources == nullptr || evaluate == nullptr || !std::filesystem::exists(folder_name)) {
    GTEST_SKIP() << "the AirLab frames are not here: set ELLIPSE_REAL_SOURCES to the folder of "
                    "airlab-mbzirc";
  }
  const TemporaryFolder folder;
  const std::string expected_file = folder.file("expected.ndjson");
  const std::string command = std::string(evaluate) + " '" + folder_name +
                              "' --methods arcs+edges --frames " + expected_file + " > " +
                              folder.file("tables.txt");
  ASSERT_EQ(support::run_shell(command).status, 0);
  const auto expected = read_ndjson(expected_file);

  std::size_t next = 0;
  while (next < expected.size()) {
    // Consecutive frames named <sequence>/frame<number>.jpg.
    const auto name_of = [&](std::size_t i) {
      return std::string(json_object_get_string_member(object_of(expected[i]), "image"));
    };
    const std::string sequence = name_of(next).substr(0, name_of(next).find('/'));
    const std::size_t first = next;
    while (next < expected.size() && name_of(next).starts_with(sequence + "/")) ++next;
    const int number = std::stoi(name_of(first).substr(name_of(first).find("frame") + 5));
    const std::string found_file = folder.file(sequence);
    ASSERT_EQ(run_pipeline("multifilesrc location=" + folder_name + "/images/" + sequence +
                           "/frame%04d.jpg start-index=" + std::to_string(number) +
                           " stop-index=" + std::to_string(number + int(next - first) - 1) +
                           " caps=image/jpeg,framerate=30/1 ! jpegdec ! videoconvert ! "
                           "video/x-raw,format=GRAY8 ! ellipsetrack ! ellipsejson ! filesink "
                           "location=" +
                           found_file),
              "");
    const auto found = read_ndjson(found_file);
    ASSERT_EQ(found.size(), next - first);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto target = ellipse_on(object_of(found[i]), "target");
      JsonObject* line = object_of(expected[first + i]);
      const bool is_expected = !json_object_get_null_member(line, "target");
      ASSERT_EQ(target.has_value(), is_expected) << name_of(first + i);
      if (!target) continue;
      JsonArray* numbers = json_object_get_array_member(line, "target");
      EXPECT_NEAR(target->cx, json_array_get_double_element(numbers, 0), 1e-3);
      EXPECT_NEAR(target->semi_minor, json_array_get_double_element(numbers, 3), 1e-3);
    }
  }
  EXPECT_EQ(next, expected.size());
}

}  // namespace
