// SPDX-License-Identifier: MIT
#include "core/detection/contours/contour_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/detection/contours/overlap.hpp"
#include "core/detection/detection_trace.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/noise.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kSmoothingPx = 1.0;
constexpr double kHighOverNoise = 5.0;
constexpr double kLowOverHigh = 0.4;
constexpr double kMinHigh = 1.0;  // [grey levels / px], above quantization noise

// At a corner, the chords over this many pixels before and after it differ by more than 45 degrees.
constexpr std::size_t kCornerReach = 5;
constexpr double kCornerCosine = 0.7;

constexpr std::size_t kMaxDetections = 256;  // bounds the time

constexpr Tolerance kSameFit{.px = 0.75};

constexpr int kSteps = 2;  // Gauss-Newton steps on the own contour, and on all edges

// Response of the 3 x 3 Sobel kernels to a slope of one grey level per pixel.
constexpr double kSobelGain = 8.0;

// max(|x|, |y|) + 3/8 min(|x|, |y|): the Euclidean norm within 7 %.
int approximate_norm(int x, int y) {
  const int larger = std::max(std::abs(x), std::abs(y));
  const int smaller = std::min(std::abs(x), std::abs(y));
  return larger + 3 * smaller / 8;
}

double gradient_noise(const cv::Mat& gx, const cv::Mat& gy, std::vector<int>& histogram) {
  histogram.assign(static_cast<std::size_t>(kSobelGain * 255.0), 0);
  int samples = 0;
  const int step = std::max(1, gx.rows / kNoiseRows);
  for (int y = 0; y < gx.rows; y += step) {
    const auto* row_x = gx.ptr<short>(y);
    const auto* row_y = gy.ptr<short>(y);
    for (int x = y / step % 2; x < gx.cols; x += 2, ++samples) {
      ++histogram[static_cast<std::size_t>(approximate_norm(row_x[x], row_y[x]))];
    }
  }
  return noise_of(static_cast<double>(noise_bin(histogram, samples)) + 0.5);
}

// The edge map and its gradient.
struct EdgeField {
  const cv::Mat& edges;
  const cv::Mat& gradient_x;
  const cv::Mat& gradient_y;

  // Smoothing displaces the edges nearer to the border.
  [[nodiscard]] bool is_inside(const cv::Point& p) const {
    const int border = GradientMap::kBorder;  // these kernels reach as far
    return p.x >= border && p.y >= border && p.x < edges.cols - border && p.y < edges.rows - border;
  }
  [[nodiscard]] Eigen::Vector2d gradient(const cv::Point& p) const {
    return {gradient_x.at<short>(p), gradient_y.at<short>(p)};
  }
};

// [Keipour2021] II.3b: the least-squares ellipse of one contour.
std::optional<Ellipse> fit_contour(std::span<const cv::Point> contour, const EdgeField& field) {
  const cv::Point& first = contour.front();
  Moments moments(Eigen::Vector2d(first.x, first.y));
  for (const cv::Point& pixel : contour) {
    if (field.is_inside(pixel)) moments.add(Eigen::Vector2d(pixel.x, pixel.y));
  }
  return fit_ellipse(moments);
}

// The sub-pixel gradient maximum across the edge through a pixel: the vertex of the parabola
// through three pixels along the axis closest to the gradient [Devernay1995] 2.
Eigen::Vector2d maximum(const EdgeField& field,
                        const cv::Point& p,
                        const Eigen::Vector2d& gradient) {
  const bool is_steep = std::abs(gradient.y()) > std::abs(gradient.x());
  const cv::Point across = is_steep ? cv::Point(0, 1) : cv::Point(1, 0);
  const double before = field.gradient(p - across).norm();
  const double here = gradient.norm();
  const double after = field.gradient(p + across).norm();
  const double curvature = before - 2.0 * here + after;
  const double offset =
      curvature < 0.0 ? std::clamp(parabola_vertex(before, here, after), -0.5, 0.5) : 0.0;
  return {p.x + across.x * offset, p.y + across.y * offset};
}

// One Gauss-Newton step on the gradient maxima of the ellipse's own contour.
std::optional<Ellipse> refined_on_contour(const Ellipse& e,
                                          std::span<const cv::Point> contour,
                                          const EdgeField& field) {
  GeometricFit fit(e);
  for (const cv::Point& pixel : contour) {
    if (!field.is_inside(pixel)) continue;
    const Eigen::Vector2d point = maximum(field, pixel, field.gradient(pixel));
    const PerimeterOffset offset = fit.offset_of(point);
    if (std::abs(offset.distance_px) <= kOverlapTolerancePx) fit.add(offset);
  }
  return fit.solve();
}

