// SPDX-License-Identifier: MIT
//
// Resources that a client cannot take from others: memory, connections, time.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/raw_client.hpp"

namespace {

using support::Answer;
using support::Client;
using support::LiveProgram;
using support::RawClient;
using support::SocketClient;
using support::wait_until;

std::string get(const std::string& path) {
  return "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

TEST(LiveLimits, RejectsTooLargeRequestsAndMessages) {
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
  EXPECT_TRUE(wait_until(
      [&] {
        for (int i = 0; i < 100 && talker.is_open(); ++i) talker.send("{}");
        return !talker.is_open();
      },
      60));
  EXPECT_EQ(client.get("api/target").status, 200U);
}

// Sends a body of 50 MB regardless of the answer. @return The answer.
std::string send_body(const LiveProgram& program, bool is_chunked, const std::string& path) {
  constexpr int kPieces = 800;
  const std::string piece(65536, 'a');
  const RawClient client(program.port());
  std::string head = "PUT ";
  head += path + " HTTP/1.1\r\nHost: localhost\r\n";
  head += is_chunked ? "Transfer-Encoding: chunked\r\n\r\n"
                     : "Content-Length: " + std::to_string(kPieces * piece.size()) + "\r\n\r\n";
  client.send(head);
  for (int i = 0; i < kPieces; ++i) {
    if (!client.send(is_chunked ? "10000\r\n" + piece + "\r\n" : piece)) break;
  }
  if (is_chunked) client.send("0\r\n\r\n");
  return client.receive();
}

TEST(LiveLimits, KeepsNothingOfRejectedBodies) {
  if (!support::kHasPlainMemory) GTEST_SKIP() << "a sanitizer has a memory of its own";
  const LiveProgram program({"--token", "sesame"});
  const Client client(program.url().substr(0, program.url().find('?')));
  const auto frames = [&] {
    const Answer stats = client.ask("GET", "api/stats", "", {{"Authorization", "Bearer sesame"}});
    return json_object_get_int_member(stats.object(), "frames");
  };
  ASSERT_TRUE(wait_until([&] { return frames() > 30; }));
  const long before_kib = program.memory_kib("VmHWM");
  EXPECT_NE(send_body(program, false, "/api/properties").find(" 401 "), std::string::npos);
  EXPECT_NE(send_body(program, true, "/api/properties").find(" 401 "), std::string::npos);
  EXPECT_NE(send_body(program, false, "/?token=sesame").find(" 303 "), std::string::npos);
  EXPECT_LT(program.memory_kib("VmHWM"), before_kib + 10 * 1024);
}

// Sends all requests before reading an answer, so that the client delays nothing.
bool is_stopped_at_once(const LiveProgram& program, int requests) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < requests; ++i) {
    clients.push_back(std::make_unique<RawClient>(program.port()));
    clients.back()->send(get("/api/target"));
  }
  bool is_stopped = false;
  for (const auto& each : clients) {
    is_stopped |= each->receive().find(" 429 ") != std::string::npos;
  }
  return is_stopped;
}

TEST(LiveLimits, LimitsTheRequestRate) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitized program answers too slowly to be asked too often";
#endif
  const LiveProgram program({});
  bool is_stopped = false;
  for (int i = 0; i < 20 && !is_stopped; ++i) is_stopped = is_stopped_at_once(program, 150);
  EXPECT_TRUE(is_stopped);
  EXPECT_EQ(Client(program.url()).get("api/target").status, 200U);
}

TEST(LiveLimits, LimitsTheNumberOfConnections) {
  const LiveProgram program({});
  const Client client(program.url());
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 200; ++i) idle.push_back(std::make_unique<RawClient>(program.port()));
  EXPECT_EQ(client.get("api/target").status, static_cast<guint>(SOUP_STATUS_NONE));
  idle.clear();
  EXPECT_TRUE(wait_until([&] { return client.get("metrics").status == 200; }));
  const std::string metrics = client.get("metrics").body;
  const std::string name = "\nellipse_requests_refused_total ";
  ASSERT_NE(metrics.find(name), std::string::npos);
  EXPECT_GE(std::stod(metrics.substr(metrics.find(name) + name.size())), 41.0);
}

