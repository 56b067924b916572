// SPDX-License-Identifier: MIT
//
// Settings that change while the picture is paused.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/live_sources.hpp"

namespace {

using support::Client;
using support::Line;
using support::LiveProgram;
using support::SocketClient;
using support::TemporaryFolder;
using support::wait_until;

void set(const Client& client, const std::string& body) {
  ASSERT_EQ(client.put("api/properties", body).status, 200U) << body;
}

class StandingPicture : public testing::TestWithParam<const char*> {
 protected:
  std::string source() {
    return GetParam() == std::string("file") ? support::make_video(folder_, 300) : "test:orbit";
  }

  TemporaryFolder folder_;
};

// Waits for a target, then pauses.
bool stands_at_target(const Client& client) {
  return wait_until([&] { return client.get("api/target").object() != nullptr; }) &&
         client.post("api/pause").status == 200U && wait_until([&] {
           const std::string state = support::text_in(client, "state");
           return state == "paused" || state == "held";
         });
}

// The body that labels the target by its index among the frame's ellipses.
std::string label_of(const Line& line) {
  return R"({"choice":)" + std::to_string(line.index_of("target")) + "}";
}

TEST_P(StandingPicture, IsReanalysedAfterASettingChange) {
  const LiveProgram program({"--source", source(), "--labels", folder_.file("labels")});
  const Client client(program.url());
  ASSERT_TRUE(stands_at_target(client));
  SocketClient lines(program.url(), "ws/meta");
  const Line before(lines.next());
  ASSERT_NE(before.ellipse("target"), nullptr);
  set(client, R"({"min-axis":690})");
  const Line without(lines.next());
  EXPECT_EQ(without.number("pts_ns"), before.number("pts_ns"));
  EXPECT_EQ(without.number("frame"), before.number("frame"));
  EXPECT_EQ(without.ellipse("target"), nullptr);
  EXPECT_EQ(without.ellipse("truth") != nullptr, before.ellipse("truth") != nullptr);
  EXPECT_EQ(client.post("api/snapshot", label_of(before)).status, 400U);  // no longer there
  set(client, R"({"min-axis":5})");
  const Line with(lines.next());
  EXPECT_EQ(with.number("pts_ns"), before.number("pts_ns"));
  ASSERT_NE(with.ellipse("target"), nullptr);
  const auto cx = [](const Line& line) {
    return json_object_get_double_member(line.ellipse("target"), "cx");
  };
  EXPECT_NEAR(cx(with), cx(before), 2.0);
  EXPECT_EQ(client.post("api/snapshot", label_of(with)).status, 200U);
  ASSERT_EQ(client.post("api/play").status, 200U);
  const Line next(lines.next());
  EXPECT_GT(next.number("frame"), before.number("frame"));
}

TEST_P(StandingPicture, IsRedrawnAfterAnOverlayChange) {
  const LiveProgram program({"--source", source()});
  const Client client(program.url());
  ASSERT_TRUE(stands_at_target(client));
  SocketClient video(program.url(), "ws/video");
  const auto next = [&] {
    const std::string picture = video.next();
    video.acknowledge(picture);
    return picture;
  };
  const std::string plain = next();
  set(client, R"({"overlay":"ellipse+axes"})");
  const std::string drawn = next();
  EXPECT_EQ(SocketClient::pts_of(drawn), SocketClient::pts_of(plain));
  EXPECT_NE(drawn, plain);
  set(client, R"({"overlay":"none"})");
  EXPECT_EQ(next(), plain);
}

// Like a slider. The final picture has the last settings.
TEST_P(StandingPicture, ShowsTheResultOfTheLastSetting) {
  const LiveProgram program({"--source", source()});
  const Client client(program.url());
  ASSERT_TRUE(stands_at_target(client));
  SocketClient lines(program.url(), "ws/meta");
  const std::string first = lines.next();
  for (int i = 0; i < 20; ++i) {
    set(client, R"({"min-axis":)" + std::to_string(i % 2 == 0 ? 5 : 690) + "}");
  }
  std::string last = first;
  while (true) {
    const std::string line = lines.next(3);
    if (line.empty()) break;
    last = line;
  }
  EXPECT_EQ(Line(last).number("pts_ns"), Line(first).number("pts_ns"));
  EXPECT_EQ(Line(last).ellipse("target"), nullptr);
}

INSTANTIATE_TEST_SUITE_P(LiveReview,
                         StandingPicture,
                         testing::Values("file", "live"),
                         [](const auto& info) { return std::string(info.param); });

// Tracking continues if no setting changes.
TEST(LiveReview, UnchangedSettingsCauseNoAnalysis) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  ASSERT_TRUE(stands_at_target(client));
  SocketClient lines(program.url(), "ws/meta");
  ASSERT_NE(lines.next(), "");
  set(client, R"({"min-axis":5,"detector":"arcs","overlay":"none","roi":[0,0,0,0],"roi-type":""})");
  EXPECT_EQ(lines.next(3), "");
}

TEST(LiveReview, PresetsReanalyseTheStandingPicture) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  ASSERT_TRUE(stands_at_target(client));
  SocketClient lines(program.url(), "ws/meta");
  const gint64 pts = Line(lines.next()).number("pts_ns");
  ASSERT_EQ(client.post("api/presets/Keipour%202021/load").status, 200U);
  EXPECT_EQ(Line(lines.next()).number("pts_ns"), pts);
}

}  // namespace
