// SPDX-License-Identifier: MIT
#include "examples/evaluate/peers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/evaluate/peer_detection.hpp"
#include "examples/evaluate/randomized_hough.hpp"

namespace evaluate {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// Common part of all peers: converts the picture to cv::Mat and keeps detections within the limits.
class Peer : public ellipse::Detector {
 public:
  std::span<const ellipse::Detection> detect(const ellipse::Picture& picture,
                                             const ellipse::Thresholds& limits) final {
    const ellipse::ImageView& luma = picture.luma;
    detections_.clear();
    // Too small for an ellipse; some OpenCV functions reject such pictures.
    if (std::min(luma.width, luma.height) < kMinSizePx) return detections_;
    copy(luma);
    search(picture_, limits);
    return detections_;
  }

  [[nodiscard]] ellipse::Overlaps detecting_overlaps() const final { return {}; }
  [[nodiscard]] ellipse::Overlaps tracking_overlaps() const final { return {}; }

 protected:
  virtual void search(const cv::Mat& picture, const ellipse::Thresholds& limits) = 0;

  void add(const ellipse::Detection& found) { detections_.push_back(found); }

  void add(const std::optional<ellipse::Ellipse>& e, const ellipse::Thresholds& limits) {
    if (e && limits.accepts_axes(*e)) detections_.push_back(scored_by_perimeter(*e));
  }

 private:
  static constexpr int kMinSizePx = 16;

  // Copies to contiguous rows, because cv::Mat does not support negative strides.
  void copy(const ellipse::ImageView& luma) {
    picture_.create(luma.height, luma.width, CV_8UC1);
    for (int y = 0; y < luma.height; ++y) {
      std::memcpy(picture_.ptr(y), luma.row(y), static_cast<std::size_t>(luma.width));
    }
  }

  cv::Mat picture_;
  std::vector<ellipse::Detection> detections_;
};

// EDCircles as packaged by OpenCV, which returns circles (x, y, r, 0, 0, 0) and ellipses (x, y, 0,
// a, b, degrees). Default parameters except Sigma: 1.5 px instead of 1 finds 599 of the 603 AirLab
// targets instead of 593, in less time. Other parameters find as many or fewer: PFmode, gradient
// threshold 10 or 36, Sobel, LineFitErrorThreshold 0.5, MaxErrorThreshold 2. NFAValidation rejects
// perimeters above about 1000 px; without it, false ellipses are selected (540 of 603).
class EdgeDrawingPeer final : public Peer {
  void search(const cv::Mat& picture, const ellipse::Thresholds& limits) override {
    if (picture.size() != size_) start_over(picture.size());
    edge_drawing_->detectEdges(picture);
    if (!is_safe()) return;
    edge_drawing_->detectEllipses(found_);
    for (const cv::Vec6d& f : found_) {
      const bool is_circle = f[2] > 0.0;
      add(is_circle ? ellipse_of_axes(f[0], f[1], f[2], f[2], 0.0)
                    : ellipse_of_axes(f[0], f[1], f[3], f[4], f[5] * kRadiansPerDegree),
          limits);
    }
  }

  // A new object per size, because OpenCV keeps the validation table of the first picture's size.
  void start_over(const cv::Size& size) {
    size_ = size;
    edge_drawing_ = cv::ximgproc::createEdgeDrawing();
    edge_drawing_->params.Sigma = kSigmaPx;
  }

  // OpenCV 4.6 writes out of bounds if an edge has more pixels than this, and if almost no straight
  // segments remain besides arcs (compare opencv_contrib issue 3704). Segments are counted only if
  // there are few edges, where this is possible and cheap. As a consequence, a single ellipse below
  // about 18 px in an otherwise empty picture is missed.
  [[nodiscard]] bool is_safe() {
    const std::size_t max_pixels = 8 * static_cast<std::size_t>(size_.width + size_.height);
    const auto edges = edge_drawing_->getSegments();
    for (const auto& edge : edges) {
      if (edge.size() >= max_pixels) return false;
    }
    if (edges.size() > kManyEdges) return true;
    const auto params = edge_drawing_->params;
    edge_drawing_->params.MinLineLength = kPiecePx;
    edge_drawing_->params.NFAValidation = false;
    edge_drawing_->detectLines(pieces_);
    edge_drawing_->params = params;
    return pieces_.size() >= kMinPieces;
  }

  static constexpr std::size_t kManyEdges = 64;
  static constexpr std::size_t kMinPieces = 8;
  static constexpr int kPiecePx = 6;  // value used by detectEllipses()
  static constexpr float kSigmaPx = 1.5F;

