#pragma once  // SPDX-License-Identifier: MIT

#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/detection/contours/contour_detector.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/picture.hpp"

namespace bench {

/// Of a picture [px].
struct Size {
  int width = 0;
  int height = 0;

  [[nodiscard]] std::string name() const {
    return std::to_string(width) + "x" + std::to_string(height);
  }
};

inline constexpr std::array kSizes{
    Size{640, 360}, Size{1280, 720}, Size{1920, 1080}, Size{3840, 2160}};

inline constexpr double kFrameInterval_s = 1.0 / 30.0;

/// One frame of the scene "approach" and what the measurements need to know of it.
struct Frame {
  support::Picture picture;
  double time_s = 0.0;
  ellipse::Truth truth = {};
  cv::Mat smooth = {};                             ///< The picture as the reference gets it.
  ellipse::EdgeThresholds chosen_thresholds = {};  ///< By ContourDetector.
};

/// A few frames that follow each other, rendered at the first call for a size and kept.
[[nodiscard]] const std::vector<Frame>& frames_of(const Size& size);

[[nodiscard]] ellipse::Scene scene();

/// A view of its pixels as OpenCV sees them.
[[nodiscard]] cv::Mat mat_of(const support::Picture& picture);

/// What any method on contours pays: cv::Canny and cv::findContours on a smoothed picture.
class Reference {
 public:
  using Contours = std::vector<std::vector<cv::Point>>;

  /// With the thresholds 40 and 80.
  void run(const Frame& frame);
  /// With those that the detector has chosen for the frame, and its norm of the gradient.
  void run_same_edges(const Frame& frame);

  [[nodiscard]] const cv::Mat& edges() const { return edges_; }
  [[nodiscard]] const Contours& contours() const { return contours_; }

 private:
  cv::Mat edges_;
  Contours contours_;
};

/// The frames forwards and backwards without end, 0 1 2 3 2 1 0 1 ...: no jump loses a target.
[[nodiscard]] std::size_t there_and_back(std::size_t turn, std::size_t count);

/// How long a call takes [s].
[[nodiscard]] double seconds(const std::function<void()>& call);

/// What is measured, on the frame of this number.
using Work = std::function<void(std::size_t frame)>;

/// Whether to compare with the reference on the detector's own edges also.
enum class SameEdges { kNo, kYes };

/// Measures the work that `make` returns. Counts what it asks of the heap, then its time beside the
/// reference's, frame by frame in turn, so that both meet the same machine in the same mood.
/// OpenCV runs in one thread.
///
/// The frames come as by there_and_back().
/// Counters: "ratio" and, where asked for, "ratio_same_edges" of the times; "allocations" per frame
/// once everything has its size; "peak_mb" of the heap and "bytes_per_pixel" from the beginning on.
void compare(benchmark::State& state,
             const std::vector<Frame>& frames,
             const std::function<Work()>& make,
             SameEdges same_edges = SameEdges::kNo);

/// How often a target was found: the share of frames, as the counter "found". What finds nothing
/// may be fast.
class FoundShare {
 public:
  void add(bool is_found);
  void report(benchmark::State& state) const;

 private:
  int frames_ = 0;
  int found_ = 0;
};

/// Registers one benchmark per size, "name/640x360" and so on.
using Benchmark = std::function<void(benchmark::State&, const std::vector<Frame>&)>;
void add_benchmark(const std::string& name, const Benchmark& run);

/// Leaves the program where allocations are not counted, then runs what is registered.
int run_benchmarks(int argc, char** argv);

}  // namespace bench
