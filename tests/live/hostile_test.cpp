// SPDX-License-Identifier: MIT
//
// Clients that try to exhaust the program's memory, and clients that stay idle.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/raw_client.hpp"

namespace {

using support::Client;
using support::LiveProgram;
using support::RawClient;
using support::wait_until;

constexpr long kGrowthKib = 10 * 1024;
constexpr std::size_t kMuch = 64 * 1024 * 1024;

/// A program with an RTSP output that requires a password.
class RtspProgram {
 public:
  RtspProgram() : program_({"--rtsp", "0", "--token", "sesame"}) {
    const std::string address = LiveProgram::address_in(program_.line_with("rtsp://"));
    port_ = std::stoi(address.substr(address.rfind(':') + 1));
    Client client(program_.url().substr(0, program_.url().find('?')));
    EXPECT_TRUE(wait_until([&] {
      const auto stats = client.ask("GET", "api/stats", "", {{"Authorization", "Bearer sesame"}});
      return stats.object() != nullptr && json_object_get_int_member(stats.object(), "frames") > 30;
    }));
  }
  [[nodiscard]] const LiveProgram& program() const { return program_; }
  [[nodiscard]] int port() const { return port_; }
  /// The answer to a valid request.
  [[nodiscard]] std::string describe(const std::string& headers = "") const {
    const RawClient client(port_);
    client.send("DESCRIBE rtsp://127.0.0.1/live RTSP/1.0\r\nCSeq: 1\r\n" + headers + "\r\n");
    return client.receive();
  }

 private:
  LiveProgram program_;
  int port_ = 0;
};

// @return Whether the other side stops reading before everything is sent.
bool is_cut_off(const RawClient& client, const std::string& piece) {
  for (std::size_t sent = 0; sent < kMuch; sent += piece.size()) {
    if (!client.send(piece)) return true;
  }
  return false;
}

void expect_no_growth(const LiveProgram& program, long before_kib) {
  if (!support::kHasPlainMemory) return;
  EXPECT_LT(program.memory_kib("VmHWM"), before_kib + kGrowthKib);
}

TEST(LiveHostile, RejectsLargeRtspBodies) {
  const RtspProgram rtsp;
  const long before_kib = rtsp.program().memory_kib("VmHWM");
  const RawClient client(rtsp.port());
  client.send(
      "OPTIONS rtsp://127.0.0.1/live RTSP/1.0\r\nCSeq: 1\r\nContent-Length: 1500000000\r\n"
      "\r\n");
  EXPECT_TRUE(is_cut_off(client, std::string(65536, 'a')));
  expect_no_growth(rtsp.program(), before_kib);
  EXPECT_NE(rtsp.describe().find(" 401 "), std::string::npos);
}

TEST(LiveHostile, RejectsEndlessRtspHeaders) {
  const RtspProgram rtsp;
  const long before_kib = rtsp.program().memory_kib("VmHWM");
  const RawClient client(rtsp.port());
  client.send("OPTIONS rtsp://127.0.0.1/live RTSP/1.0\r\nCSeq: 1\r\n");
  std::string headers;
  while (headers.size() < 65536) headers += "a:b\r\n";
  EXPECT_TRUE(is_cut_off(client, headers));
  expect_no_growth(rtsp.program(), before_kib);
  EXPECT_NE(rtsp.describe().find(" 401 "), std::string::npos);
}

// The clients neither send requests nor know the password; one sends a byte now and then.
TEST(LiveHostile, LimitsRtspConnectionsAndDropsIdleOnes) {
  const RtspProgram rtsp;
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 40; ++i) idle.push_back(std::make_unique<RawClient>(rtsp.port()));
  EXPECT_TRUE(RawClient(rtsp.port()).is_ended());  // one too many
  EXPECT_TRUE(wait_until([&] {
    idle.front()->send("a");
    g_usleep(500'000);
    return !idle.front()->send("a");
  }));
  for (const auto& each : idle) ASSERT_TRUE(each->is_ended());
  EXPECT_NE(rtsp.describe().find(" 401 "), std::string::npos);
}

TEST(LiveHostile, RtspAcceptsTheAuthSchemeInAnyCase) {
  const RtspProgram rtsp;
  const live::Ref<gchar> secret(
      g_base64_encode(reinterpret_cast<const guchar*>("ellipse:sesame"), 14));
  for (const std::string scheme : {"Basic ", "basic ", "BASIC "}) {
    const std::string header = "Authorization: " + scheme + secret.get() + "\r\n";
    // The server may answer 503 while it tears down the previous client's media.
    EXPECT_TRUE(wait_until([&] {
      return rtsp.describe(header).find(" 200 ") != std::string::npos;
    })) << scheme;
  }
}

/// A raw WebSocket connection for lines.
std::unique_ptr<RawClient> raw_websocket(const LiveProgram& program, int buffer = 0) {
  auto client = std::make_unique<RawClient>(program.port(), buffer);
  client->send(
      "GET /ws/meta HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Version: 13\r\n\r\n");
  EXPECT_NE(client->receive().find(" 101 "), std::string::npos);
  return client;
}

// A fragment of a text message, 1000 bytes: the first, or a continuation.
std::string fragment(bool is_first) {
  const std::string head = is_first ? "\x01" : std::string(1, '\0');
  return head + "\xfe\x03\xe8mask" + std::string(1000, 'a');
}

TEST(LiveHostile, RejectsMessagesOfEndlessFragments) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 30; }));
  const long before_kib = program.memory_kib("VmHWM");
  const auto socket = raw_websocket(program);
  socket->send(fragment(true));
  EXPECT_TRUE(is_cut_off(*socket, fragment(false)));
  expect_no_growth(program, before_kib);
  EXPECT_TRUE(wait_until([&] { return client.stat("listeners") == 0.0; }));
}

