#pragma once  // SPDX-License-Identifier: MIT

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/detection/detector.hpp"
#include "core/edges/gradient_map.hpp"

namespace ellipse {

struct TracedPass;
struct TracedPiece;

/// [Keipour2021] Algorithm 1, step by step on OpenCV: Canny's edges [Canny1986], the contours of
/// [SuzukiAbe1985], one ellipse fitted to each contour and tested, the cheapest test first.
///
/// Reuses its buffers between calls. OpenCV's edge and contour functions allocate internally.
class ContourDetector final : public Detector {
 public:
  [[nodiscard]] std::span<const Detection> detect(const Picture& picture,
                                                  const Thresholds& thresholds) override;
  /// Log odds of EllipseOverlap minus those of its threshold.
  [[nodiscard]] std::optional<double> log_odds_of(const Picture& picture,
                                                  const Ellipse& e,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {0.95, 0.95}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {0.7, 0.3}; }

  /// The thresholds used for the last picture, adaptive or as given.
  [[nodiscard]] const EdgeThresholds& edge_thresholds() const { return edge_thresholds_; }

 private:
  void add_detection(const Detection& detection);
  void detect_edges(const ImageView& luma, const Thresholds& thresholds);
  void undistort_detections();
  void drop_short_contours(int min_size);
  void try_contour(std::span<const cv::Point> contour,
                   const Thresholds& thresholds,
                   std::vector<TracedPiece> TracedPass::*stage);
  void try_parts(const Thresholds& thresholds);
  void trace_edges(const ImageView& luma);

  LensView lens_;  // of the current picture
  cv::Mat smooth_;
  cv::Mat gradient_x_;
  cv::Mat gradient_y_;
  cv::Mat edges_;
  cv::Mat thick_edges_;
  EdgeThresholds edge_thresholds_;
  std::vector<int> histogram_;
  std::vector<std::vector<cv::Point>> contours_;
  std::vector<Detection> detections_;
};

}  // namespace ellipse
