// SPDX-License-Identifier: MIT
#include "examples/live/security.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "tests/gst/loopback.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Answer;
using support::Client;
using support::LiveProgram;
using support::Socket;
using support::SocketClient;
using support::wait_until;

TEST(LiveSecurity, KnowsTheLoopback) {
  EXPECT_TRUE(live::is_loopback_address("127.0.0.1"));
  EXPECT_TRUE(live::is_loopback_address("::1"));
  EXPECT_FALSE(live::is_loopback_address("0.0.0.0"));
  EXPECT_FALSE(live::is_loopback_address("localhost.evil.example"));
  EXPECT_TRUE(live::is_loopback_host("localhost:8080"));
  EXPECT_TRUE(live::is_loopback_host("[::1]:8080"));
  EXPECT_TRUE(live::is_loopback_host("127.0.0.1"));
  EXPECT_FALSE(live::is_loopback_host("rebound.example:8080"));
  EXPECT_FALSE(live::is_loopback_host(""));
}

TEST(LiveSecurity, TokensAreLongAndComparedWhole) {
  const std::string token = live::make_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, live::make_token());
  EXPECT_TRUE(live::is_same_secret(token, token));
  EXPECT_FALSE(live::is_same_secret(token.substr(1), token));
  EXPECT_FALSE(live::is_same_secret(token + "0", token));
  EXPECT_FALSE(live::is_same_secret("", token));
}

TEST(LiveSecurity, AnAllowanceRunsOutAndComesBack) {
  live::Allowance allowance(1000.0, 3.0);
  EXPECT_TRUE(allowance.take() && allowance.take() && allowance.take());
  live::Allowance slow(1e-6, 1.0);
  EXPECT_TRUE(slow.take());
  EXPECT_FALSE(slow.take());
  EXPECT_TRUE(wait_until([&] { return allowance.take(); }));
}

TEST(LiveSecurity, PagesOfOtherSitesAreKeptOut) {
  const LiveProgram program({});
  const Client client(program.url());
  const std::string own = program.url().substr(0, program.url().size() - 1);
  const auto put = [&](const Client::Headers& headers) {
    return client.ask("PUT", "api/properties", R"({"max-axis":600})", headers).status;
  };
  EXPECT_EQ(put({{"Origin", own}}), 200U);
  EXPECT_EQ(put({{"Origin", "http://evil.example"}}), 403U);
  EXPECT_EQ(put({{"Origin", "null"}}), 403U);
  EXPECT_EQ(put({{"Sec-Fetch-Site", "cross-site"}}), 403U);
  EXPECT_EQ(client.ask("GET", "video.mjpeg", "", {{"Sec-Fetch-Site", "cross-site"}}).status, 403U);
  EXPECT_EQ(client.ask("GET", "api/target", "", {{"Host", "rebound.example"}}).status, 403U);
  EXPECT_TRUE(SocketClient(program.url(), "ws/meta", own).is_open());
  EXPECT_FALSE(SocketClient(program.url(), "ws/meta", "http://evil.example").is_open());
  EXPECT_FALSE(SocketClient(program.url(), "ws/video", "http://evil.example").is_open());
}