// A still picture causes no writes, so that no failed write reveals a client that left.
TEST(LiveLimits, ReleasesClientsThatLeaveWhilePaused) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  {
    std::vector<std::unique_ptr<RawClient>> watching;
    for (int i = 0; i < 60; ++i) {
      watching.push_back(std::make_unique<RawClient>(program.port()));
      watching.back()->send(get(i % 2 == 0 ? "/api/events" : "/video.mjpeg"));
      ASSERT_NE(watching.back()->receive(), "");
    }
    EXPECT_EQ(client.stat("viewers") + client.stat("listeners"), 60.0);
  }
  EXPECT_TRUE(wait_until([&] { return client.stat("viewers") + client.stat("listeners") == 0.0; }));
}

TEST(LiveLimits, ReservesConnectionsForRequests) {
  const LiveProgram program({});
  const Client client(program.url());
  std::vector<std::unique_ptr<RawClient>> watching;
  int rejected = 0;
  for (int i = 0; i < 140; ++i) {
    watching.push_back(std::make_unique<RawClient>(program.port()));
    watching.back()->send(get("/api/events"));
    rejected += watching.back()->receive().find(" 503 ") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(rejected, 20);
  EXPECT_EQ(client.get("api/target").status, 200U);
  SocketClient video(program.url(), "ws/video");
  EXPECT_TRUE(wait_until([&] { return !video.is_open(); }));
}

// A client that sends a byte now and then is never idle and never finishes.
TEST(LiveLimits, DropsUnfinishedRequests) {
  const LiveProgram program({});
  const Client client(program.url());
  const std::string rest = "PUT /api/properties HTTP/1.1\r\nHost: localhost\r\nContent-Length: 500";
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 40; ++i) {
    slow.push_back(std::make_unique<RawClient>(program.port()));
    slow.back()->send(i % 2 == 0 ? rest : rest + "\r\n\r\n");  // in the headers, in the body
  }
  ASSERT_TRUE(wait_until([&] { return client.stat("connections") > 40.0; }));
  const bool is_freed = wait_until(
      [&] {
        for (const auto& each : slow) each->send("1");
        g_usleep(1'000'000);
        return client.stat("connections") < 5.0;
      },
      60);
  EXPECT_TRUE(is_freed);
}

// A viewer of lines need not send anything; this one does not even answer pings.
TEST(LiveLimits, KeepsSilentWebSockets) {
  const LiveProgram program({});
  const RawClient viewer(program.port());
  ASSERT_TRUE(
      viewer.send("GET /ws/meta HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
                  "Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                  "Sec-WebSocket-Version: 13\r\n\r\n"));
  const gint64 begin = g_get_monotonic_time();
  while (g_get_monotonic_time() - begin < 25 * G_USEC_PER_SEC) ASSERT_NE(viewer.receive(), "");
}

TEST(LiveLimits, LimitsConnectionsPerNetworkAddress) {
  const std::string address = support::network_address();
  if (address.empty()) GTEST_SKIP() << "this machine is in no network";
  const LiveProgram program({"--bind", "0.0.0.0", "--token", "sesame"});
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 60; ++i) {
    idle.push_back(std::make_unique<RawClient>(address, program.port()));
  }
  const Client client("http://127.0.0.1:" + std::to_string(program.port()) + "/");
  const auto connections = [&] {
    const Answer stats = client.ask("GET", "api/stats", "", {{"Authorization", "Bearer sesame"}});
    return stats.status == 200U ? json_object_get_int_member(stats.object(), "connections") : 0;
  };
  EXPECT_EQ(connections(), 41);
}

}  // namespace
