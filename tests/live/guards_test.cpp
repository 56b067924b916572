// SPDX-License-Identifier: MIT
//
// The guards in front of the parsers of libsoup and gst-rtsp-server.
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>

#include "examples/live/http/frame_guard.hpp"
#include "examples/live/outputs/rtsp_guard.hpp"

namespace {

using live::FrameGuard;
using live::RtspGuard;

std::int64_t now_us = 0;

std::int64_t clock_us() {
  return now_us;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// A frame as a client sends it: masked, with the shortest encoding of its length.
std::string frame(int opcode, std::size_t size, bool is_last = true) {
  std::string text(1, static_cast<char>(opcode | (is_last ? 0x80 : 0)));
  if (size < 126) {
    text += static_cast<char>(0x80 | size);
  } else if (size < 65536) {
    text += static_cast<char>(0x80 | 126);
    for (int shift : {8, 0}) text += static_cast<char>(size >> shift & 0xff);
  } else {
    text += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8) text += static_cast<char>(size >> shift & 0xff);
  }
  return text + "mask" + std::string(std::min<std::size_t>(size, 4096), 'a');
}

constexpr int kContinuation = 0;
constexpr int kText = 1;
constexpr int kPing = 9;

TEST(LiveFrameGuard, MessagesPassInPiecesOfAnySize) {
  FrameGuard guard(clock_us);
  const std::string text = frame(kText, 30) + frame(kText, 1024) + frame(kText, 500, false) +
                           frame(kPing, 100) + frame(kContinuation, 524) + frame(kText, 0);
  for (const std::size_t size : {text.size(), std::size_t{1}, std::size_t{7}}) {
    for (std::size_t at = 0; at < text.size(); at += size) {
      ASSERT_TRUE(guard.take(bytes_of(text.substr(at, size)))) << at << " by " << size;
    }
  }
}

TEST(LiveFrameGuard, MessagesAreLimitedOverAllFragments) {
  EXPECT_FALSE(FrameGuard(clock_us).take(bytes_of(frame(kText, 1025))));
  EXPECT_FALSE(FrameGuard(clock_us).take(bytes_of(frame(kText, 70'000))));
  FrameGuard guard(clock_us);
  EXPECT_TRUE(guard.take(bytes_of(frame(kText, 1000, false))));
  EXPECT_TRUE(guard.take(bytes_of(frame(kContinuation, 24, false))));
  EXPECT_FALSE(guard.take(bytes_of(frame(kContinuation, 1, false))));
}

// Fragments, and pings with a lower limit.
TEST(LiveFrameGuard, FrameRateIsLimited) {
  now_us = 1'000'000;
  FrameGuard guard(clock_us);
  const auto taken = [&](int opcode) {
    int count = 0;
    while (count < 2000 && guard.take(bytes_of(frame(opcode, 0, false)))) ++count;
    return count;
  };
  EXPECT_EQ(taken(kContinuation), 500);
  EXPECT_EQ(taken(kPing), 20);
  now_us += 1'000'000;
  EXPECT_NEAR(taken(kContinuation), 250, 1);
  EXPECT_NEAR(taken(kPing), 1, 1);
}

std::string request(const std::string& method, const std::string& headers = "") {
  return method + " rtsp://robot:8554/live RTSP/1.0\r\nCSeq: 1\r\n" + headers + "\r\n";
}

TEST(LiveRtspGuard, RequestsAndPacketsPassInPiecesOfAnySize) {
  RtspGuard guard(clock_us);
  const std::string packet = std::string("$\x01\x00\x05", 4) + "a\r\nb$";
  const std::string text = request("OPTIONS") + packet + "\r\n" +
                           request("GET_PARAMETER", "Session: 1\r\n folded\r\n") +
                           std::string("$\x00\x00\x00", 4) + request("TEARDOWN");
  for (const std::size_t size : {text.size(), std::size_t{1}, std::size_t{7}}) {
    now_us += 10'000'000;
    for (std::size_t at = 0; at < text.size(); at += size) {
      ASSERT_TRUE(guard.take(bytes_of(text.substr(at, size)))) << at << " by " << size;
    }
  }
}

TEST(LiveRtspGuard, HeadersAreLimitedInSizeAndForm) {
  const auto passes = [](const std::string& text) {
    return RtspGuard(clock_us).take(bytes_of(text));
  };
  EXPECT_TRUE(passes(request("DESCRIBE", "User-Agent: " + std::string(8000, 'a') + "\r\n")));
  EXPECT_FALSE(passes(request("DESCRIBE", "User-Agent: " + std::string(8192, 'a') + "\r\n")));
  std::string many;
  for (int i = 0; i < 2000; ++i) many += "a:b\r\n";
  EXPECT_FALSE(passes(request("DESCRIBE", many)));
  EXPECT_FALSE(passes("GET /live HTTP/1.0\r\n\r\n"));
  EXPECT_FALSE(passes("POST /live HTTP/1.0\r\n\r\n"));
  // GStreamer would find the end of a request or of a line elsewhere.
  EXPECT_FALSE(passes("OPTIONS * RTSP/1.0\n\n"));
  EXPECT_FALSE(passes("OPTIONS * RTSP/1.0\r\r"));
  EXPECT_FALSE(passes(std::string("OPTIONS * RTSP/1.0\r\n\0a", 22)));
}

TEST(LiveRtspGuard, RequestRateIsLimited) {
  now_us = 1'000'000;
  RtspGuard guard(clock_us);
  const auto taken = [&] {
    int count = 0;
    while (count < 2000 && guard.take(bytes_of(request("OPTIONS")))) ++count;
    return count;
  };
  EXPECT_EQ(taken(), 100);
  now_us += 1'000'000;
  EXPECT_NEAR(taken(), 50, 1);
}

}  // namespace
