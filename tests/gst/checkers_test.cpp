// SPDX-License-Identifier: MIT
//
// Runs valgrind, gst-validate and ThreadSanitizer on the elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/gst/own_tests.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::contents_of;
using support::Owned;
using support::Pipeline;
using support::run_own_tests;
using support::TemporaryFolder;

bool is_installed(const char* program) {
  gchar* path = g_find_program_in_path(program);
  g_free(path);
  return path != nullptr;
}

TEST(Valgrind, DISABLED_LeavesABlock) {
  volatile int* block = new int[100];
  EXPECT_NE(block[7], 12345);  // never initialised
  block = nullptr;
}

TEST(Valgrind, DISABLED_ShortPipelines) {
  constexpr GstClockTime kUnderValgrind = 300 * GST_SECOND;
  for (const char* settings : {"overlay=ellipse+axes+centre+roi+label candidates=true",
                               "detector=contours tracking=redetect"}) {
    EXPECT_EQ(support::run_pipeline(
                  "ellipsetestsrc num-buffers=8 ! video/x-raw,format=I420,width=160,height=120 ! "
                  "ellipsetrack " +
                      std::string(settings) + " ! ellipseoverlay ! ellipsejson ! fakesink",
                  {},
                  kUnderValgrind),
              "");
  }
}

TEST(Valgrind, FindsNothing) {
  if (!is_installed("valgrind")) GTEST_SKIP() << "valgrind is not installed";
#if ELLIPSE_SANITIZER
  GTEST_SKIP() << "valgrind does not run programs with a sanitizer";
#endif
  const TemporaryFolder folder;
  const std::string log = folder.file("log");
  const std::string memcheck =
      "G_SLICE=always-malloc valgrind -q --error-exitcode=9 --leak-check=full "
      "--show-leak-kinds=definite --errors-for-leak-kinds=definite --num-callers=25 "
      "--suppressions=" ELLIPSE_TESTS "/valgrind.supp";
  EXPECT_FALSE(run_own_tests(memcheck, "Valgrind.DISABLED_LeavesABlock", log));  // finds it
  EXPECT_NE(contents_of(log).find("definitely lost"), std::string::npos) << contents_of(log);
  EXPECT_NE(contents_of(log).find("uninitialised"), std::string::npos) << contents_of(log);
  EXPECT_TRUE(run_own_tests(memcheck, "Valgrind.DISABLED_ShortPipelines", log)) << contents_of(log);
}

#if ELLIPSE_SANITIZER_IS_THREAD
// Two threads increment one number, with GLib's mutex or without.
int count_in_two_threads(GMutex* mutex) {
  int count = 0;
  const auto add = [&] {
    for (int i = 0; i < 1000; ++i) {
      if (mutex != nullptr) g_mutex_lock(mutex);
      ++count;
      if (mutex != nullptr) g_mutex_unlock(mutex);
    }
  };
  std::thread other(add);
  add();
  other.join();
  return count;
}

TEST(ThreadSanitizer, DISABLED_CountsUnderAMutex) {
  GMutex mutex;
  g_mutex_init(&mutex);
  EXPECT_EQ(count_in_two_threads(&mutex), 2000);
  g_mutex_clear(&mutex);
}

TEST(ThreadSanitizer, DISABLED_CountsWithoutAMutex) {
  EXPECT_GT(count_in_two_threads(nullptr), 0);
}

TEST(ThreadSanitizer, KnowsGLibsMutexes) {
  const TemporaryFolder folder;
  const std::string log = folder.file("log");
  EXPECT_TRUE(run_own_tests("", "ThreadSanitizer.DISABLED_CountsUnderAMutex", log))
      << contents_of(log);
  EXPECT_FALSE(run_own_tests("", "ThreadSanitizer.DISABLED_CountsWithoutAMutex", log));
  EXPECT_NE(contents_of(log).find("data race"), std::string::npos) << contents_of(log);
}

TEST(ThreadSanitizer, DISABLED_HandsOverThroughAQueue) {
  GAsyncQueue* queue = g_async_queue_new();
  int number = 0;
  std::thread other([&] {
    number = 7;
    g_async_queue_push(queue, &number);
  });
  EXPECT_EQ(*static_cast<int*>(g_async_queue_pop(queue)), 7);
  other.join();
  g_async_queue_unref(queue);
}

TEST(ThreadSanitizer, KnowsGLibsQueues) {
  const TemporaryFolder folder;
  const std::string log = folder.file("log");
  EXPECT_TRUE(run_own_tests("", "ThreadSanitizer.DISABLED_HandsOverThroughAQueue", log))
      << contents_of(log);
}
#endif

std::vector<std::string> scenarios() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(ELLIPSE_TESTS "/validate")) {
    if (entry.path().extension() == ".validatetest") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The structures of a scenario: one per line, except the first, "meta", which spans several.
std::vector<std::string> structures_of(const std::string& file) {
  std::vector<std::string> structures;
  std::ifstream in(file);
  bool is_open = false;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (is_open) {
      structures.back() += line;
    } else {
      structures.push_back(line);
    }
    is_open = line.back() == ',' || line.back() == '{';
  }
  return structures;
}

class Scenario : public testing::TestWithParam<std::string> {};

TEST_P(Scenario, IsWellFormedAndItsPipelineRuns) {
  const std::vector<std::string> structures = structures_of(GetParam());
  ASSERT_FALSE(structures.empty());
  ASSERT_TRUE(structures.front().starts_with("meta,"));
  const auto first = structures.front().find('"') + 1;
  const auto last = structures.front().find('"', first);
  std::string pipeline = structures.front().substr(first, last - first);
  const auto clock = pipeline.find("sync=true");
  ASSERT_NE(clock, std::string::npos);
  EXPECT_EQ(support::run_pipeline(pipeline.replace(clock, 9, "sync=false")), "");
  for (std::size_t i = 1; i < structures.size(); ++i) {
    const Owned<GstStructure> action(gst_structure_from_string(structures[i].c_str(), nullptr));
    EXPECT_TRUE(action) << structures[i];
  }
}

TEST_P(Scenario, HoldsForGstValidate) {
  if (!is_installed("gst-validate-1.0")) GTEST_SKIP() << "gst-validate-1.0 is not installed";
  const std::string command = "gst-validate-1.0 --set-test-file '" + GetParam() + "'";
  EXPECT_EQ(support::run_shell(command).status, 0);
}

INSTANTIATE_TEST_SUITE_P(Files,
                         Scenario,
                         testing::ValuesIn(scenarios()),
                         [](const testing::TestParamInfo<std::string>& info) {
                           return std::filesystem::path(info.param).stem().string();
                         });

}  // namespace
