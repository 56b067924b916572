// SPDX-License-Identifier: MIT
//
// Uses the core library without GStreamer: detects the ellipses in a picture and selects the
// target. For a stream, ellipse::Tracker (core/tracking/tracker.hpp) takes frame by frame.
//   ./01_detect_image picture.jpg
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "core/detection/detectors.hpp"
#include "core/detection/target_selection.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PICTURE\n", argv[0]);
    return 1;
  }
  const cv::Mat picture = cv::imread(argv[1], cv::IMREAD_GRAYSCALE);
  if (picture.empty()) {
    std::fprintf(stderr, "%s: cannot be read as a picture\n", argv[1]);
    return 1;
  }
  const auto detector = ellipse::make_detector(ellipse::DetectorKind::kArcs);
  const auto found = detector->detect(
      {picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)},
      ellipse::Thresholds{});
  for (const ellipse::Detection& d : found) {
    std::printf("centre (%.2f, %.2f) semi-axes %.2f, %.2f angle %.3f rad\n",
                d.ellipse.cx,
                d.ellipse.cy,
                d.ellipse.semi_major,
                d.ellipse.semi_minor,
                d.ellipse.angle_rad);
  }
  if (const auto target = ellipse::select_target(found)) {
    std::printf("target: centre (%.2f, %.2f)\n", target->ellipse.cx, target->ellipse.cy);
  }
  return 0;
}
