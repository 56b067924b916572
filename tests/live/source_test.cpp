// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "examples/live/source_spec.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/live_sources.hpp"

namespace {

namespace fs = std::filesystem;
using support::Client;
using support::LiveProgram;
using support::make_pictures;
using support::make_video;
using support::TemporaryFolder;
using support::text_in;
using support::wait_until;

std::string trouble_with(const std::string& source) {
  try {
    (void)live::parse_source(source);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
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

TEST(LiveSource, OfOneThatFailsAfterAFewFramesTheErrorStays) {
  const LiveProgram program({"--source", "[ellipsetestsrc ! identity error-after=5]"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "failed"; }));
  EXPECT_EQ(client.stat("frames"), 4.0);
  g_usleep(1'500'000);  // it looks each second whether frames have come
  EXPECT_NE(text_in(client, "error"), "");
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

TEST(LiveSource, WhatIsHeldAfterAnExchangeIsOfTheNewOne) {
  const LiveProgram program({"--allow-source-change"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  const char* other = R"({"spec":"[videotestsrc is-live=true ! video/x-raw,width=128,height=96]"})";
  ASSERT_EQ(client.put("api/source", other).status, 200U);
  ASSERT_EQ(client.post("api/pause").status, 200U);
  EXPECT_TRUE(wait_until([&] { return support::number_in(client, "width") == 128; }));
  EXPECT_EQ(text_in(client, "state"), "held");
}

TEST(LiveSource, ACameraHasTimeForItsFirstFrame) {
  const LiveProgram program(
      {"--source",
       "[videotestsrc is-live=true ! video/x-raw,width=64,height=48 ! queue max-size-buffers=0 "
       "max-size-bytes=0 max-size-time=0 min-threshold-time=7000000000]"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
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
  EXPECT_TRUE(wait_until([&] { return !text_in(client, "error").empty(); }));
  const double frames = client.stat("frames");
  // Another program may have the port for a moment.
  ASSERT_TRUE(wait_until([&] {
    camera = std::make_unique<LiveProgram>(std::vector<std::string>{"--rtsp", port});
    return !camera->url().empty();
  }));
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > frames + 5; }));
  EXPECT_TRUE(wait_until([&] { return text_in(client, "error").empty(); }));
}

}  // namespace
