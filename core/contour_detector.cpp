// SPDX-License-Identifier: MIT
#include "core/contour_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/ellipse_fit.hpp"
#include "core/overlap.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kSmoothingPx = 1.0;
constexpr double kNoiseQuantile = 0.3;
constexpr double kHighOverNoise = 5.0;
constexpr double kLowOverHigh = 0.5;
constexpr double kLeastHigh = 1.0;  // [grey levels / px], above the steps of rounding

constexpr double kSobelGain =
    8.0;  // Sobel's 3 x 3 kernels weigh a slope of 1 grey level / px by 8.
constexpr int kHistogramBins = 2048;

// max(|x|, |y|) + 3/8 min(|x|, |y|): the Euclidean norm within 7 %.
int approximate_norm(int x, int y) {
  const int larger = std::max(std::abs(x), std::abs(y));
  const int smaller = std::min(std::abs(x), std::abs(y));
  return larger + 3 * smaller / 8;
}

// The noise of the gradient, from a quantile so low that edges have no part in it. The gradient of
// noise is Rayleigh distributed, whose quantile q is sigma sqrt(-2 ln(1 - q)) [Rosin1997].
double gradient_noise(const cv::Mat& gx, const cv::Mat& gy, std::vector<int>& histogram) {
  histogram.assign(kHistogramBins, 0);
  int samples = 0;
  for (int y = 0; y < gx.rows; y += 4) {
    const auto* row_x = gx.ptr<short>(y);
    const auto* row_y = gy.ptr<short>(y);
    for (int x = y / 4 % 2; x < gx.cols; x += 2, ++samples) {
      ++histogram[std::min(approximate_norm(row_x[x], row_y[x]), kHistogramBins - 1)];
    }
  }
  int quantile = 0;
  int below = histogram[0];
  while (below < kNoiseQuantile * samples && quantile < kHistogramBins - 1) {
    below += histogram[++quantile];
  }
  return quantile / std::sqrt(-2.0 * std::log(1.0 - kNoiseQuantile));
}

// [Keipour2021] II.2: the least-squares ellipse of one contour.
std::optional<Ellipse> fit_contour(std::span<const cv::Point> contour) {
  const cv::Point& first = contour.front();
  Moments moments(Eigen::Vector2d(first.x, first.y));
  for (const cv::Point& pixel : contour) moments.add(Eigen::Vector2d(pixel.x, pixel.y));
  return fit_ellipse(moments);
}

// [Keipour2021] Algorithm 1, the body of its loop: every rejection in the paper's order.
std::optional<Detection> examine(std::span<const cv::Point> contour,
                                 const ImageView& thick_edges,
                                 const Thresholds& limits) {
  const auto pixels = static_cast<double>(contour.size());
  if (pixels < limits.min_contour_size) return std::nullopt;

  const std::optional<Ellipse> e = fit_contour(contour);
  if (!e) return std::nullopt;
  if (2.0 * e->semi_major > limits.max_axis_px) return std::nullopt;
  if (2.0 * e->semi_minor < limits.min_axis_px) return std::nullopt;
  if (e->aspect_ratio() > limits.max_axis_ratio) return std::nullopt;

  const double on_ellipse = contour_overlap(contour, *e);
  if (on_ellipse < limits.contour_overlap) return std::nullopt;
  const double on_edges = ellipse_overlap(*e, thick_edges);
  if (on_edges < limits.ellipse_overlap) return std::nullopt;
  return Detection{*e, on_ellipse, on_edges, on_ellipse * on_edges * pixels};
}

struct Gradient {
  const cv::Mat& x;
  const cv::Mat& y;

  [[nodiscard]] bool has_neighbours(const cv::Point& p) const {
    return p.x > 0 && p.y > 0 && p.x + 1 < x.cols && p.y + 1 < x.rows;
  }
  [[nodiscard]] double norm(int column, int row) const {
    return std::hypot(x.at<short>(row, column), y.at<short>(row, column));
  }
};

// Where the gradient has its crest, across the edge through a pixel of it: the vertex of the
// parabola through three pixels along the axis closest to the gradient [Devernay1995] 2.
Eigen::Vector2d crest(const Gradient& gradient, const cv::Point& p) {
  const bool is_steep = std::abs(gradient.y.at<short>(p)) > std::abs(gradient.x.at<short>(p));
  const int dx = is_steep ? 0 : 1;
  const int dy = is_steep ? 1 : 0;
  const double before = gradient.norm(p.x - dx, p.y - dy);
  const double here = gradient.norm(p.x, p.y);
  const double after = gradient.norm(p.x + dx, p.y + dy);
  const double curvature = before - 2.0 * here + after;
  if (curvature >= 0.0) return {p.x, p.y};
  const double offset = std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
  return {p.x + dx * offset, p.y + dy * offset};
}

// The ellipse once more, through the crests at those pixels of its contour that lie on it: free of
// what else hangs on the contour, and finer than pixels.
Ellipse refined(const Ellipse& e, std::span<const cv::Point> contour, const Gradient& gradient) {
  Moments moments(e.center());
  for (const cv::Point& pixel : contour) {
    if (!gradient.has_neighbours(pixel)) continue;
    const Eigen::Vector2d point = crest(gradient, pixel);
    if (std::abs(sampson_distance(e, point)) <= kOverlapTolerancePx) moments.add(point);
  }
  return fit_ellipse(moments).value_or(e);
}

ImageView view_of(const cv::Mat& mat) {
  return {mat.data, mat.cols, mat.rows, static_cast<std::ptrdiff_t>(mat.step)};
}

}  // namespace

void ContourDetector::detect_edges(const ImageView& luma, const Thresholds& thresholds) {
  const cv::Mat picture(luma.height,
                        luma.width,
                        CV_8UC1,
                        const_cast<std::uint8_t*>(luma.data),
                        static_cast<std::size_t>(luma.stride));
  cv::GaussianBlur(picture, smooth_, {5, 5}, kSmoothingPx, kSmoothingPx, cv::BORDER_REPLICATE);
  cv::spatialGradient(smooth_, gradient_x_, gradient_y_, 3, cv::BORDER_REPLICATE);

  double high = kSobelGain * thresholds.edge_high;
  if (high == 0.0) {
    high = std::max(kSobelGain * kLeastHigh,
                    kHighOverNoise * gradient_noise(gradient_x_, gradient_y_, histogram_));
  }
  const double low =
      thresholds.edge_low == 0.0 ? kLowOverHigh * high : kSobelGain * thresholds.edge_low;
  cv::Canny(gradient_x_, gradient_y_, edges_, std::min(low, high), high, true);
}

std::span<const Detection> ContourDetector::detect(const ImageView& luma,
                                                   const Thresholds& thresholds) {
  detections_.clear();
  if (luma.empty()) return detections_;
  detect_edges(luma, thresholds);
  cv::dilate(edges_, thick_edges_, cv::Mat());
  cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  for (const std::vector<cv::Point>& contour : contours_) {
    auto detection = examine(contour, view_of(thick_edges_), thresholds);
    if (!detection) continue;
    detection->ellipse = refined(detection->ellipse, contour, {gradient_x_, gradient_y_});
    detections_.push_back(*detection);
  }
  return detections_;
}

}  // namespace ellipse
