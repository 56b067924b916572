// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "examples/live/source_spec.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

namespace fs = std::filesystem;
using support::Answer;
using support::Client;
using support::Line;
using support::LiveProgram;
using support::SocketClient;
using support::TemporaryFolder;
using support::wait_until;

std::string make_video(const TemporaryFolder& folder, int frames) {
  const std::string file = folder.file("video.mkv");
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                                  " ! video/x-raw,format=I420,width=320,height=180 ! jpegenc ! "
                                  "matroskamux ! filesink location=" +
                                  file),
            "");
  return file;
}

std::string make_pictures(const TemporaryFolder& folder, int frames) {
  const std::string pictures = folder.file("pictures");
  fs::create_directory(pictures);
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                                  " ! video/x-raw,format=I420,width=320,height=180 ! jpegenc ! "
                                  "multifilesink location=" +
                                  pictures + "/flight-%d.jpg"),
            "");
  std::ofstream(pictures + "/notes.txt") << "no picture";
  return pictures;
}

// As cameras and telephones write it: H.264 with sound.
std::string make_mp4(const TemporaryFolder& folder, int frames) {
  const std::string file = folder.file("video.mp4");
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                                  " ! video/x-raw,width=320,height=180 ! videoconvert ! x264enc ! "
                                  "mp4mux name=mux ! filesink location=" +
                                  file +
                                  " audiotestsrc num-buffers=40 ! audioconvert ! avenc_aac ! mux."),
            "");
  return file;
}

std::string trouble_with(const std::string& source) {
  try {
    (void)live::parse_source(source);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string text_in(const Client& client, const char* member) {
  return json_object_get_string_member(client.get("api/source").object(), member);
}

gint64 number_in(const Client& client, const char* member) {
  return json_object_get_int_member(client.get("api/source").object(), member);
}

TEST(LiveSource, WhatIsWrongIsSaid) {
  const TemporaryFolder folder;
  EXPECT_NE(trouble_with("test:moon").find("there are approach, oblique"), std::string::npos);
  EXPECT_NE(trouble_with(folder.file("none.mkv")).find("no such file"), std::string::npos);
  EXPECT_NE(trouble_with("/dev/video77").find("no such camera"), std::string::npos);
  EXPECT_NE(trouble_with("gopher://there/is").find("gopher"), std::string::npos);
  EXPECT_NE(trouble_with(fs::path(folder.file("")).parent_path()).find("no .png and no .jpg"),
            std::string::npos);
  EXPECT_NE(trouble_with("[videotestsrc ! nonsense]").find("nonsense"), std::string::npos);
  EXPECT_NE(trouble_with("[videotestsrc !").find("no such file"), std::string::npos);
  EXPECT_NE(trouble_with("").find("empty"), std::string::npos);
}

TEST(LiveSource, EachKindIsUnderstood) {
  const TemporaryFolder folder;
  const auto kind = [](const std::string& source) { return live::parse_source(source).kind; };
  EXPECT_EQ(kind("test:dusk"), live::SourceKind::kTest);
  EXPECT_EQ(kind(make_video(folder, 1)), live::SourceKind::kFile);
  EXPECT_EQ(kind(make_pictures(folder, 1)), live::SourceKind::kFolder);
  EXPECT_EQ(kind("[videotestsrc ! videoconvert]"), live::SourceKind::kFragment);
  EXPECT_EQ(kind("rtsp://127.0.0.1/live"), live::SourceKind::kUri);
  EXPECT_TRUE(live::parse_source("rtsp://127.0.0.1/live").is_live);
  EXPECT_FALSE(live::parse_source("file:///video.mkv").is_live);
}

TEST(LiveSource, AFileThatIsNoVideoEndsTheProgramWithItsName) {
  const TemporaryFolder folder;
  const std::string file = folder.file("letter.mkv");
  std::ofstream(file) << "Dear robot,\n";
  LiveProgram program({"--source", file}, false);
  EXPECT_NE(program.line_with("letter.mkv"), "");
  EXPECT_EQ(program.wait(), 1);
  LiveProgram other({"--source", folder.file("none")}, false);
  EXPECT_NE(other.line_with("no such file"), "");
  EXPECT_EQ(other.wait(), 1);
}

// The frame that is shown once it is paused; -1 where that does not come to be.
gint64 shown_when_paused(const Client& client) {
  Answer answer;
  const bool is_paused = wait_until([&] {
    answer = client.get("api/source");
    return json_object_get_string_member(answer.object(), "state") == std::string("paused");
  });
  return is_paused ? json_object_get_int_member(answer.object(), "pts_ns") : -1;
}

bool stands_still(const Client& client) {
  return shown_when_paused(client) >= 0;
}

class SeekableSource : public testing::TestWithParam<const char*> {};

TEST_P(SeekableSource, PausesStepsAndSeeksToTheFrame) {
  const TemporaryFolder folder;
  const std::string source =
      GetParam() == std::string("file") ? make_video(folder, 900) : make_pictures(folder, 900);
  const LiveProgram program({"--source", source});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/step").status, 409U);
  ASSERT_EQ(client.post("api/pause").status, 200U);
  ASSERT_TRUE(stands_still(client));
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":1000000000})").status, 200U);
  const auto shows = [&](int frame) {
    return wait_until(
        [&] { return std::abs(number_in(client, "pts_ns") - frame * 33'333'333LL) < 1'000'000; });
  };
  ASSERT_TRUE(shows(30)) << number_in(client, "pts_ns");
  for (int frame = 31; frame < 34; ++frame) {
    ASSERT_EQ(client.post("api/step").status, 200U);
    ASSERT_TRUE(shows(frame)) << number_in(client, "pts_ns");
  }
  EXPECT_EQ(client.post("api/seek", R"({"position_ns":-1})").status, 400U);
  EXPECT_EQ(client.post("api/seek", "{}").status, 400U);
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":29000000000})").status, 200U);
  ASSERT_TRUE(shows(870)) << number_in(client, "pts_ns");
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_EQ(text_in(client, "state"), "playing");
}

