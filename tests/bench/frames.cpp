// SPDX-License-Identifier: MIT
#include "tests/bench/frames.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <opencv2/imgproc.hpp>

#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "tests/bench/allocations.hpp"

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kFrames = 6;
constexpr double kStart_s = 3.5;
constexpr std::int64_t kPixelsPerBenchmark = 100'000'000;

std::vector<Frame> render(const Size& size) {
  ellipse::SceneRenderer renderer(scene());
  ellipse::ContourDetector detector;
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < kFrames; ++i) {
    Frame& frame = frames.emplace_back(Frame{.picture{size.width, size.height}});
    frame.time_s = kStart_s + static_cast<double>(i) * kFrameInterval_s;
    frame.truth = renderer.render(frame.time_s, i, frame.picture.writable());
    cv::GaussianBlur(mat_of(frame.picture), frame.smooth, {5, 5}, 1.0);
    benchmark::DoNotOptimize(detector.detect(frame.picture.view(), {}));
    frame.chosen_thresholds = detector.edge_thresholds();
  }
  return frames;
}

std::size_t period(const std::vector<Frame>& frames) {
  return 2 * frames.size() - 2;
}

// The buffers grow in the first two rounds; the third measures the steady state.
Work measure_heap(benchmark::State& state,
                  const std::vector<Frame>& frames,
                  const std::function<Work()>& make) {
  const HeapMeter meter;
  Work work = make();
  const auto run_round = [&] {
    for (std::size_t i = 0; i < period(frames); ++i) work(there_and_back(i, frames.size()));
  };
  run_round();
  run_round();
  const std::int64_t before = meter.allocations();
  run_round();
  const auto in_round = static_cast<double>(meter.allocations() - before);
  const auto peak_bytes = static_cast<double>(meter.peak_bytes());
  state.counters["allocations"] = in_round / static_cast<double>(period(frames));
  state.counters["peak_mb"] = 1e-6 * peak_bytes;
  state.counters["bytes_per_pixel"] =
      peak_bytes / static_cast<double>(frames.front().picture.pixels.size());
  return work;
}

// A fixed count: with a minimum time for the work, a stage of microseconds would run the reference
// beside it for minutes.
std::int64_t iterations_at(const Size& size) {
  const std::int64_t pixels = std::int64_t{size.width} * size.height;
  return std::clamp<std::int64_t>(kPixelsPerBenchmark / pixels, 12, 200);
}

}  // namespace

std::size_t there_and_back(std::size_t turn, std::size_t count) {
  const std::size_t phase = turn % (2 * count - 2);
  return std::min(phase, 2 * count - 2 - phase);
}

double seconds(const std::function<void()>& call) {
  const auto start = Clock::now();
  call();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

ellipse::Scene scene() {
  return ellipse::scene_by_name("approach");
}

const std::vector<Frame>& frames_of(const Size& size) {
  static std::deque<std::vector<Frame>> known;
  for (const std::vector<Frame>& frames : known) {
    const support::GrayPicture& picture = frames.front().picture;
    if (picture.width == size.width && picture.height == size.height) return frames;
  }
  return known.emplace_back(render(size));
}

cv::Mat mat_of(const support::GrayPicture& picture) {
  return {picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.pixels.data())};
}

void Reference::run(const Frame& frame) {
  cv::Canny(frame.smooth, edges_, 40, 80);
  cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
}

void Reference::run_same_edges(const Frame& frame) {
  constexpr double kSobelGain = 8.0;
  const ellipse::EdgeThresholds& chosen = frame.chosen_thresholds;
  cv::Canny(
      frame.smooth, edges_, kSobelGain * chosen.low, kSobelGain * chosen.high, 3, /*L2*/ true);
  cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
}

void compare(benchmark::State& state,
             const std::vector<Frame>& frames,
             const std::function<Work()>& make,
             SameEdges same_edges) {
  cv::setNumThreads(1);
  const Work work = measure_heap(state, frames, make);
  Reference reference;
  reference.run(frames.front());
  double own_s = 0.0;
  double reference_s = 0.0;
  double same_edges_s = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t n = there_and_back(i++, frames.size());
    const double elapsed_s = seconds([&] { work(n); });
    state.SetIterationTime(elapsed_s);
    own_s += elapsed_s;
    reference_s += seconds([&] { reference.run(frames[n]); });
    if (same_edges == SameEdges::kNo) continue;
    same_edges_s += seconds([&] { reference.run_same_edges(frames[n]); });
  }
  state.counters["ratio"] = own_s / reference_s;
  if (same_edges == SameEdges::kYes) state.counters["ratio_same_edges"] = own_s / same_edges_s;
}

void FoundShare::add(bool is_found) {
  ++frames_;
  found_ += is_found ? 1 : 0;
}

void FoundShare::report(benchmark::State& state) const {
  state.counters["found"] = static_cast<double>(found_) / std::max(1, frames_);
}

void add_benchmark(const std::string& name, const Benchmark& run) {
  for (const Size& size : kSizes) {
    benchmark::RegisterBenchmark(
        (name + "/" + size.name()).c_str(),
        [run, size](benchmark::State& state) { run(state, frames_of(size)); })
        ->Iterations(iterations_at(size))
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

int run_benchmarks(int argc, char** argv) {
  if (!counts_allocations()) {
    std::fputs("The heap is not counted: malloc of this program is not in place.\n", stderr);
    return 1;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace bench
