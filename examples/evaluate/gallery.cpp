// SPDX-License-Identifier: MIT
#include "examples/evaluate/gallery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/camera/lens_view.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

const cv::Scalar kTruthColor(90, 200, 60);
const cv::Scalar kAnswerColor(30, 130, 255);
constexpr int kSubPixelBits = 4;

void draw(cv::Mat& picture, const ellipse::Ellipse& e, const cv::Scalar& color) {
  if (!(e.semi_major < 16.0 * picture.cols)) return;  // OpenCV's coordinates would overflow
  const auto fixed = [](double value) {
    return static_cast<int>(std::lround(value * (1 << kSubPixelBits)));
  };
  cv::ellipse(picture,
              {fixed(e.cx), fixed(e.cy)},
              {fixed(e.semi_major), fixed(e.semi_minor)},
              e.angle_rad * 180.0 / std::numbers::pi,
              0.0,
              360.0,
              color,
              2,
              cv::LINE_AA,
              kSubPixelBits);
}

// Draws an ellipse of the ideal plane, distorted by the lens.
void draw_distorted(cv::Mat& picture,
                    const ellipse::Ellipse& e,
                    const ellipse::Lens& lens,
                    const cv::Scalar& color) {
  std::array<Eigen::Vector2d, 256> outline;
  ellipse::distorted_outline(lens, e, outline);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d& to = outline[(i + 1) % outline.size()];
    if (!from.allFinite() || !to.allFinite()) continue;
    const auto pixel = [](const Eigen::Vector2d& p) {
      return cv::Point(cvRound(p.x()), cvRound(p.y()));
    };
    cv::line(picture, pixel(from), pixel(to), color, 2, cv::LINE_AA);
  }
}

bool is_bad(Outcome outcome) {
  return outcome == Outcome::kWrong || outcome == Outcome::kFalsePositive ||
         outcome == Outcome::kFalseNegative;
}

// Larger is worse. Further bad frames of a sequence rank below the first ones of other sequences.
std::vector<double> badness(const Evaluation& evaluation,
                            std::size_t method,
                            const std::string& dataset) {
  std::vector<double> result;
  std::map<std::string, int> bad_frames;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    const Result& one = evaluation.methods[method].results[i];
    if (evaluation.frames[i].sequence->dataset != dataset) {
      result.push_back(0.0);
    } else if (is_bad(one.outcome)) {
      const int before = bad_frames[evaluation.frames[i].sequence->name]++;
      result.push_back(1e6 / (1.0 + before));
    } else {
      result.push_back(one.outcome == Outcome::kTruePositive ? one.centre_error_px : 0.0);
    }
  }
  return result;
}

Exhibit exhibit_of(const SeenFrame& seen, const Result& result) {
  Exhibit exhibit;
  cv::cvtColor(seen.sequence->pictures->picture(*seen.frame), exhibit.picture, cv::COLOR_GRAY2BGR);
  const auto show = [&](const ellipse::Ellipse& e, const cv::Scalar& color) {
    if (seen.size.distortion != nullptr) {
      draw_distorted(exhibit.picture, e, seen.size.distortion->lens(), color);
    } else {
      draw(exhibit.picture, e, color);
    }
  };
  for (const TrueEllipse& one : ellipses_of(seen.frame->truth)) show(one.ellipse, kTruthColor);
  if (result.answer) show(*result.answer, kAnswerColor);
  exhibit.caption = std::string(kOutcomeNames[static_cast<std::size_t>(result.outcome)]) + "  " +
                    seen.frame->name;
  if (result.outcome == Outcome::kTruePositive) {
    exhibit.caption += format(", centre %.2f px off", result.centre_error_px);
  }
  return exhibit;
}

}  // namespace

std::vector<Exhibit> worst_frames(const Evaluation& evaluation,
                                  std::size_t method,
                                  const std::string& dataset,
                                  std::size_t max_count) {
  const std::vector<double> bad = badness(evaluation, method, dataset);
  std::vector<std::size_t> order(bad.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(
      order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return bad[a] > bad[b]; });
  if (order.size() > max_count) order.resize(max_count);
  std::vector<Exhibit> exhibits;
  for (const std::size_t i : order) {
    if (!(bad[i] > 0.0)) break;
    exhibits.push_back(exhibit_of(evaluation.frames[i], evaluation.methods[method].results[i]));
  }
  return exhibits;
}

}  // namespace evaluate