// Every ping calls for an answer, and this client reads none.
TEST(LiveHostile, CutsOffEndlessPings) {
  const LiveProgram program({"--source", "[videotestsrc num-buffers=1 ! imagefreeze]"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 0; }));
  const long before_kib = program.memory_kib("VmHWM");
  const auto socket = raw_websocket(program);
  std::string pings;
  for (int i = 0; i < 500; ++i) pings += "\x89\xfdmask" + std::string(125, 'a');
  EXPECT_TRUE(is_cut_off(*socket, pings));
  expect_no_growth(program, before_kib);
  EXPECT_TRUE(wait_until([&] { return client.stat("listeners") == 0.0; }));
}

TEST(LiveHostile, IgnoresRanges) {
  g_setenv("G_DEBUG", "fatal-criticals", TRUE);
  const LiveProgram program({});
  g_unsetenv("G_DEBUG");
  const Client client(program.url());
  const std::string page = client.get("").body;
  ASSERT_GT(page.size(), 1000U);
  std::string ranges = "bytes=0-";
  while (ranges.size() < 15'000) ranges += ",0-";
  for (const std::string& range : {ranges,
                                   std::string("bytes=-99999999999"),
                                   std::string("bytes=5-9"),
                                   std::string("bytes=9-5,a")}) {
    const auto answer = client.ask("GET", "", "", {{"Range", range}});
    EXPECT_EQ(answer.status, 200U) << range.substr(0, 30);
    EXPECT_EQ(answer.body, page) << range.substr(0, 30);
  }
}

// Setting long texts repeatedly must not accumulate memory.
TEST(LiveHostile, KeepsNoRegionTypes) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 30; }));
  const auto set = [&](int times) {
    for (int i = 0; i < times; ++i) {
      std::string type = std::to_string(i) + "-" + std::to_string(times);
      type.resize(60'000, 'a');
      ASSERT_EQ(client.put("api/properties", R"({"roi-type":")" + type + "\"}").status, 200U);
    }
  };
  set(50);
  const long before_kib = program.memory_kib("VmRSS");
  set(400);
  if (support::kHasPlainMemory) {
    EXPECT_LT(program.memory_kib("VmRSS"), before_kib + kGrowthKib);
  }
}

// Like a viewer that acknowledges nothing.
TEST(LiveHostile, DropsClientsThatReadNoEvents) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_EQ(client.put("api/properties", R"({"candidates":true})").status, 200U);
  constexpr int kBuffer = 4096;  // full soon, even if the program is slow
  std::vector<std::unique_ptr<RawClient>> silent;
  for (const char* path : {"/api/events", "/video.mjpeg"}) {
    silent.push_back(std::make_unique<RawClient>(program.port(), kBuffer));
    silent.back()->send(std::string("GET ") + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  silent.push_back(raw_websocket(program, kBuffer));
  const auto present = [&] { return client.stat("listeners") + client.stat("viewers"); };
  ASSERT_TRUE(wait_until([&] { return present() == 3.0; }));
  EXPECT_TRUE(wait_until([&] { return present() == 0.0; }, 120)) << present();
}

}  // namespace
