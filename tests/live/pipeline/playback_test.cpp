// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/live_sources.hpp"

namespace {

using support::Answer;
using support::Client;
using support::is_paused;
using support::Line;
using support::LiveProgram;
using support::make_mp4;
using support::make_pictures;
using support::make_video;
using support::number_in;
using support::shown_when_paused;
using support::SocketClient;
using support::stands_still;
using support::TemporaryFolder;
using support::text_in;
using support::wait_until;

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

// With a slow decoder a frame is still in transit at the pause.
TEST(LivePlayback, PausedPlaybackStandsStill) {
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
    // A step requested before the pause took effect is not lost.
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

// Steps until a condition holds; a paused sink does not report the end by itself.
bool steps_until(const Client& client, const std::function<bool()>& is_so) {
  return wait_until([&] {
    if (is_so()) return true;
    EXPECT_EQ(client.post("api/step").status, 200U);
    return false;
  });
}

TEST(LivePlayback, SteppingPastTheEndEndsAFile) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 30)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":900000000})").status, 200U);
  ASSERT_TRUE(steps_until(client, [&] { return text_in(client, "state") == "ended"; }));
  EXPECT_EQ(number_in(client, "pts_ns"), 967'000'000);  // the last frame stays visible
  ASSERT_EQ(client.post("api/step").status, 200U);
  EXPECT_EQ(text_in(client, "state"), "ended");
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":500000000})").status, 200U);
  EXPECT_EQ(shown_when_paused(client), 500'000'000);
  ASSERT_TRUE(steps_until(client, [&] { return text_in(client, "state") == "ended"; }));
  const double frames = client.stat("frames");
  ASSERT_EQ(client.post("api/play").status, 200U);
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  EXPECT_EQ(client.stat("frames"), frames + 30);  // restarted from the beginning
}

TEST(LivePlayback, SeekingPastTheEndShowsTheLastFrame) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 30)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);  // so that it does not end
  for (const char* position : {"1000000000", "90000000000"}) {
    ASSERT_EQ(client.post("api/seek", R"({"position_ns":300000000})").status, 200U);
    ASSERT_EQ(shown_when_paused(client), 300'000'000);
    const std::string body = std::string(R"({"position_ns":)") + position + "}";
    ASSERT_EQ(client.post("api/seek", body).status, 200U);
    EXPECT_GE(shown_when_paused(client), 967'000'000);
    ASSERT_EQ(client.post("api/step").status, 200U);
    EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  }
}

// The sound track is much longer than the video.
TEST(LivePlayback, SeekingPastTheLastFrameEndsPlayback) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_mp4(folder, 10)});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":0})").status, 200U);
  ASSERT_TRUE(stands_still(client));
  ASSERT_EQ(client.post("api/seek", R"({"position_ns":900000000})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
}

TEST(LivePlayback, PlaysAFolderOfOnePictureToItsEnd) {
  const TemporaryFolder folder;
  const std::string pictures = make_pictures(folder, 1);
  const LiveProgram program({"--source", pictures});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  EXPECT_EQ(client.stat("frames"), 1.0);
  const LiveProgram looped({"--source", pictures, "--loop"});
  EXPECT_TRUE(wait_until([&] { return Client(looped.url()).stat("frames") > 5; }));
}

TEST(LivePlayback, SeekingAfterTheEndShowsOneFrame) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 10)});
  const Client client(program.url());
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
    const double frames = client.stat("frames");
    ASSERT_EQ(client.post("api/seek", R"({"position_ns":200000000})").status, 200U);
    EXPECT_EQ(shown_when_paused(client), 200'000'000);
    EXPECT_EQ(client.stat("frames"), frames + 1);
    ASSERT_EQ(client.post("api/play").status, 200U);
  }
}

class LiveExchange : public testing::Test {
 protected:
  [[nodiscard]] guint open_again() const {
    return client_.put("api/source", R"({"spec":")" + source_ + R"("})").status;
  }
  [[nodiscard]] double frames() const { return client_.stat("frames"); }

  const TemporaryFolder folder_;
  const std::string source_ = make_video(folder_, 300);
  const LiveProgram program_{{"--source", source_, "--allow-source-change"}};
  const Client client_{program_.url()};
};

