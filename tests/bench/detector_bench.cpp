// SPDX-License-Identifier: MIT
//
// The detector and the tracker beside what any method on contours pays for its edges and contours
// alone, on the same frames in the same run: "ratio" with Canny's thresholds fixed at 40 and 80,
// "ratio_same_edges" with those that the detector has chosen for the frame.
#include <benchmark/benchmark.h>

#include <chrono>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/contour_detector.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracker.hpp"

namespace {

using Clock = std::chrono::steady_clock;

std::vector<cv::Mat> approach(int width, int height) {
  ellipse::SceneRenderer renderer(ellipse::scene_by_name("approach"));
  std::vector<cv::Mat> frames;
  for (int i = 0; i < 20; ++i) {
    cv::Mat frame(height, width, CV_8UC1);
    renderer.render(2.0 + i / 30.0,
                    static_cast<std::uint64_t>(i),
                    {frame.data, width, height, static_cast<std::ptrdiff_t>(frame.step)});
    frames.push_back(frame);
  }
  return frames;
}

double seconds(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

class Reference {
 public:
  double run_s(const cv::Mat& frame, double low, double high, bool has_l2_gradient) {
    const auto start = Clock::now();
    cv::GaussianBlur(frame, smooth_, {5, 5}, 1.0);
    cv::Canny(smooth_, edges_, low, high, 3, has_l2_gradient);
    cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    return seconds(start);
  }

 private:
  cv::Mat smooth_;
  cv::Mat edges_;
  std::vector<std::vector<cv::Point>> contours_;
};

// Runs all on each frame in turn, so that all meet the same machine in the same mood.
template <class Work>
void compare(benchmark::State& state, const Work& work) {
  cv::setNumThreads(1);
  const auto width = static_cast<int>(state.range(0));
  const auto height = static_cast<int>(state.range(1));
  const std::vector<cv::Mat> frames = approach(width, height);
  Reference reference;
  ellipse::ContourDetector chooser;
  double own_s = 0.0;
  double fixed_s = 0.0;
  double same_edges_s = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const cv::Mat& frame = frames[i++ % frames.size()];
    const ellipse::ImageView view{
        frame.data, frame.cols, frame.rows, static_cast<std::ptrdiff_t>(frame.step)};
    const auto start = Clock::now();
    work(view);
    const double elapsed = seconds(start);
    own_s += elapsed;
    state.SetIterationTime(elapsed);
    fixed_s += reference.run_s(frame, 40, 80, false);
    benchmark::DoNotOptimize(chooser.detect(view, {}));
    const ellipse::EdgeThresholds& chosen = chooser.edge_thresholds();
    same_edges_s += reference.run_s(frame, 8.0 * chosen.low, 8.0 * chosen.high, true);
  }
  state.counters["ratio"] = own_s / fixed_s;
  state.counters["ratio_same_edges"] = own_s / same_edges_s;
}

void contour_detector(benchmark::State& state) {
  ellipse::ContourDetector detector;
  compare(state, [&](const ellipse::ImageView& frame) {
    benchmark::DoNotOptimize(detector.detect(frame, {}));
  });
}

void tracker_redetect(benchmark::State& state) {
  ellipse::Tracker tracker;
  compare(state, [&](const ellipse::ImageView& frame) {
    benchmark::DoNotOptimize(tracker.process(frame, 0));
  });
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Unit(benchmark::kMillisecond);
  benchmark->Args({640, 360})->Args({1280, 720})->Args({1920, 1080});
}

BENCHMARK(contour_detector)->Apply(sizes);
BENCHMARK(tracker_redetect)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
