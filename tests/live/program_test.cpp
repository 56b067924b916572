// SPDX-License-Identifier: MIT
//
// The program under test must not outlive the tests.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "tests/gst/own_tests.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Client;
using support::LiveProgram;

TEST(LiveProgram, DISABLED_IsKilledWhileItRuns) {
  const LiveProgram program({});
  std::ofstream(std::getenv("ELLIPSE_URL_FILE")) << program.url() << std::endl;
  std::raise(SIGKILL);
}

TEST(LiveProgram, ExitsWithItsParent) {
  const support::TemporaryFolder folder;
  const std::string file = folder.file("url");
  EXPECT_FALSE(support::run_own_tests(
      "ELLIPSE_URL_FILE=" + file, "LiveProgram.DISABLED_*", folder.file("output")));
  std::string url;
  std::ifstream(file) >> url;
  ASSERT_NE(url, "");
  EXPECT_TRUE(support::wait_until(
      [&] { return Client(url).get("api/target").status == SOUP_STATUS_NONE; }));
}

}  // namespace
