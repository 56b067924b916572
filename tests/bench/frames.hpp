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

/// Size of a picture [px].
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

/// One frame of the scene "approach" with the inputs of the measurements.
struct Frame {
  support::GrayPicture picture;
  double time_s = 0.0;
  ellipse::Truth truth = {};
  cv::Mat smooth = {};                             ///< The reference's input.
  ellipse::EdgeThresholds chosen_thresholds = {};  ///< Chosen by ContourDetector.
};

/// Consecutive frames, rendered at the first call for a size and cached.
[[nodiscard]] const std::vector<Frame>& frames_of(const Size& size);

[[nodiscard]] ellipse::Scene scene();

/// A view of the picture's pixels for OpenCV.
[[nodiscard]] cv::Mat mat_of(const support::GrayPicture& picture);

/// The cost of any contour-based method: cv::Canny and cv::findContours on a smoothed picture.
class Reference {
 public:
  using Contours = std::vector<std::vector<cv::Point>>;

  /// Uses the thresholds 40 and 80.
  void run(const Frame& frame);
  /// Uses the thresholds that the detector chose for the frame, and its gradient norm.
  void run_same_edges(const Frame& frame);

  [[nodiscard]] const cv::Mat& edges() const { return edges_; }
  [[nodiscard]] const Contours& contours() const { return contours_; }

 private:
  cv::Mat edges_;
  Contours contours_;
};

/// Index of a frame when frames run forwards and backwards, 0 1 2 3 2 1 0 1 ...; no jump loses the
/// target.
[[nodiscard]] std::size_t there_and_back(std::size_t turn, std::size_t count);

/// Duration of a call [s].
[[nodiscard]] double seconds(const std::function<void()>& call);

/// The measured work on the frame with this number.
using Work = std::function<void(std::size_t frame)>;

/// Whether to compare with the reference on the detector's own edges too.
enum class SameEdges { kNo, kYes };

/// Measures the work that `make` returns. Counts its heap allocations, then alternates it with the
/// reference frame by frame, so that the machine's load affects both alike. OpenCV runs in one
/// thread.
///
/// Frames follow the order of there_and_back().
/// Counters: "ratio" and, on request, "ratio_same_edges" of the times; "allocations" per frame in
/// the steady state; "peak_mb" of the heap and "bytes_per_pixel" since the start.
void compare(benchmark::State& state,
             const std::vector<Frame>& frames,
             const std::function<Work()>& make,
             SameEdges same_edges = SameEdges::kNo);

/// Share of frames with a target, reported as the counter "found". Work that finds nothing may be
/// fast.
class FoundShare {
 public:
  void add(bool is_found);
  void report(benchmark::State& state) const;

 private:
  int frames_ = 0;
  int found_ = 0;
};

/// Registers one benchmark per size, "name/640x360" etc.
using Benchmark = std::function<void(benchmark::State&, const std::vector<Frame>&)>;
void add_benchmark(const std::string& name, const Benchmark& run);

/// Exits if allocations are not counted, otherwise runs the registered benchmarks.
int run_benchmarks(int argc, char** argv);

}  // namespace bench
