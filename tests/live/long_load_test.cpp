// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Client;
using support::LiveProgram;
using support::SocketClient;
using support::wait_until;

constexpr int kViewers = 50;
constexpr int kStalled = 5;
constexpr int kFrames = 3600;  // two minutes

struct Pace {
  double frames_per_second = 0.0;
  double median_ms = 0.0;  // of an analysis, over the last third of the frames
  double p99_ms = 0.0;
  double skipped = 0.0;
};

// Runs the clients until this number of further frames has been analysed.
Pace run(const Client& client) {
  const double first = client.stat("frames");
  const gint64 start_us = g_get_monotonic_time();
  const gint64 max_us = 10 * 60 * G_USEC_PER_SEC;
  double frames = 0.0;
  while (frames < kFrames && g_get_monotonic_time() - start_us < max_us) {
    wait_until([] { return false; }, 1);
    frames = client.stat("frames") - first;
  }
  const double seconds = 1e-6 * static_cast<double>(g_get_monotonic_time() - start_us);
  const support::Answer answer = client.get("api/stats");
  JsonObject* tracker = json_object_get_object_member(answer.object(), "tracker");
  return {frames / seconds,
          1e-6 * json_object_get_double_member(tracker, "processing_time_median"),
          1e-6 * json_object_get_double_member(tracker, "processing_time_p99"),
          json_object_get_double_member(tracker, "skipped")};
}

TEST(LiveLongLoad, FiftyViewersWithFiveStalledDoNotSlowThePipeline) {
  const LiveProgram program({});
  const Client client(program.url());
  // Real clients run on machines of their own: here they only get the time that the program leaves.
  ASSERT_EQ(setpriority(PRIO_PROCESS, 0, 19), 0);
  const Pace alone = run(client);
  std::vector<std::unique_ptr<SocketClient>> viewers;
  for (int i = 0; i < kViewers; ++i) {
    viewers.push_back(std::make_unique<SocketClient>(program.url(), "ws/video"));
    ASSERT_TRUE(viewers.back()->is_open()) << i;
    if (i >= kStalled) viewers.back()->watch();
  }
  const Pace watched = run(client);
  std::size_t pictures = 0;
  for (const auto& viewer : viewers) pictures += viewer->watched();
  std::printf(
      "alone   %.3f frames/s, median %.3f ms, p99 %.3f ms\n"
      "watched %.3f frames/s, median %.3f ms, p99 %.3f ms, %.2f pictures per frame and viewer\n",
      alone.frames_per_second,
      alone.median_ms,
      alone.p99_ms,
      watched.frames_per_second,
      watched.median_ms,
      watched.p99_ms,
      static_cast<double>(pictures) / (kFrames * (kViewers - kStalled)));
  EXPECT_GT(watched.frames_per_second, 0.95 * alone.frames_per_second);
  EXPECT_EQ(watched.skipped, 0.0);
  EXPECT_GT(pictures, 0U);
}

}  // namespace
