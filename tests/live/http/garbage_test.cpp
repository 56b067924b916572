// SPDX-License-Identifier: MIT
//
// Malformed input.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>
#include <string>

#include "tests/gst/loopback.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Client;
using support::LiveProgram;
using support::Socket;
using support::wait_until;

std::string garbage(std::mt19937& random) {
  static const char* const kStarts[] = {"GET / HTTP/1.1\r\n",
                                        "PUT /api/properties HTTP/1.1\r\nHost: 127.0.0.1\r\n",
                                        "POST /api/seek HTTP/1.1\r\nContent-Length: -5\r\n",
                                        ("GET /ws/video HTTP/1.1\r\nHost: localhost\r\nUpgrade: "
                                         "websocket\r\nConnection: Upgrade\r\n"
                                         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                                         "Sec-WebSocket-Version: 13\r\n\r\n"),
                                        "GET /%zz HTTP/9.9\r\n",
                                        "\r\n\r\n",
                                        "OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        "GET http://[::1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        "CONNECT localhost:1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                        ("POST /api/analyze HTTP/1.1\r\nHost: localhost\r\n"
                                         "Transfer-Encoding: chunked\r\n\r\nffffffff\r\n")};
  std::string text = kStarts[random() % std::size(kStarts)];
  const std::size_t size = random() % 300;
  for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(random() % 256);
  if (random() % 2 == 0) text += "\r\n\r\n";
  return text;
}

void send_garbage(const LiveProgram& program, std::mt19937& random, int times) {
  for (int i = 0; i < times; ++i) {
    Socket socket(G_SOCKET_TYPE_STREAM);
    socket.connect(program.port());
    socket.send(garbage(random));
  }
}

// Minimum growth over the rounds: the number of open connections, and with it the allocator's
// memory, varies from round to round, while a leak grows in each.
TEST(LiveGarbage, ThousandsOfMalformedRequestsDoNoHarm) {
  LiveProgram program({});
  const Client client(program.url());
  std::mt19937 random(7);
  long min_growth_kib = std::numeric_limits<long>::max();
  long before = 0;
  for (int round = 0; round < 5; ++round) {
    send_garbage(program, random, 1000);
    ASSERT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }));
    const long now = program.memory_kib("VmRSS");
    if (round > 0) min_growth_kib = std::min(min_growth_kib, now - before);
    before = now;
  }
  if (support::kHasPlainMemory) {
    EXPECT_LT(min_growth_kib, 256) << "in a round of 1000 requests";
  }
  EXPECT_EQ(program.stop(), 0);
}

// Frames of every kind, masked or not, complete or not, after a valid handshake.
TEST(LiveGarbage, MalformedWebSocketFramesDoNoHarm) {
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
  EXPECT_TRUE(wait_until([&] { return client.get("api/target").status == 200; }));
  EXPECT_TRUE(wait_until([&] { return client.stat("viewers") == 0; }));
  EXPECT_EQ(program.stop(), 0);
}

}  // namespace