// Pauses again while the sink still waits at its first frame.
TEST_F(LiveExchange, PauseHoldsRightAfterTheFirstFrame) {
  for (int i = 0; i < 40; ++i) {
    const double before = frames();
    ASSERT_EQ(open_again(), 200U);
    ASSERT_TRUE(wait_until([&] { return frames() > before; }));
    ASSERT_EQ(client_.post("api/pause").status, 200U);
    const gint64 shown = shown_when_paused(client_);
    ASSERT_GE(shown, 0) << i;
    g_usleep(100'000);
    ASSERT_EQ(number_in(client_, "pts_ns"), shown) << i;
  }
}

TEST_F(LiveExchange, ReopenedSourcesCanSeekBeforeTheyPlay) {
  for (int i = 0; i < 5; ++i) {
    const double before = frames();
    ASSERT_TRUE(wait_until([&] { return frames() > before + 3; }));
    ASSERT_EQ(open_again(), 200U);
    ASSERT_EQ(client_.post("api/pause").status, 200U);
    ASSERT_TRUE(stands_still(client_));
    const auto seek = [&] {
      return client_.post("api/seek", R"({"position_ns":500000000})").status;
    };
    ASSERT_TRUE(wait_until([&] { return seek() == 200U; }));
    EXPECT_EQ(shown_when_paused(client_), 500'000'000);
    ASSERT_EQ(client_.post("api/play").status, 200U);
  }
}

class LoopedSource : public testing::TestWithParam<const char*> {};

// Two sources, of which only one supports seeking.
TEST_P(LoopedSource, SteppingPastTheEndRestartsAndStaysPaused) {
  const TemporaryFolder folder;
  const std::string source =
      GetParam() == std::string("file")
          ? make_video(folder, 6)
          : "[multifilesrc stop-index=5 caps=image/jpeg,framerate=30/1 location=" +
                make_pictures(folder, 6) + "/flight-%d.jpg ! jpegdec]";
  const LiveProgram program({"--source", source, "--loop"});
  const Client client(program.url());
  ASSERT_TRUE(is_paused(client));
  gint64 shown = number_in(client, "pts_ns");
  EXPECT_EQ(client.get("api/source").body.find(R"("seekable":true)") != std::string::npos,
            GetParam() == std::string("file"));
  int begins = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(client.post("api/step").status, 200U);
    gint64 next = shown;
    ASSERT_TRUE(wait_until([&] { return (next = shown_when_paused(client)) != shown; })) << shown;
    ASSERT_GE(next, 0);
    begins += next < shown ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(next), next < shown ? 0.0 : shown + 1e9 / 30, 1e6);
    shown = next;
  }
  EXPECT_GE(begins, 3);
}

INSTANTIATE_TEST_SUITE_P(LivePlayback,
                         LoopedSource,
                         testing::Values("file", "fragment"),
                         [](const auto& info) { return std::string(info.param); });

INSTANTIATE_TEST_SUITE_P(LivePlayback,
                         SeekableSource,
                         testing::Values("file", "folder"),
                         [](const auto& info) { return std::string(info.param); });

// Browsers show a part of the stream when the next one starts.
void expect_mjpeg_twice(const LiveProgram& program, gint64 pts) {
  const std::string head = "X-PTS: " + std::to_string(pts) + "\r\n";
  const std::string text = support::read_stream(program.url() + "video.mjpeg", head, 2);
  EXPECT_NE(text.find(head), text.rfind(head));
}

// A new client gets the current frame through every interface.
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

TEST(LivePlayback, NewClientsGetTheFrameOfAPausedFile) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 900)});
  const Client client(program.url());
  ASSERT_TRUE(is_paused(client));
  expect_greetings(program, client);
}

TEST(LivePlayback, NewClientsGetTheFrameOfAHeldView) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 10; }));
  expect_greetings(program, client);
}

TEST(LivePlayback, MjpegShowsTheSteppedFrame) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 900)});
  const Client client(program.url());
  ASSERT_TRUE(is_paused(client));
  const gint64 shown = number_in(client, "pts_ns");
  std::string text;
  std::thread watcher(
      [&] { text = support::read_stream(program.url() + "video.mjpeg", "X-PTS: ", 4); });
  EXPECT_TRUE(wait_until([&] { return client.stat("sent") > 0; }));
  EXPECT_EQ(client.post("api/step").status, 200U);
  const gint64 next = shown_when_paused(client);
  watcher.join();
  EXPECT_NEAR(static_cast<double>(next - shown), 1e9 / 30, 1e6);
  const std::string head = "X-PTS: " + std::to_string(next) + "\r\n";
  EXPECT_NE(text.find(head), text.rfind(head)) << head;
}

TEST(LivePlayback, PlaysAnMp4WithSoundToItsEnd) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_mp4(folder, 20)});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  EXPECT_EQ(client.stat("frames"), 20.0);
}

TEST(LivePlayback, LoopRepeatsAFile) {
  const TemporaryFolder folder;
  const LiveProgram program({"--source", make_video(folder, 10), "--loop"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > 35; }));
}

TEST(LivePlayback, LoopEndsWithoutFrames) {
  const LiveProgram program({"--source", "[videotestsrc num-buffers=0]", "--loop"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_TRUE(wait_until([&] { return text_in(client, "state") == "ended"; }));
}

// The last frame may still be in analysis when the first one arrives.
TEST(LivePlayback, LoopRestartsWhileTheLastFrameIsAnalysed) {
  const TemporaryFolder folder;
  const LiveProgram program(
      {"--source", make_video(folder, 3, "width=1920,height=1080"), "--loop"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  EXPECT_TRUE(wait_until([&] {
    EXPECT_EQ(client.post("api/analyze", R"({"stage":"edges"})").status, 200U);
    return client.stat("frames") >= 60;
  }));
}

TEST(LivePlayback, LiveSourcesHoldAndStepTheView) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient lines(program.url(), "ws/meta");
  ASSERT_NE(lines.next(), "");
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 10; }));  // still tracks
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

}  // namespace
