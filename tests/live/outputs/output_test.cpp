// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "examples/evaluate/dataset.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Answer;
using support::Client;
using support::Line;
using support::LiveProgram;
using support::TemporaryFolder;
using support::wait_until;

int count_frames(const std::string& description) {
  int frames = 0;
  const auto count = [](GstPad*, GstPadProbeInfo*, gpointer data) {
    ++*static_cast<int*>(data);
    return GST_PAD_PROBE_OK;
  };
  const std::string failure = support::run_pipeline(description, [&](GstElement* pipeline) {
    const support::Owned<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline), "end"));
    GstPad* pad = gst_element_get_static_pad(sink.get(), "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, count, &frames, nullptr);
    gst_object_unref(pad);
  });
  EXPECT_EQ(failure, "") << description;
  return frames;
}

// Number of pixels in the overlay's colour; the scenes themselves are grey.
int green_pixels(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  int count = 0;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    const auto channel = [&](std::size_t c) { return static_cast<unsigned char>(bytes[i + c]); };
    count += channel(1) > 150 && channel(0) < 110 && channel(2) < 110 ? 1 : 0;
  }
  return count;
}

class Transport : public testing::TestWithParam<const char*> {};

TEST_P(Transport, RtspIncludesTheOverlay) {
  const TemporaryFolder folder;
  LiveProgram program({"--rtsp", "0"});
  const std::string address = LiveProgram::address_in(program.line_with("rtsp://"));
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
  // The latency allows for late packets on a busy machine.
  EXPECT_EQ(count_frames("rtspsrc location=" + address + " latency=2000 protocols=" + GetParam() +
                         " ! rtph264depay ! avdec_h264 ! identity eos-after=31 ! videoconvert ! "
                         "video/x-raw,format=RGB,width=640,height=360 ! multifilesink name=end "
                         "location=" +
                         folder.file("frame-%d.rgb")),
            30);
  int max_green = 0;
  for (int i = 0; i < 30; ++i) {
    const std::string file = folder.file("frame-" + std::to_string(i) + ".rgb");
    max_green = std::max(max_green, green_pixels(file));
  }
  EXPECT_GT(max_green, 100);
}

INSTANTIATE_TEST_SUITE_P(LiveOutput,
                         Transport,
                         testing::Values("tcp", "udp"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LiveOutput, RtspRequiresTheToken) {
  LiveProgram program({"--rtsp", "0", "--token", "sesame"});
  const std::string address = LiveProgram::address_in(program.line_with("rtsp://"));
  ASSERT_TRUE(address.starts_with("rtsp://ellipse:sesame@"));
  const std::string bare = "rtsp://" + address.substr(address.find('@') + 1);
  const std::string rest = " protocols=tcp ! rtph264depay ! identity eos-after=3 ! fakesink";
  EXPECT_EQ(support::run_pipeline("rtspsrc location=" + address + rest), "");
  EXPECT_NE(support::run_pipeline("rtspsrc location=" + bare + rest), "");
}

class EndOfRecording : public testing::TestWithParam<int> {};

// SIGHUP is sent when the terminal closes, as at a lost ssh connection.
TEST_P(EndOfRecording, LeavesACompleteFileWithItsLines) {
  const TemporaryFolder folder;
  LiveProgram program({"--record", folder.file("flight.mkv")});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 40; }));
  EXPECT_EQ(program.stop(GetParam()), 0);
  const int frames = count_frames("filesrc location=" + folder.file("flight.mkv") +
                                  " ! matroskademux ! avdec_h264 ! fakesink name=end");
  gint64 first = -1;
  gint64 last = -1;
  std::ifstream in(folder.file("flight.ndjson"));
  for (std::string text; std::getline(in, text);) {
    const Line line(text);
    ASSERT_TRUE(line.is_valid()) << text;
    const gint64 frame = line.number("frame");
    if (last >= 0) {
      EXPECT_EQ(frame, last + 1);
    }
    if (first < 0) first = frame;
    last = frame;
  }
  EXPECT_GE(last, 40);
  // A busy machine drops pictures instead of waiting for its encoder.
  EXPECT_GT(frames, 0);
  EXPECT_LE(frames, last - first + 1);
}

INSTANTIATE_TEST_SUITE_P(LiveOutput,
                         EndOfRecording,
                         testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& info) { return std::string(sigabbrev_np(info.param)); });

TEST(LiveOutput, RecordingContinuesInANewFileAfterASizeChange) {
  const TemporaryFolder folder;
  LiveProgram program({"--record", folder.file("flight.mkv"), "--allow-source-change"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 10; }));
  ASSERT_EQ(
      client
          .put("api/source",
               R"({"spec":"[ellipsetestsrc is-live=true ! video/x-raw,width=320,height=240]"})")
          .status,
      200U);
  // The first file is closed before the second one is opened; frames in between are in neither.
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(folder.file("flight-2.ndjson")); }));
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 40; }));
  EXPECT_EQ(program.stop(), 0);
  EXPECT_GE(support::read_ndjson(folder.file("flight-2.ndjson")).size(), 40U);
  // A busy machine drops pictures instead of waiting for its encoder.
  EXPECT_GT(count_frames("filesrc location=" + folder.file("flight-2.mkv") +
                         " ! matroskademux ! avdec_h264 ! video/x-raw,width=320 ! fakesink "
                         "name=end"),
            0);
}

