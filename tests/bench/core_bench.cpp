// SPDX-License-Identifier: MIT
//
// Compares every stage of the detector and the tracker with the edge and contour extraction that
// any contour-based method needs, and counts its heap allocations.
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/detection/contours/contour_detector.hpp"
#include "core/detection/contours/overlap.hpp"
#include "core/detection/target_selection.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/luma.hpp"
#include "core/image/scale.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/bench/frames.hpp"

namespace {

using bench::Frame;
using bench::Work;
using benchmark::DoNotOptimize;
using benchmark::State;
using Frames = std::vector<Frame>;

void edges_and_contours(State& state, const Frames& frames) {
  bench::compare(state, frames, [&]() -> Work {
    auto reference = std::make_shared<bench::Reference>();
    return [&, reference](std::size_t i) { reference->run(frames[i]); };
  });
}

// Pictures

struct PackedFormat {
  const char* name;
  ellipse::PixelLayout layout;
};

const PackedFormat kPackedFormats[] = {
    {"YUY2", {.kind = ellipse::PixelLayout::Kind::kLuma, .pixel_stride = 2}},
    {"BGR", {ellipse::PixelLayout::Kind::kRgb, 3, 0, 2, 1, 0}},
    {"BGRx", {ellipse::PixelLayout::Kind::kRgb, 4, 0, 2, 1, 0}},
};

// Every byte of a pixel holds its luma.
std::vector<cv::Mat> packed(const Frames& frames, int bytes_per_pixel) {
  std::vector<cv::Mat> pictures;
  for (const Frame& frame : frames) {
    const std::vector<cv::Mat> channels(static_cast<std::size_t>(bytes_per_pixel),
                                        bench::mat_of(frame.picture));
    cv::merge(channels, pictures.emplace_back());
  }
  return pictures;
}

void read_luma(State& state, const Frames& frames, const PackedFormat& format) {
  const std::vector<cv::Mat> pictures = packed(frames, format.layout.pixel_stride);
  bench::compare(state, frames, [&]() -> Work {
    auto reader = std::make_shared<ellipse::LumaReader>();
    return [&, reader](std::size_t i) {
      const cv::Mat& picture = pictures[i];
      const auto stride = static_cast<std::ptrdiff_t>(picture.step);
      const ellipse::PixelView view(
          picture.data, picture.cols, picture.rows, stride, format.layout);
      reader->begin(view);
      DoNotOptimize(reader->read(view.bounds()));
    };
  });
}

void reduce(State& state, const Frames& frames, int scale) {
  bench::compare(state, frames, [&]() -> Work {
    auto scaler = std::make_shared<ellipse::Scaler>();
    return [&, scaler, scale](std::size_t i) {
      DoNotOptimize(scaler->reduce(frames[i].picture.view(), scale));
    };
  });
}

void render(State& state, const Frames& frames) {
  support::GrayPicture picture = frames.front().picture;
  bench::compare(state, frames, [&]() -> Work {
    auto renderer = std::make_shared<ellipse::SceneRenderer>(bench::scene());
    return [&, renderer](std::size_t i) {
      DoNotOptimize(renderer->render(frames[i].time_s, i, picture.writable()));
    };
  });
}

// Stages that process one contour: the target's, in each frame.

struct TargetEdge {
  std::vector<cv::Point> contour;
  std::vector<Eigen::Vector2d> points;
  ellipse::Ellipse ellipse;
  cv::Mat thick_edges;
};

TargetEdge target_edge_of(const Frame& frame) {
  bench::Reference reference;
  reference.run_same_edges(frame);
  TargetEdge edge;
  edge.ellipse = frame.truth.outer_edge.value();
  cv::dilate(reference.edges(), edge.thick_edges, cv::Mat());
  double max_pixels = 0.0;
  for (const auto& contour : reference.contours()) {
    const double on_ellipse = ellipse::contour_overlap(contour, edge.ellipse);
    const double pixels = on_ellipse * static_cast<double>(contour.size());
    if (pixels > max_pixels) edge.contour = contour;
    max_pixels = std::max(max_pixels, pixels);
  }
  for (const cv::Point& pixel : edge.contour) edge.points.emplace_back(pixel.x, pixel.y);
  return edge;
}

// @param stage  Called with one TargetEdge.
template <class Stage>
void on_target_edge(State& state, const Frames& frames, const Stage& stage) {
  std::vector<TargetEdge> edges;
  for (const Frame& frame : frames) edges.push_back(target_edge_of(frame));
  bench::compare(state, frames, [&]() -> Work {
    return [&](std::size_t i) { DoNotOptimize(stage(edges[i])); };
  });
}

std::optional<ellipse::Ellipse> fit(const TargetEdge& edge) {
  return ellipse::fit_ellipse(edge.points);
}

std::optional<ellipse::Ellipse> step_geometric_fit(const TargetEdge& edge) {
  ellipse::GeometricFit fit(edge.ellipse);
  for (const Eigen::Vector2d& point : edge.points) {
    if (std::abs(fit.offset_of(point).distance_px) <= ellipse::kOverlapTolerancePx) fit.add(point);
  }
  return fit.solve();
}

double overlap_contour(const TargetEdge& edge) {
  return ellipse::contour_overlap(edge.contour, edge.ellipse);
}

double support_perimeter(const TargetEdge& edge) {
  const cv::Mat& thick = edge.thick_edges;
  const auto stride = static_cast<std::ptrdiff_t>(thick.step);
  return ellipse::perimeter_support(edge.ellipse, {thick.data, thick.cols, thick.rows, stride})
      .ellipse_overlap();
}

// Selects from the maximum number of detections that a detector returns, as pairs around 128
// centres.
void select_among_many(State& state, const Frames& frames) {
  constexpr int kPairs = 128;
  std::vector<ellipse::Detection> detections;
  for (int i = 0; i < 2 * kPairs; ++i) {
    const double x = 50.0 * (i / 2);  // NOLINT(bugprone-integer-division)
    detections.push_back({{x, 0.0, 20.0 + 10.0 * (i % 2), 15.0 + 7.5 * (i % 2)}, 1.0, 1.0, 9.0});
  }
  bench::compare(state, frames, [&]() -> Work {
    return [&](std::size_t) { DoNotOptimize(ellipse::select_target(detections)); };
  });
}

// Whole detectors and trackers

void detect_contours(State& state, const Frames& frames) {
  bench::FoundShare found;
  const auto make = [&]() -> Work {
    auto detector = std::make_shared<ellipse::ContourDetector>();
    return [&, detector](std::size_t i) {
      found.add(!detector->detect(frames[i].picture.view(), {}).empty());
    };
  };
  bench::compare(state, frames, make, bench::SameEdges::kYes);
  found.report(state);
}

void track(State& state, const Frames& frames, const ellipse::TrackerSettings& settings) {
  bench::FoundShare found;
  const auto make = [&]() -> Work {
    auto tracker = std::make_shared<ellipse::Tracker>(settings);
    return [&, tracker, pts_s = 0.0](std::size_t i) mutable {
      pts_s += bench::kFrameInterval_s;
      const auto pts_ns = static_cast<std::int64_t>(1e9 * pts_s);
      found.add(tracker->process(frames[i].picture.view(), pts_ns).has_value());
    };
  };
  bench::compare(state, frames, make, bench::SameEdges::kYes);
  found.report(state);
}

void add_stages() {
  bench::add_benchmark("edges_and_contours", edges_and_contours);
  for (const PackedFormat& format : kPackedFormats) {
    bench::add_benchmark(std::string("luma/") + format.name,
                         [&format](State& state, const Frames& f) { read_luma(state, f, format); });
  }
  for (const int scale : {2, 4, 8}) {
    bench::add_benchmark("scale/" + std::to_string(scale),
                         [scale](State& state, const Frames& f) { reduce(state, f, scale); });
  }
  const auto add = [](const char* name, auto* stage) {
    bench::add_benchmark(
        name, [stage](State& state, const Frames& f) { on_target_edge(state, f, stage); });
  };
  add("fit_ellipse", fit);
  add("geometric_fit", step_geometric_fit);
  add("contour_overlap", overlap_contour);
  add("perimeter_support", support_perimeter);
  bench::add_benchmark("select_target/256", select_among_many);
  bench::add_benchmark("render", render);
}

// Measures every detector and tracking mode in the settings' tables; none is named here.
void add_trackers() {
  bench::add_benchmark("detect/contours", detect_contours);
  for (const char* detector : ellipse::detector_nicks()) {
    for (const char* tracking : ellipse::tracking_nicks()) {
      ellipse::TrackerSettings settings;
      ellipse::set_by_name(settings, "detector", detector);
      ellipse::set_by_name(settings, "tracking", tracking);
      bench::add_benchmark(
          std::string("track/") + detector + "/" + tracking,
          [settings](State& state, const Frames& frames) { track(state, frames, settings); });
    }
  }
}

// Cost of the target's pose and of a distorted lens. The distortion is weak enough for the same
// frames.
void add_cameras() {
  ellipse::TrackerSettings settings;
  settings.target_diameter_m = 1.5;
  settings.hfov_rad = 1.012;
  bench::add_benchmark("track/with_pinhole", [settings](State& state, const Frames& frames) {
    track(state, frames, settings);
  });
  settings.camera = ellipse::Camera::with_hfov(1.012, 640, 360);
  settings.camera->distortion = {-1e-3, 1e-4};
  bench::add_benchmark("track/with_distorted_lens", [settings](State& state, const Frames& frames) {
    track(state, frames, settings);
  });
}

}  // namespace

int main(int argc, char** argv) {
  add_stages();
  add_trackers();
  add_cameras();
  return bench::run_benchmarks(argc, argv);
}
