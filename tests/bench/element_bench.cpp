// SPDX-License-Identifier: MIT
//
// Measures whole elements from buffer to buffer against edge and contour extraction alone, and
// overlays on a small and a large frame. The rows "identity" and "ellipseoverlay/none" are the cost
// of the pads and the harness.
#include <gst/check/gstharness.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/tracking/settings.hpp"
#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/track/video_view.hpp"
#include "tests/bench/allocations.hpp"
#include "tests/bench/frames.hpp"
#include "tests/gst/support.hpp"

namespace {

using bench::Frame;
using bench::Work;
using benchmark::State;
using support::Owned;
using Frames = std::vector<Frame>;

constexpr const char* kFormats[] = {"GRAY8", "I420", "BGR"};

std::vector<Owned<GstBuffer>> buffers_of(const Frames& frames, const std::string& format) {
  std::vector<Owned<GstBuffer>> buffers;
  for (const Frame& frame : frames) {
    const support::GrayPicture& picture = frame.picture;
    buffers.push_back(
        support::buffer_of(picture, support::info_of(format, picture.width, picture.height)));
  }
  return buffers;
}

Owned<GstHarness> harness_of(const std::string& element, const std::string& caps) {
  Owned<GstHarness> harness(gst_harness_new_parse(element.c_str()));
  gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
  return harness;
}

// Every frame is a new buffer around existing memory, as from a camera's pool.
void run_element(State& state,
                 const Frames& frames,
                 const std::string& element,
                 const std::string& format) {
  const std::vector<Owned<GstBuffer>> buffers = buffers_of(frames, format);
  const support::GrayPicture& picture = frames.front().picture;
  const std::string caps = support::caps_of(format, picture.width, picture.height);
  bench::FoundShare found;
  bench::compare(state, frames, [&]() -> Work {
    const std::shared_ptr<GstHarness> harness(harness_of(element, caps));
    return [&, harness, frame = guint64{0}](std::size_t i) mutable {
      GstBuffer* buffer = gst_buffer_copy(buffers[i].get());
      GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(frame++, GST_SECOND, 30);
      const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer));
      found.add(gst_buffer_get_ellipse_meta(out.get(), GST_ELLIPSE_ROLE_TARGET) != nullptr);
    };
  });
  found.report(state);
}

void add_element(const std::string& name, const std::string& element, const std::string& format) {
  bench::add_benchmark(name, [element, format](State& state, const Frames& frames) {
    run_element(state, frames, element, format);
  });
}

void add_elements() {
  add_element("identity", "identity", "GRAY8");
  for (const char* detector : ellipse::detector_nicks()) {
    for (const char* tracking : ellipse::tracking_nicks()) {
      const std::string element =
          std::string("ellipsetrack detector=") + detector + " tracking=" + tracking;
      for (const char* format : kFormats) {
        add_element(std::string("ellipsetrack/") + detector + "/" + tracking + "/" + format,
                    element,
                    format);
      }
    }
  }
}

// Pushes copies of buffers, which share their memory, through an element.
class BufferLoop {
 public:
  BufferLoop(const std::string& element, const std::string& caps)
      : harness_(harness_of(element, caps)) {}

  double run_s(GstBuffer* original, GstClockTime pts) {
    GstBuffer* buffer = gst_buffer_copy(original);
    GST_BUFFER_PTS(buffer) = pts;
    const double elapsed_s =
        bench::seconds([&] { buffer = gst_harness_push_and_pull(harness_.get(), buffer); });
    gst_buffer_unref(buffer);
    return elapsed_s;
  }

 private:
  Owned<GstHarness> harness_;
};

// Runs a tracker on the same buffers without an element.
class CoreLoop {
 public:
  explicit CoreLoop(const GstVideoInfo& info) : info_(info) {}

  double run_s(GstBuffer* buffer, GstClockTime pts) {
    MappedFrame mapped(info_, buffer, GST_MAP_READ);
    return bench::seconds([&] {
      benchmark::DoNotOptimize(
          tracker_.process(pixel_view_of(mapped.frame()), static_cast<std::int64_t>(pts)));
    });
  }

 private:
  GstVideoInfo info_;
  ellipse::Tracker tracker_;
};

// Minimum time of each turn of a round, which rejects interference from other processes. Frames and
// detector runs repeat after one round.
class Round {
 public:
  Round() { shortest_s_.fill(std::numeric_limits<double>::max()); }

  void add(std::uint64_t turn, double elapsed_s) {
    double& shortest_s = shortest_s_[turn % shortest_s_.size()];
    shortest_s = std::min(shortest_s, elapsed_s);
  }
  [[nodiscard]] double sum_s() const {
    return std::accumulate(shortest_s_.begin(), shortest_s_.end(), 0.0);
  }

 private:
  std::array<double, 40> shortest_s_;  // the frames repeat after 10, detector runs after 8
};

// A tracker, an element with a tracker, and an element that does nothing. The placement in memory
// changes the speed of the same tracker by some percent, so they are replaced every few rounds.
struct Contenders {
  CoreLoop core;
  BufferLoop element;
  BufferLoop pads;

  Contenders(const std::string& format, const bench::Size& size)
      : core(support::info_of(format, size.width, size.height)),
        element("ellipsetrack", support::caps_of(format, size.width, size.height)),
        pads("identity", support::caps_of(format, size.width, size.height)) {}
};

constexpr std::uint64_t kTurnsTogether = 200;

