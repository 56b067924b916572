// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Client;
using support::LiveProgram;
using support::SocketClient;
using support::wait_until;

double tracker_stat(const Client& client, const char* name) {
  const support::Answer answer = client.get("api/stats");
  return json_object_get_double_member(json_object_get_object_member(answer.object(), "tracker"),
                                       name);
}

// With viewers that never read, the pipeline still analyses each frame, and other viewers get
// theirs.
TEST(LiveLoad, StalledViewersDelayNobody) {
  const LiveProgram program({});
  const Client client(program.url());
  std::vector<std::unique_ptr<SocketClient>> stalled;
  for (int i = 0; i < 4; ++i) {
    stalled.push_back(std::make_unique<SocketClient>(program.url(), "ws/video"));
  }
  std::vector<std::unique_ptr<SocketClient>> watching;
  for (int i = 0; i < 6; ++i) {
    watching.push_back(std::make_unique<SocketClient>(program.url(), "ws/video"));
    watching.back()->watch();
  }
  EXPECT_TRUE(wait_until(
      [&] {
        for (const auto& each : watching) {
          if (each->watched() < 60) return false;
        }
        return true;
      },
      60));
  EXPECT_EQ(tracker_stat(client, "skipped"), 0.0);
  for (const auto& each : stalled) EXPECT_LE(each->waiting(), 2U);
  EXPECT_EQ(client.stat("viewers"), 10.0);
}

}  // namespace