// One Gauss-Newton step on the gradient maxima of all edges along the ellipse, of any contour.
std::optional<Ellipse> refined_on_edges(const Ellipse& e, const EdgeField& field) {
  GeometricFit fit(e);
  walk_perimeter(e, [&](const PerimeterStep& step) {
    for (int k = -1; k <= 1; ++k) {
      const Eigen::Vector2d at = step.point + k * step.normal();
      const cv::Point pixel(cvRound(at.x()), cvRound(at.y()));
      if (!field.is_inside(pixel) || field.edges.at<std::uint8_t>(pixel) == 0) continue;
      const Eigen::Vector2d gradient = field.gradient(pixel);
      const double along = gradient.dot(step.normal());
      if (along * along < kMinSquaredCosine * gradient.squaredNorm()) continue;
      fit.add(maximum(field, pixel, gradient));
    }
  });
  return fit.solve();
}

// Refines an ellipse to sub-pixel accuracy: ignores attached branches of its contour and includes
// its edges in other contours.
Ellipse refined(Ellipse e, std::span<const cv::Point> contour, const EdgeField& field) {
  for (int i = 0; i < kSteps; ++i) e = refined_on_contour(e, contour, field).value_or(e);
  for (int i = 0; i < kSteps; ++i) e = refined_on_edges(e, field).value_or(e);
  return e;
}

Detection scored(const Ellipse& e, double contour_overlap, const ImageView& thick_edges) {
  const PerimeterSupport support = perimeter_support(e, thick_edges);
  return {e, contour_overlap, support.ellipse_overlap(), contour_overlap * support.on_edge_px};
}

bool is_known(const Ellipse& e, std::span<const Detection> known) {
  return std::any_of(known.begin(), known.end(), [&](const Detection& other) {
    return is_same(e, other.ellipse, kSameFit);
  });
}

// [Keipour2021] Algorithm 1, the body of its loop after the contour's size: every rejection in the
// paper's order. `found` receives the ellipse as soon as it is fitted.
Verdict examine(std::span<const cv::Point> contour,
                const EdgeField& field,
                const ImageView& thick_edges,
                const Thresholds& limits,
                std::span<const Detection> known,
                Detection& found) {
  const std::optional<Ellipse> e = fit_contour(contour, field);
  if (!e) return {Reason::kNoEllipse};
  found.ellipse = *e;
  Verdict verdict = limits.judge_axes_of(*e);
  if (!verdict.is_accepted()) return verdict;

  const double on_ellipse = contour_overlap(contour, *e);
  verdict = at_least(Reason::kContourOverlap, on_ellipse, limits.contour_overlap);
  if (!verdict.is_accepted()) return verdict;
  found = scored(*e, on_ellipse, thick_edges);
  verdict = at_least(Reason::kEllipseOverlap, found.ellipse_overlap, limits.ellipse_overlap);
  if (!verdict.is_accepted()) return verdict;
  if (is_known(*e, known)) return {Reason::kKnown};  // from the other side of the same edge
  const Detection better = scored(refined(*e, contour, field), on_ellipse, thick_edges);
  const bool is_better =
      better.ellipse_overlap >= found.ellipse_overlap && limits.accepts_axes(better.ellipse);
  if (is_better) found = better;
  return {};
}

// Whether a contour turns sharply at one of its pixels.
bool is_corner(std::span<const cv::Point> contour, std::size_t i) {
  const cv::Point before = contour[i] - contour[i - kCornerReach];
  const cv::Point after = contour[i + kCornerReach] - contour[i];
  const double dot = before.dot(after);
  return dot <= 0.0 ||
         dot * dot < kCornerCosine * kCornerCosine * before.dot(before) * after.dot(after);
}

// Calls use(part) for each part of a contour between its corners.
template <class Use>
void for_each_smooth_part(std::span<const cv::Point> contour, const Use& use) {
  std::size_t begin = 0;
  for (std::size_t i = kCornerReach; i + kCornerReach < contour.size(); ++i) {
    if (!is_corner(contour, i)) continue;
    if (i > begin) use(contour.subspan(begin, i - begin));
    begin = i + 1;
  }
  if (begin > 0) use(contour.subspan(begin));
}

ImageView view_of(const cv::Mat& mat) {
  return {mat.data, mat.cols, mat.rows, static_cast<std::ptrdiff_t>(mat.step)};
}

TracedPiece traced(std::span<const cv::Point> contour, TracedPass& pass) {
  const std::size_t begin = pass.points.size();
  for (const cv::Point& pixel : contour) pass.points.push_back({pixel.x, pixel.y});
  return {begin, pass.points.size()};
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

  double high = thresholds.edge_high;
  if (high == 0.0) {
    const double noise = gradient_noise(gradient_x_, gradient_y_, histogram_) / kSobelGain;
    high = std::max(kMinHigh, kHighOverNoise * noise);
  }
  const double low = thresholds.edge_low == 0.0 ? kLowOverHigh * high : thresholds.edge_low;
  edge_thresholds_ = {std::min(low, high), high};
  cv::Canny(gradient_x_,
            gradient_y_,
            edges_,
            kSobelGain * edge_thresholds_.low,
            kSobelGain * edge_thresholds_.high,
            true);
}