// "ratio_core" is the element's time divided by its tracker's time; "ratio_less_pads" subtracts the
// time of "identity" first.
void run_beside_core(State& state, const std::string& format, const bench::Size& size) {
  const Frames& frames = bench::frames_of(size);
  const std::vector<Owned<GstBuffer>> buffers = buffers_of(frames, format);
  std::optional<Contenders> contenders;
  Round of_core;
  Round of_element;
  Round of_pads;
  std::uint64_t turn = 0;
  for (auto _ : state) {
    if (turn % kTurnsTogether == 0) contenders.emplace(format, size);
    auto& [core, element, pads] = *contenders;
    GstBuffer* buffer = buffers[bench::there_and_back(turn, frames.size())].get();
    const GstClockTime pts = gst_util_uint64_scale(turn, GST_SECOND, 30);
    // The second to run finds the pixels in the cache.
    const bool is_core_first = turn / 3 % 2 == 0;
    if (is_core_first) of_core.add(turn, core.run_s(buffer, pts));
    const double elapsed_s = element.run_s(buffer, pts);
    if (!is_core_first) of_core.add(turn, core.run_s(buffer, pts));
    of_element.add(turn, elapsed_s);
    of_pads.add(turn, pads.run_s(buffer, pts));
    state.SetIterationTime(elapsed_s);
    ++turn;
  }
  state.counters["ratio_core"] = of_element.sum_s() / of_core.sum_s();
  state.counters["ratio_less_pads"] = (of_element.sum_s() - of_pads.sum_s()) / of_core.sum_s();
}

void add_beside_core() {
  for (const char* format : {"I420", "BGR"}) {
    for (const bench::Size& size : {bench::kSizes[0], bench::kSizes[2]}) {
      benchmark::RegisterBenchmark(
          (std::string("ellipsetrack/beside_core/") + format + "/" + size.name()).c_str(),
          [=](State& state) { run_beside_core(state, format, size); })
          ->Iterations(24 * kTurnsTogether)
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

// Pushes one buffer through an overlay repeatedly, with the same ellipse at its centre.
class OverlayLoop {
 public:
  OverlayLoop(const std::string& format, const bench::Size& size, bool is_composed)
      : harness_(gst_harness_new("ellipseoverlay")),
        buffer_(support::buffer_of(support::GrayPicture(size.width, size.height, 90),
                                   support::info_of(format, size.width, size.height))) {
    if (is_composed) support::offer_composition(harness_.get());
    gst_harness_set_src_caps_str(harness_.get(),
                                 support::caps_of(format, size.width, size.height).c_str());
    GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer_.get(), GST_ELLIPSE_ROLE_TARGET);
    meta->id = 1;
    meta->cx = size.width / 2.0;
    meta->cy = size.height / 2.0;
    meta->semi_major = 60.0;
    meta->semi_minor = 45.0;
    meta->angle_rad = 0.4;
  }

  void select(const char* parts) {
    const Owned<GstElement> overlay(gst_harness_find_element(harness_.get(), "ellipseoverlay"));
    gst_util_set_object_arg(G_OBJECT(overlay.get()), "overlay", parts);
  }

  double run_s() {
    const auto start = std::chrono::steady_clock::now();
    buffer_.reset(gst_harness_push_and_pull(harness_.get(), buffer_.release()));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (GstMeta* drawn =
            gst_buffer_get_meta(buffer_.get(), GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE)) {
      gst_buffer_remove_meta(buffer_.get(), drawn);
    }
    return elapsed.count();
  }

 private:
  Owned<GstHarness> harness_;
  Owned<GstBuffer> buffer_;
};

// Reports the time of the small frame; "ratio_4k" is the large frame's time divided by it.
void run_overlay(State& state, const std::string& format, const char* parts, bool is_composed) {
  OverlayLoop small(format, bench::kSizes.front(), is_composed);
  OverlayLoop large(format, bench::kSizes.back(), is_composed);
  for (OverlayLoop* loop : {&small, &large}) {
    loop->select(parts);
    for (int i = 0; i < 10; ++i) loop->run_s();
  }
  const bench::HeapMeter meter;
  small.run_s();
  const auto allocations = static_cast<double>(meter.allocations());
  double small_s = 0.0;
  double large_s = 0.0;
  for (auto _ : state) {
    const double elapsed_s = small.run_s();
    state.SetIterationTime(elapsed_s);
    small_s += elapsed_s;
    large_s += large.run_s();
  }
  state.counters["ratio_4k"] = large_s / small_s;
  state.counters["allocations"] = allocations;
}

void add_overlays() {
  for (const char* parts : {"none", "ellipse", "ellipse+axes+centre+label"}) {
    for (const char* format : {"I420", "BGRx"}) {
      for (const bool is_composed : {false, true}) {
        const std::string name = std::string("ellipseoverlay/") + parts + "/" + format +
                                 (is_composed ? "/composed" : "/drawn");
        benchmark::RegisterBenchmark(
            name.c_str(), [=](State& state) { run_overlay(state, format, parts, is_composed); })
            ->Iterations(500)
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
      }
    }
  }
}

// Before 2.76 GLib's slice allocator keeps small blocks, which hides allocations from the heap.
bool counts_slices() {
  const bench::HeapMeter meter;
  for (int i = 0; i < 2; ++i) g_slice_free1(64, g_slice_alloc(64));
  return meter.allocations() == 2;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  if (!counts_slices()) {
    std::fputs("GLib's slices are not counted: run with G_SLICE=always-malloc.\n", stderr);
    return 1;
  }
  add_elements();
  add_beside_core();
  add_overlays();
  return bench::run_benchmarks(argc, argv);
}