// A slow decoder: when it is paused, a frame is still under way.
TEST(LiveSource, WhatIsPausedStandsStill) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source",
                             "[filesrc location=" + make_video(folder, 300) +
                                 " ! matroskademux ! jpegdec ! identity sleep-time=100000]"});
  const Client client(program.url());
  for (int i = 0; i < 5; ++i) {
    const double frames = client.stat("frames");
    ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames; }));
    ASSERT_EQ(client.post("api/pause").status, 200U);
    const gint64 shown = shown_when_paused(client);
    g_usleep(200'000);
    EXPECT_EQ(number_in(client, "pts_ns"), shown);
    // A step that was asked for before it stood still is not lost.
    ASSERT_EQ(client.post("api/play").status, 200U);
    ASSERT_EQ(client.post("api/pause").status, 200U);
    ASSERT_EQ(client.post("api/step").status, 200U);
    ASSERT_EQ(client.post("api/step").status, 200U);
    const gint64 stepped = shown_when_paused(client);
    EXPECT_GE(stepped - shown, 2 * 33'000'000);
    g_usleep(200'000);
    EXPECT_EQ(number_in(client, "pts_ns"), stepped);
    ASSERT_EQ(client.post("api/play").status, 200U);
  }
}

TEST(LiveSource, AFileThatIsSteppedToItsEndCanBePlayedOn) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 300)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":9900000000})").status, 200U);
  for (int i = 0; i < 6; ++i) ASSERT_EQ(client.post("api/step").status, 200U);
  EXPECT_TRUE(wait_until([&] { return number_in(client, "pts_ns") > 9'960'000'000; }));
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
}

INSTANTIATE_TEST_SUITE_P(LiveSource,
                         SeekableSource,
                         testing::Values("file", "folder"),
                         [](const auto& info) { return std::string(info.param); });

// Browsers show a picture when the next one begins.
void expect_mjpeg_twice(const LiveProgram& program, gint64 pts) {
  const std::string head = "X-PTS: " + std::to_string(pts) + "\r\n";
  const std::string text = support::read_stream(program.url() + "video.mjpeg", head, 2);
  EXPECT_NE(text.find(head), text.rfind(head));
}

// Whoever joins gets the very frame that is shown, by each way that there is.
void expect_greetings(const LiveProgram& program, const Client& client) {
  const gint64 shown = number_in(client, "pts_ns");
  SocketClient video(program.url(), "ws/video");
  EXPECT_EQ(SocketClient::pts_of(video.next()), static_cast<guint64>(shown));
  SocketClient lines(program.url(), "ws/meta");
  EXPECT_EQ(Line(lines.next()).number("pts_ns"), shown);
  const std::string pts = std::to_string(shown);
  const std::string events = support::read_stream(program.url() + "api/events", "\n\n", 2);
  EXPECT_NE(events.find("\"pts_ns\":" + pts + ","), std::string::npos) << events;
  expect_mjpeg_twice(program, shown);
  EXPECT_EQ(lines.waiting(), 0U);
}

TEST(LiveSource, WhoJoinsWhileAFileIsPausedGetsItsFrameAtOnce) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 900)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  ASSERT_TRUE(stands_still(client));
  expect_greetings(program, client);
}