  cv::Size size_;
  cv::Ptr<cv::ximgproc::EdgeDrawing> edge_drawing_;
  std::vector<cv::Vec4f> pieces_;
  std::vector<cv::Vec6d> found_;
};

// Finds circles only. Smoothing and parameters follow OpenCV's documentation, which does not
// specify minDist. At 1 px each circle is reported many times; that takes ten times as long and
// finds fewer targets. On AirLab, 20 px finds 25 of 603 targets, of which 74 have an axis ratio
// below 1.25. Edge thresholds of 150 and 500 find 28 and 27, and on rendered approaches 96 and 97
// of 150 instead of 98. 40 px or a perfectness of 0.8 find no more.
class HoughCirclesPeer final : public Peer {
  void search(const cv::Mat& picture, const ellipse::Thresholds& limits) override {
    cv::GaussianBlur(picture, smooth_, {7, 7}, 1.5);
    found_.clear();  // OpenCV 4.6 does not clear the output if it finds nothing
    cv::HoughCircles(smooth_,
                     found_,
                     cv::HOUGH_GRADIENT_ALT,
                     1.5,    // dp
                     20.0,   // minDist
                     300.0,  // param1: edges
                     0.9,    // param2: perfectness
                     static_cast<int>(limits.min_axis_px / 2.0),
                     static_cast<int>(std::ceil(limits.max_axis_px / 2.0)));
    for (const cv::Vec3f& f : found_) add(ellipse_of_axes(f[0], f[1], f[2], f[2], 0.0), limits);
  }

  cv::Mat smooth_;
  std::vector<cv::Vec3f> found_;
};

// The common approach: Canny, contours, fitEllipse(). An ellipse is accepted if its contour's mean
// distance is at most 0.5 px: 582 of the 603 AirLab targets, and fewer with Canny thresholds of 40
// and 80. The other common test compares areas and rejects every open contour: 572.
class CannyFitPeer final : public Peer {
  void search(const cv::Mat& picture, const ellipse::Thresholds& limits) override {
    cv::GaussianBlur(picture, smooth_, {5, 5}, 0.0);
    cv::Canny(smooth_, edges_, 50, 150);
    cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const auto& contour : contours_) {
      if (contour.size() < kMinContourPx) continue;
      const cv::RotatedRect box = cv::fitEllipse(contour);
      const auto e = ellipse_of_axes(box.center.x,
                                     box.center.y,
                                     box.size.width / 2.0,
                                     box.size.height / 2.0,
                                     box.angle * kRadiansPerDegree);
      if (!e || !limits.accepts_axes(*e) || mean_distance_px(contour, *e) > kMaxDistancePx) {
        continue;
      }
      add({*e, 0.0, 0.0, static_cast<double>(contour.size())});
    }
  }

  static double mean_distance_px(const std::vector<cv::Point>& contour, const ellipse::Ellipse& e) {
    double sum = 0.0;
    for (const cv::Point& p : contour) sum += std::abs(ellipse::sampson_distance(e, {p.x, p.y}));
    return sum / static_cast<double>(contour.size());
  }

  static constexpr std::size_t kMinContourPx = 50;
  static constexpr double kMaxDistancePx = 0.5;

  cv::Mat smooth_;
  cv::Mat edges_;
  std::vector<std::vector<cv::Point>> contours_;
};

// Canny thresholds of 50 and 150 add ground texture: 278 of the 603 AirLab targets instead of 437.
class RandomizedHoughPeer final : public Peer {
  void search(const cv::Mat& picture, const ellipse::Thresholds& limits) override {
    cv::GaussianBlur(picture, smooth_, {5, 5}, 0.0);
    cv::spatialGradient(smooth_, gradient_x_, gradient_y_);
    cv::Canny(gradient_x_, gradient_y_, edges_, 100, 250, true);
    pixels_.clear();
    for (int y = 0; y < edges_.rows; ++y) {
      const auto* row = edges_.ptr(y);
      for (int x = 0; x < edges_.cols; ++x) {
        if (row[x] != 0) pixels_.push_back(edge_pixel(x, y));
      }
    }
    for (const ellipse::Detection& d : hough_.find(pixels_, limits)) add(d);
  }

  [[nodiscard]] EdgePixel edge_pixel(int x, int y) const {
    const float gx = gradient_x_.at<short>(y, x);
    const float gy = gradient_y_.at<short>(y, x);
    const float norm = std::hypot(gx, gy);
    const float scale = norm > 0.0F ? 1.0F / norm : 0.0F;
    return {static_cast<float>(x), static_cast<float>(y), gx * scale, gy * scale};
  }

  cv::Mat smooth_;
  cv::Mat gradient_x_;
  cv::Mat gradient_y_;
  cv::Mat edges_;
  std::vector<EdgePixel> pixels_;
  RandomizedHough hough_;
};

constexpr std::array kPeerNames = {
    "edge-drawing", "hough-circles", "canny-fit", "randomized-hough"};

}  // namespace

std::span<const char* const> peer_names() {
  return kPeerNames;
}

std::unique_ptr<ellipse::Detector> make_peer(std::string_view name) {
  if (name == "edge-drawing") return std::make_unique<EdgeDrawingPeer>();
  if (name == "hough-circles") return std::make_unique<HoughCirclesPeer>();
  if (name == "canny-fit") return std::make_unique<CannyFitPeer>();
  if (name == "randomized-hough") return std::make_unique<RandomizedHoughPeer>();
  throw std::invalid_argument("unknown peer \"" + std::string(name) + "\"");
}

}  // namespace evaluate
