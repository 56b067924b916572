// SPDX-License-Identifier: MIT
//
// The same stream gives the same ellipses, bit for bit.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/scene/catalog.hpp"
#include "tests/gst/tracker_harness.hpp"
#include "tests/gst/verdicts.hpp"

namespace {

using support::caps_of;
using support::GrayPicture;
using support::Owned;
using support::Verdict;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

struct Frame {
  int number;
  GrayPicture picture;
  bool has_time = true;
};

// @param is_missing  Whether a frame is dropped before the tracker.
template <class IsMissing>
std::vector<Frame> film(const char* scene, int frames, const IsMissing& is_missing) {
  ellipse::SceneRenderer renderer(ellipse::scene_by_name(scene, 1));
  std::vector<Frame> film;
  for (int i = 0; i < frames; ++i) {
    if (is_missing(i)) continue;
    film.push_back({i, GrayPicture(kWidth, kHeight)});
    (void)renderer.render(i / 30.0, static_cast<std::uint64_t>(i), film.back().picture.writable());
  }
  return film;
}

// Two seconds of a scene, rendered once.
const std::vector<Frame>& film(const char* scene) {
  static std::map<std::string, std::vector<Frame>> films;
  std::vector<Frame>& found = films[scene];
  if (found.empty()) found = film(scene, 60, [](int) { return false; });
  return found;
}

Owned<GstBuffer> buffer_of(const Frame& frame) {
  auto buffer = support::gray_buffer_of(frame.picture);
  GST_BUFFER_PTS(buffer.get()) =
      frame.has_time ? gst_util_uint64_scale(static_cast<guint64>(frame.number), GST_SECOND, 30)
                     : GST_CLOCK_TIME_NONE;
  return buffer;
}

// @param deliver  Calls its argument, on any thread.
template <class Deliver>
std::vector<Verdict> shown(const std::vector<Frame>& film,
                           const std::string& settings,
                           const Deliver& deliver) {
  const auto harness = support::tracker(settings, caps_of("GRAY8", kWidth, kHeight));
  std::vector<Verdict> verdicts;
  for (const Frame& frame : film) {
    deliver([&] {
      verdicts.push_back(support::verdict_on(support::push(harness, buffer_of(frame)).get()));
    });
  }
  return verdicts;
}

std::vector<Verdict> shown(const std::vector<Frame>& film, const std::string& settings = "") {
  return shown(film, settings, [](const auto& push) { push(); });
}

const auto kInThreadsOfTheirOwn = [](const auto& push) { std::thread(push).join(); };

// Number of frames with a target; collects the targets' ids.
int found_in(const std::vector<Verdict>& verdicts, std::set<std::uint64_t>& ids) {
  int found = 0;
  for (const Verdict& verdict : verdicts) {
    if (verdict.id == 0) continue;
    ids.insert(verdict.id);
    ++found;
  }
  return found;
}

class Determinism : public testing::TestWithParam<const char*> {};

TEST_P(Determinism, RepeatedRunsGiveTheSame) {
  for (const char* scene : {"occluded", "noise", "shake"}) {
    const std::vector<Frame>& frames = film(scene);
    const std::vector<Verdict> first = shown(frames, GetParam());
    std::set<std::uint64_t> ids;
    EXPECT_GT(found_in(first, ids), 0) << scene;
    for (int run = 0; run < 2; ++run) EXPECT_EQ(shown(frames, GetParam()), first) << scene;
  }
}

TEST_P(Determinism, IsIndependentOfTheStreamingThread) {
  for (const char* scene : {"approach", "noise"}) {
    const std::vector<Frame>& frames = film(scene);
    EXPECT_EQ(shown(frames, GetParam(), kInThreadsOfTheirOwn), shown(frames, GetParam())) << scene;
  }
}

TEST_P(Determinism, FlushRestoresTheInitialState) {
  const std::vector<Frame>& frames = film("shake");
  const auto harness = support::tracker(GetParam(), caps_of("GRAY8", kWidth, kHeight));
  std::vector<Verdict> rounds[2];
  for (std::vector<Verdict>& round : rounds) {
    for (const Frame& frame : frames) {
      round.push_back(support::verdict_on(support::push(harness, buffer_of(frame)).get()));
    }
    gst_harness_push_event(harness.get(), gst_event_new_flush_start());
    gst_harness_push_event(harness.get(), gst_event_new_flush_stop(FALSE));
  }
  for (std::vector<Verdict>& round : rounds) {
    for (Verdict& verdict : round) verdict.id = verdict.id == 0 ? 0 : 1;  // ids keep counting
  }
  EXPECT_EQ(rounds[0], rounds[1]);
}

INSTANTIATE_TEST_SUITE_P(Settings,
                         Determinism,
                         testing::Values("",
                                         "interval=3",
                                         "tracking=redetect",
                                         "tracking=none detector=contours",
                                         "tracking=redetect detector=contours"));

TEST(Gaps, EveryThirdFrameSufficesToKeepTheTarget) {
  const std::vector<Verdict> verdicts = shown(film("approach"), "interval=3");
  std::set<std::uint64_t> ids;
  EXPECT_EQ(found_in(verdicts, ids), 20);
  EXPECT_EQ(ids, std::set<std::uint64_t>{1});
}

TEST(Gaps, FiveLostFramesDoNotLoseTheTarget) {
  for (const char* scene : {"approach", "orbit", "hover"}) {
    const std::vector<Frame> frames = film(scene, 150, [](int i) { return i > 10 && i % 15 < 5; });
    const std::vector<Verdict> verdicts = shown(frames);
    std::set<std::uint64_t> ids;
    EXPECT_EQ(found_in(verdicts, ids), static_cast<int>(frames.size())) << scene;
    EXPECT_EQ(ids, std::set<std::uint64_t>{1}) << scene;
    for (std::size_t i = 1; i < verdicts.size(); ++i) {
      if (frames[i].number == frames[i - 1].number + 1) continue;
      EXPECT_EQ(verdicts[i].state, GST_ELLIPSE_STATE_TRACKED) << scene << frames[i].number;
    }
    EXPECT_EQ(shown(frames, "", kInThreadsOfTheirOwn), verdicts) << scene;
  }
}

// Like decoders that omit some time stamps.
TEST(Gaps, MissingTimestampsLoseNoTarget) {
  for (const char* scene : {"approach", "touchdown", "dash"}) {
    std::vector<Frame> frames = film(scene, 150, [](int) { return false; });
    const std::vector<Verdict> whole = shown(frames);
    for (Frame& frame : frames) frame.has_time = frame.number % 7 != 3;
    const std::vector<Verdict> verdicts = shown(frames);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(verdicts[i].id, whole[i].id) << scene << i;
      EXPECT_EQ(verdicts[i].state, whole[i].state) << scene << i;
      EXPECT_NEAR(verdicts[i].cx(), whole[i].cx(), 0.01) << scene << i;
      EXPECT_NEAR(verdicts[i].cy(), whole[i].cy(), 0.01) << scene << i;
    }
  }
}

}  // namespace