TEST(LiveSource, WhoJoinsWhileTheViewIsHeldGetsItsFrameAtOnce) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 10; }));
  expect_greetings(program, client);
}

TEST(LiveSource, AWatcherByMjpegSeesTheFrameThatWasSteppedTo) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 900)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  ASSERT_TRUE(stands_still(client));
  const gint64 shown = number_in(client, "pts_ns");
  std::string text;
  std::thread watcher(
      [&] { text = support::read_stream(program.url() + "video.mjpeg", "X-PTS: ", 4); });
  EXPECT_TRUE(wait_until([&] { return client.stat("sent") > 0; }));
  EXPECT_EQ(client.post("api/step").status, 200U);
  ASSERT_TRUE(stands_still(client));
  const gint64 next = number_in(client, "pts_ns");
  EXPECT_NEAR(static_cast<double>(next - shown), 1e9 / 30, 1e6);
  watcher.join();
  const std::string head = "X-PTS: " + std::to_string(next) + "\r\n";
  EXPECT_NE(text.find(head), text.rfind(head)) << head;
}

TEST(LiveSource, AnMp4WithSoundIsPlayedToItsEnd) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_mp4(folder, 20)});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  EXPECT_EQ(client.stat("frames"), 20.0);
}

TEST(LiveSource, AFileIsPlayedAgainWhereAsked) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 10), "--loop"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > 35; }));
}

TEST(LiveSource, OfALiveSourceTheViewIsHeldAndStepped) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient lines(program.url(), "ws/meta");
  ASSERT_NE(lines.next(), "");
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 10; }));  // it tracks on
  while (lines.waiting() > 0) (void)lines.next();
  const gint64 held = number_in(client, "pts_ns");
  ASSERT_EQ(client.post("api/step").status, 200U);
  const Line line(lines.next());
  EXPECT_GT(line.number("pts_ns"), held);
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 30; }));
  EXPECT_EQ(lines.waiting(), 0U);
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_NE(lines.next(), "");
}

TEST(LiveSource, IsChangedOverHttpOnlyWhereAllowed) {
  const LiveProgram closed({});
  EXPECT_EQ(Client(closed.url()).put("api/source", R"({"spec":"test:dusk"})").status, 403U);
  const LiveProgram open({"--allow-source-change"});
  const Client client(open.url());
  ASSERT_EQ(client.put("api/properties", R"({"max-axis":444})").status, 200U);
  EXPECT_EQ(client.put("api/source", R"({"spec":"test:moon"})").status, 400U);
  EXPECT_EQ(client.put("api/source", R"({"spec":"[videotestsrc is-live=true]"})").status, 200U);
  EXPECT_EQ(text_in(client, "kind"), "fragment");
  const double frames = client.stat("frames");
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > frames + 5; }));
  EXPECT_NE(client.get("api/launch-line").body.find("max-axis=444"), std::string::npos);
}

TEST(LiveSource, ACameraHasTimeForItsFirstFrame) {
  const LiveProgram program(
      {"--source",
       "[videotestsrc is-live=true ! video/x-raw,width=64,height=48 ! queue max-size-buffers=0 "
       "max-size-bytes=0 max-size-time=0 min-threshold-time=7000000000]"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > 5; }, 40));
  EXPECT_EQ(client.stat("reconnections"), 0.0);
}

// Also: what is served by RTSP can be read.
TEST(LiveSource, ComesBackAfterItDropped) {
  auto camera = std::make_unique<LiveProgram>(std::vector<std::string>{"--rtsp", "0"});
  const std::string address = LiveProgram::address_in(camera->line_with("rtsp://"));
  const std::string port =
      address.substr(address.rfind(':') + 1, address.rfind('/') - address.rfind(':') - 1);
  const LiveProgram program({"--source", address});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
  camera.reset();
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "reconnecting"; }));
  EXPECT_NE(text_in(client, "error"), "");
  const double frames = client.stat("frames");
  // Another program may have the port for a moment.
  ASSERT_TRUE(wait_until([&] {
    camera = std::make_unique<LiveProgram>(std::vector<std::string>{"--rtsp", port});
    return !camera->url().empty();
  }));
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > frames + 5; }, 40));
  EXPECT_TRUE(wait_until([&] { return text_in(client, "error").empty(); }));
}

}  // namespace