TEST(LiveSecurity, TheTokenIsAskedForEverywhere) {
  LiveProgram program({"--token", "sesame"});
  ASSERT_TRUE(program.url().ends_with("/?token=sesame"));
  const std::string url = program.url().substr(0, program.url().find('?'));
  const Client client(url);
  for (const char* path : {"", "api/target", "api/events", "video.mjpeg", "metrics", "nothing"}) {
    EXPECT_EQ(client.get(path).status, 401U) << path;
  }
  EXPECT_FALSE(SocketClient(url, "ws/video").is_open());
  EXPECT_FALSE(SocketClient(url, "ws/meta", "", "sesam").is_open());
  EXPECT_TRUE(SocketClient(url, "ws/meta", "", "sesame").is_open());
  const auto with = [&](const std::string& name, const std::string& value) {
    return client.ask("GET", "api/stats", "", {{name, value}}).status;
  };
  EXPECT_EQ(with("Authorization", "Bearer sesame"), 200U);
  EXPECT_EQ(with("Authorization", "Bearer sesame2"), 401U);
  EXPECT_EQ(with("Cookie", "a=b; ellipse_token=sesame; c=d"), 200U);
  EXPECT_EQ(with("Cookie", "not_ellipse_token=sesame"), 401U);
  const Answer link = client.get("?token=sesame");
  EXPECT_EQ(link.status, 303U);
  EXPECT_NE(link.headers.at("Set-Cookie").find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(client.get("?token=sesam").status, 401U);
}

TEST(LiveSecurity, WhatIsTooLargeIsRefused) {
  const LiveProgram program({});
  const Client client(program.url());
  EXPECT_EQ(client.put("api/properties", std::string(70'000, ' ')).status, 413U);
  EXPECT_EQ(client.get("api/" + std::string(2000, 'a')).status, 414U);
  EXPECT_EQ(client.ask("GET", "api/target", "", {{"X-Large", std::string(20'000, 'a')}}).status,
            431U);
  SocketClient video(program.url(), "ws/video");
  ASSERT_NE(video.next(), "");
  video.send(std::string(5000, ' '));
  EXPECT_TRUE(wait_until([&] { return !video.is_open(); }));
  SocketClient talker(program.url(), "ws/meta");
  for (int i = 0; i < 2000 && talker.is_open(); ++i) talker.send("{}");
  EXPECT_TRUE(wait_until([&] { return !talker.is_open(); }));
  EXPECT_EQ(client.get("api/target").status, 200U);
}

TEST(LiveSecurity, WhoAsksTooOftenHasToWait) {
  const LiveProgram program({});
  const Client client(program.url());
  bool is_stopped = false;
  for (int i = 0; i < 3000 && !is_stopped; ++i) is_stopped = client.get("api/target").status == 429;
  EXPECT_TRUE(is_stopped);
  EXPECT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }));
}

TEST(LiveSecurity, ConnectionsAreCounted) {
  const LiveProgram program({});
  std::vector<std::unique_ptr<Socket>> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(std::make_unique<Socket>(G_SOCKET_TYPE_STREAM));
    idle.back()->connect(program.port());
  }
  idle.clear();
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.get("metrics").status == 200; }));
  EXPECT_NE(client.get("metrics").body.find("ellipse_requests_refused_total"), std::string::npos);
}

std::string garbage(std::mt19937& random) {
  static const char* const kStarts[] = {"GET / HTTP/1.1\r\n",
                                        "PUT /api/properties HTTP/1.1\r\nHost: 127.0.0.1\r\n",
                                        "POST /api/seek HTTP/1.1\r\nContent-Length: -5\r\n",
                                        "GET /ws/video HTTP/1.1\r\nHost: localhost\r\nUpgrade: "
                                        "websocket\r\nConnection: Upgrade\r\n"
                                        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                                        "Sec-WebSocket-Version: 13\r\n\r\n",
                                        "GET /%zz HTTP/9.9\r\n",
                                        "\r\n\r\n",
                                        "OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        "GET http://[::1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        "CONNECT localhost:1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        "POST /api/analyze HTTP/1.1\r\nHost: localhost\r\n"
                                        "Transfer-Encoding: chunked\r\n\r\nffffffff\r\n"};
  std::string text = kStarts[random() % std::size(kStarts)];
  const std::size_t size = random() % 300;
  for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(random() % 256);
  if (random() % 2 == 0) text += "\r\n\r\n";
  return text;
}

long resident_kib(const LiveProgram& program) {
  std::ifstream in("/proc/" + program.id() + "/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  }
  return 0;
}

void send_garbage(const LiveProgram& program, std::mt19937& random, int times) {
  for (int i = 0; i < times; ++i) {
    Socket socket(G_SOCKET_TYPE_STREAM);
    socket.connect(program.port());
    socket.send(garbage(random));
  }
}

TEST(LiveSecurity, MalformedRequestsByTheThousandDoNoHarm) {
  LiveProgram program({});
  const Client client(program.url());
  std::mt19937 random(7);
  send_garbage(program, random, 200);
  ASSERT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }, 40));
  const long before = resident_kib(program);
  send_garbage(program, random, 1000);
  ASSERT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }, 40));
  EXPECT_LT(resident_kib(program) - before, 4096);
  EXPECT_EQ(program.stop(), 0);
}

// Frames of every kind, masked or not, whole or not, behind a proper handshake.
TEST(LiveSecurity, MalformedWebSocketFramesDoNoHarm) {
  LiveProgram program({});
  const Client client(program.url());
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    Socket socket(G_SOCKET_TYPE_STREAM);
    socket.connect(program.port());
    socket.send(
        "GET /ws/video HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: "
        "13\r\n\r\n");
    std::string frame;
    frame += static_cast<char>(random() % 256);
    frame += static_cast<char>(random() % 256);
    for (std::size_t n = random() % 40; n > 0; --n) frame += static_cast<char>(random() % 256);
    socket.send(frame);
  }
  EXPECT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }, 60));
  EXPECT_TRUE(wait_until([&] { return client.stat("viewers") == 0; }, 60));
  EXPECT_EQ(program.stop(), 0);
}

}  // namespace
