// SPDX-License-Identifier: MIT
#include "examples/evaluate/measures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace evaluate {
namespace {

double ratio(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : kNaN;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class Lists>
std::vector<double> joined(const Lists& lists) {
  std::vector<double> all;
  for (const std::vector<double>& list : lists) append(all, list);
  return all;
}

bool is_within_tenth(double answer, double truth) {
  return std::abs(answer - truth) <= 0.1 * truth;
}

}  // namespace

double visible_part(const TrueEllipse& truth, const FrameSize& frame) {
  return truth.visible_fraction.value_or(
      ellipse::visible_fraction(truth.ellipse, frame.width, frame.height));
}

double visible_part(const Truth& truth, const FrameSize& frame) {
  return truth.target ? visible_part(TrueEllipse{*truth.target, truth.visible_fraction}, frame)
                      : 0.0;
}

bool is_in_view(const TrueEllipse& truth, const FrameSize& frame) {
  if (visible_part(truth, frame) > 0.0) return true;
  // Without perimeter inside, the frame is entirely inside or entirely outside the ellipse.
  const Eigen::Vector2d middle(0.5 * (frame.width - 1), 0.5 * (frame.height - 1));
  return sampson_distance(truth.ellipse, middle) < 0.0;
}

bool is_in_view(const Truth& truth, const FrameSize& frame) {
  return std::ranges::any_of(ellipses_of(truth),
                             [&](const TrueEllipse& one) { return is_in_view(one, frame); });
}

double iou_of(const ellipse::Ellipse& answer,
              const ellipse::Ellipse& truth,
              const FrameSize& frame) {
  return frame.distortion != nullptr
             ? frame.distortion->iou(answer, truth)
             : ellipse::iou_inside(answer, truth, frame.width, frame.height);
}

bool is_right(const ellipse::Ellipse& answer,
              const ellipse::Ellipse& truth,
              const FrameSize& frame,
              Rule rule) {
  if (rule == Rule::kIou) return iou_of(answer, truth, frame) >= kMinIou;
  const double apart = (answer.center() - truth.center()).norm();
  return apart <= 0.1 * 2.0 * truth.semi_minor &&
         is_within_tenth(answer.semi_major, truth.semi_major) &&
         is_within_tenth(answer.semi_minor, truth.semi_minor);
}

std::optional<ellipse::Ellipse> matched_ellipse(const ellipse::Ellipse& answer,
                                                const Truth& truth,
                                                const FrameSize& frame,
                                                Rule rule) {
  std::optional<ellipse::Ellipse> nearest;
  const auto distance = [&](const ellipse::Ellipse& e) {
    return (answer.center() - e.center()).norm();
  };
  for (const TrueEllipse& one : ellipses_of(truth)) {
    if (nearest && distance(one.ellipse) >= distance(*nearest)) continue;
    if (visible_part(one, frame) > 0.0 && is_right(answer, one.ellipse, frame, rule)) {
      nearest = one.ellipse;
    }
  }
  return nearest;
}

Outcome judge(const std::optional<ellipse::Ellipse>& answer,
              const Truth& truth,
              const FrameSize& frame,
              Rule rule) {
  if (!truth.is_labelled) return Outcome::kNotJudged;
  if (!is_in_view(truth, frame)) {
    return answer ? Outcome::kFalsePositive : Outcome::kTrueNegative;
  }
  const auto is_visible = [&](const TrueEllipse& one) {
    return visible_part(one, frame) >= kMinVisible;
  };
  const bool may_be_missed = std::ranges::none_of(ellipses_of(truth), is_visible);
  if (!answer) return may_be_missed ? Outcome::kTrueNegative : Outcome::kFalseNegative;
  if (matched_ellipse(*answer, truth, frame, rule)) return Outcome::kTruePositive;
  return may_be_missed ? Outcome::kNotJudged : Outcome::kWrong;
}

void Measures::add(const Result& result) {
  const auto outcome = static_cast<std::size_t>(result.outcome);
  ++counts_[outcome];
  if (std::isfinite(result.processing_ms)) times_ms_[outcome].push_back(result.processing_ms);
  reference_ms_.push_back(result.reference_ms);
  if (result.outcome != Outcome::kTruePositive) return;
  const int log2_scale = std::bit_width(static_cast<unsigned>(result.scale)) - 1;
  const int slot = std::clamp(log2_scale, 0, kScales - 1);
  centre_errors_px_[static_cast<std::size_t>(slot)].push_back(result.centre_error_px);
}

int Measures::count(Outcome outcome) const {
  return counts_[static_cast<std::size_t>(outcome)];
}

int Measures::judged() const {
  return frames() - count(Outcome::kNotJudged);
}

int Measures::frames() const {
  return std::accumulate(counts_.begin(), counts_.end(), 0);
}

double Measures::accuracy() const {
  return ratio(count(Outcome::kTruePositive) + count(Outcome::kTrueNegative), judged());
}

double Measures::precision() const {
  const int right = count(Outcome::kTruePositive);
  return ratio(right, right + count(Outcome::kFalsePositive) + count(Outcome::kWrong));
}

double Measures::recall() const {
  const int right = count(Outcome::kTruePositive);
  return ratio(right, right + count(Outcome::kFalseNegative) + count(Outcome::kWrong));
}

// The harmonic mean of precision and recall, in a form that is defined without right answers.
double Measures::f1() const {
  const int right = count(Outcome::kTruePositive);
  return ratio(2 * right,
               2 * (right + count(Outcome::kWrong)) + count(Outcome::kFalsePositive) +
                   count(Outcome::kFalseNegative));
}

const std::vector<double>& Measures::times_ms(Outcome outcome) const {
  return times_ms_[static_cast<std::size_t>(outcome)];
}

std::vector<double> Measures::all_times_ms() const {
  return joined(times_ms_);
}

const std::vector<double>& Measures::centre_errors_px(int log2_scale) const {
  return centre_errors_px_[static_cast<std::size_t>(log2_scale)];
}

std::vector<double> Measures::all_centre_errors_px() const {
  return joined(centre_errors_px_);
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return kNaN;
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace evaluate