TEST(LiveOutput, UnwritableRecordingsAreReportedAtTheStart) {
  LiveProgram program({"--record", "/nowhere/flight.mkv"}, false);
  EXPECT_NE(program.line_with("/nowhere/flight.mkv"), "");
  EXPECT_EQ(program.wait(), 1);
}

// Index of the target among the ellipses of the current frame, which include the test source's
// truth. Steps to a frame with a target.
int number_of_target(const LiveProgram& program, const Client& client) {
  for (int i = 0; i < 100; ++i) {
    support::SocketClient lines(program.url(), "ws/meta");
    const Line line(lines.next());
    const int number = line.is_valid() ? line.index_of("target") : -1;
    if (number >= 0) return number;
    EXPECT_EQ(client.post("api/step").status, 200U);
    EXPECT_TRUE(wait_until([&] {
      return json_object_get_int_member(client.get("api/source").object(), "pts_ns") !=
             line.number("pts_ns");
    }));
  }
  return -1;
}

TEST(LiveOutput, SnapshotsMakeADataSet) {
  const TemporaryFolder folder;
  const LiveProgram program({"--labels", folder.file("labels")});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.get("api/target").object() != nullptr; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const int target = number_of_target(program, client);
  ASSERT_GE(target, 0);
  const std::string choice = R"({"choice":)";
  ASSERT_EQ(client.post("api/snapshot", choice + std::to_string(target) + "}").status, 200U);
  ASSERT_EQ(client.post("api/snapshot", R"({"choice":"none"})").status, 200U);
  ASSERT_EQ(client
                .post("api/snapshot",
                      R"({"choice":{"cx":10,"cy":20,"semi_major":9,"semi_minor":8,"angle_rad":1}})")
                .status,
            200U);
  for (const char* wrong :
       {R"({"choice":9})",
        R"({"choice":"all"})",
        R"({"choice":null})",
        R"({"choice":[1]})",
        R"({"choice":{"cx":10}})",
        R"({})",
        R"({"choice":{"cx":1,"cy":2,"semi_major":3,"semi_minor":4,"angle_rad":0}})"}) {
    EXPECT_EQ(client.post("api/snapshot", wrong).status, 400U) << wrong;
  }
  for (const std::string field : {"cx", "cy", "semi_major", "semi_minor", "angle_rad"}) {
    std::string body = R"({"choice":{"cx":1,"cy":2,"semi_major":4,"semi_minor":3,"angle_rad":0}})";
    body.insert(body.find(field) + field.size() + 2, "1e999,\"was\":");
    const Answer answer = client.post("api/snapshot", body);
    EXPECT_EQ(answer.status, 400U) << body;
    EXPECT_NE(answer.body.find(field), std::string::npos) << answer.body;
  }
  EXPECT_EQ(client.post("api/snapshot", R"({"choice":"none","pts_ns":1})").status, 409U);
  const evaluate::Dataset dataset = evaluate::read_dataset(folder.file("labels"));
  EXPECT_TRUE(dataset.problems.empty());
  ASSERT_EQ(dataset.sequences.size(), 1U);
  const auto& frames = dataset.sequences[0].frames;
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_GT(frames[0].truth.target.value().semi_major, 20.0);
  EXPECT_FALSE(frames[1].truth.target.has_value());
  EXPECT_EQ(frames[2].truth.target.value().semi_minor, 8.0);
  EXPECT_EQ(dataset.sequences[0].pictures->picture(frames[0]).cols, 640);
}

// Nanoseconds since 1970 are not exact as doubles.
TEST(LiveOutput, LabelsMatchTheFrameForLargeTimestamps) {
  const TemporaryFolder folder;
  const LiveProgram program({"--labels",
                             folder.file("labels"),
                             "--source",
                             "[videotestsrc timestamp-offset=1700000000123456789]"});
  const Client client(program.url());
  // The sink shows the first frame, then waits for years.
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 0; }));
  const gint64 pts = json_object_get_int_member(client.get("api/source").object(), "pts_ns");
  ASSERT_GT(pts, 1'700'000'000'000'000'000);
  const auto label = [&](const std::string& time) {
    std::string body = R"({"choice":"none","pts_ns":)";
    return client.post("api/snapshot", body.append(time).append("}")).status;
  };
  EXPECT_EQ(label("\"" + std::to_string(pts) + "\""), 200U);
  EXPECT_EQ(label(std::to_string(pts)), 200U);
  EXPECT_EQ(label(std::to_string(pts + 1)), 409U);
  EXPECT_EQ(label("\"now\""), 400U);
  EXPECT_EQ(label("\"-1\""), 400U);
}

TEST(LiveOutput, SnapshotsRequireAFolder) {
  const LiveProgram program({});
  EXPECT_EQ(Client(program.url()).post("api/snapshot", R"({"choice":"none"})").status, 409U);
}

}  // namespace
