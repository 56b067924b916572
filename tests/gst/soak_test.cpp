// SPDX-License-Identifier: MIT
//
// Hours of video in small frames: memory must not grow.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/catalog.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::BusTap;
using support::caps_of;
using support::GrayPicture;
using support::Owned;

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr int kWindows = 5;
constexpr std::int64_t kGrowthKiB = 64;  // 32 bytes lost per frame are three times that

std::int64_t resident_kib() {
  std::ifstream in("/proc/self/statm");
  std::int64_t size = 0;
  std::int64_t resident = 0;
  in >> size >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

// Minimum growth over the windows after the first: a leak grows in each, an allocator's cache does
// not.
std::int64_t min_growth(const std::vector<std::int64_t>& resident) {
  std::int64_t min_kib = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 1; i < resident.size(); ++i) {
    min_kib = std::min(min_kib, resident[i] - resident[i - 1]);
  }
  return min_kib;
}

// A pad that leaves the picture and returns, then one that is hidden at times.
std::vector<GrayPicture> film() {
  std::vector<GrayPicture> film;
  for (const char* scene : {"reenter", "occluded"}) {
    ellipse::SceneRenderer renderer(ellipse::scene_by_name(scene, 1));
    for (std::uint64_t i = 0; i < 240; ++i) {
      film.emplace_back(kWidth, kHeight);
      (void)renderer.render(static_cast<double>(i) / 30.0, i, film.back().writable());
    }
  }
  return film;
}

struct Soak {
  std::string name;
  std::string elements;
  int frames;
};

class Soaks : public testing::TestWithParam<Soak> {};

TEST_P(Soaks, MemoryStaysConstant) {
  const std::string caps = caps_of("GRAY8", kWidth, kHeight);
  const auto harness = support::harness_of(GetParam().elements, caps, "application/x-ndjson");
  BusTap bus(harness->element);
  const std::vector<GrayPicture> pictures = film();
  const int frames = GetParam().frames;
  std::vector<std::int64_t> resident;  // [KiB], at the end of each window
  std::uint64_t lines_with_target = 0;
  for (int i = 0; i < frames; ++i) {
    auto buffer =
        support::gray_buffer_of(pictures.at(static_cast<std::size_t>(i) % pictures.size()));
    GST_BUFFER_PTS(buffer.get()) = gst_util_uint64_scale(static_cast<guint64>(i), GST_SECOND, 30);
    const Owned<GstBuffer> line(gst_harness_push_and_pull(harness.get(), buffer.release()));
    ASSERT_TRUE(line) << i;
    lines_with_target += support::bytes_of(line.get()).find("\"id\"") != std::string::npos ? 1 : 0;
    while (bus.pop(GST_MESSAGE_ANY)) continue;
    if ((i + 1) % (frames / kWindows) == 0) resident.push_back(resident_kib());
  }
  std::cout << GetParam().name << ": " << frames << " frames, " << lines_with_target
            << " with a target, resident memory after each " << frames / kWindows << ":";
  for (const std::int64_t kib : resident) std::cout << ' ' << kib;
  std::cout << " KiB\n";
  EXPECT_GT(lines_with_target, static_cast<std::uint64_t>(frames) / 4);
  EXPECT_LT(min_growth(resident), kGrowthKiB);
}

TEST(MinGrowth, SeparatesLeaksFromAllocatorNoise) {
  EXPECT_EQ(min_growth({100, 3000, 3000, 3000, 3000}), 0);  // grown once, then constant
  EXPECT_EQ(min_growth({100, 120, 90, 130, 70}), -60);
  EXPECT_EQ(min_growth({100, 200, 310, 420, 5000}), 100);
}

INSTANTIATE_TEST_SUITE_P(
    Elements,
    Soaks,
    testing::Values(
        Soak{"ours", "ellipsetrack ! ellipsejson", 300'000},
        Soak{"drawing",
             "ellipsetrack messages=every-frame candidates=true "
             "overlay=ellipse+axes+centre+roi+label ! ellipseoverlay ! ellipsejson",
             30'000},
        Soak{"paper", "ellipsetrack detector=contours tracking=redetect ! ellipsejson", 30'000}),
    [](const testing::TestParamInfo<Soak>& info) { return info.param.name; });

}  // namespace