// Trims to the kMaxDetections best once there are twice as many; bounds the time on any picture.
void ContourDetector::add_detection(const Detection& detection) {
  detections_.push_back(detection);
  if (detections_.size() < 2 * kMaxDetections) return;
  std::nth_element(detections_.begin(),
                   detections_.begin() + kMaxDetections,
                   detections_.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  detections_.resize(kMaxDetections);
}

void ContourDetector::trace_edges(const ImageView& luma) {
  trace_->clear();
  TracedPass& pass = trace_->begin_pass(luma, 1);
  pass.edge_low = edge_thresholds_.low;
  pass.edge_high = edge_thresholds_.high;
  pass.edges.assign(edges_.begin<std::uint8_t>(), edges_.end<std::uint8_t>());
}

// [Keipour2021] Algorithm 1, the loop's first test.
void ContourDetector::drop_short_contours(int min_size) {
  std::erase_if(contours_, [&](const auto& contour) {
    const auto length = static_cast<double>(contour.size());
    const Verdict verdict = at_least(Reason::kContourTooShort, length, min_size);
    if (trace_ != nullptr && !verdict.is_accepted()) {
      const TracedPiece piece = traced(contour, trace_->pass());
      trace_->pass().chains.push_back(piece);
      (void)trace_->add({&piece, 1}, {}, verdict);
    }
    return !verdict.is_accepted();
  });
}

void ContourDetector::try_contour(std::span<const cv::Point> contour,
                                  const Thresholds& thresholds,
                                  std::vector<TracedPiece> TracedPass::*stage) {
  const EdgeField field{edges_, gradient_x_, gradient_y_};
  Detection found;
  const Verdict verdict =
      examine(contour, field, view_of(thick_edges_), thresholds, detections_, found);
  if (trace_ != nullptr) {
    const bool has_ellipse = verdict.reason != Reason::kNoEllipse;
    const TracedPiece piece = traced(contour, trace_->pass());
    (trace_->pass().*stage).push_back(piece);
    found.candidate = trace_->add(
        {&piece, 1}, has_ellipse ? undistorted(lens_, found.ellipse) : std::nullopt, verdict);
  }
  if (verdict.is_accepted()) add_detection(found);
}

// Gaps and occluders join an ellipse's edge to others; tries the parts between corners.
void ContourDetector::try_parts(const Thresholds& thresholds) {
  for (const auto& contour : contours_) {
    for_each_smooth_part(contour, [&](std::span<const cv::Point> part) {
      if (std::ssize(part) >= static_cast<int>(ChainTracer::kMinLength))
        try_contour(part, thresholds, &TracedPass::arcs);
    });
  }
}

std::span<const Detection> ContourDetector::detect(const Picture& picture,
                                                   const Thresholds& thresholds) {
  const ImageView& luma = picture.luma;
  lens_ = picture.lens;
  detections_.clear();
  if (luma.empty()) {
    if (trace_ != nullptr) trace_->clear();
    return detections_;
  }
  detect_edges(luma, thresholds);
  if (trace_ != nullptr) trace_edges(luma);
  cv::dilate(edges_, thick_edges_, cv::Mat());
  cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  drop_short_contours(thresholds.min_contour_size);
  for (const auto& contour : contours_) try_contour(contour, thresholds, &TracedPass::chains);
  if (detections_.empty()) try_parts(thresholds);
  undistort_detections();
  if (trace_ != nullptr) trace_->report(detections_);
  return detections_;
}

std::optional<double> ContourDetector::log_odds_of(const Picture& picture,
                                                   const Ellipse& e,
                                                   const Thresholds& thresholds) {
  const auto in_picture = distorted(picture.lens, e);
  if (picture.luma.empty() || !in_picture) return std::nullopt;
  detect_edges(picture.luma, thresholds);
  cv::dilate(edges_, thick_edges_, cv::Mat());
  const double overlap = perimeter_support(*in_picture, view_of(thick_edges_)).ellipse_overlap();
  return log_odds(overlap) - log_odds(thresholds.ellipse_overlap);
}

// The paper has no lens model: the detections so far are ellipses of the distorted picture.
void ContourDetector::undistort_detections() {
  if (!lens_.is_distorted()) return;
  std::erase_if(detections_, [&](Detection& detection) {
    const auto ideal = undistorted(lens_, detection.ellipse);
    if (ideal) {
      detection.ellipse = *ideal;
    } else if (trace_ != nullptr) {
      trace_->revise(detection.candidate, {Reason::kNoEllipse});
    }
    return !ideal;
  });
}

}  // namespace ellipse
