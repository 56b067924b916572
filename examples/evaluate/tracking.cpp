// SPDX-License-Identifier: MIT
#include "examples/evaluate/tracking.hpp"

#include <cmath>
#include <limits>
#include <optional>

namespace evaluate {
namespace {

constexpr std::array kRangeBegins = {0.6, 0.3, 0.15, 0.05};

std::size_t range_of(double visible) {
  std::size_t range = 0;
  while (range < kRangeBegins.size() && visible < kRangeBegins[range]) ++range;
  return visible > 0.0 ? range : kVisibleRanges - 1;
}

// Accuracy of one answer.
struct Verdict {
  bool is_right = false;
  double centre_error_px = 0.0;
  double centre_error = std::numeric_limits<double>::infinity();  // in semi-major axes

  [[nodiscard]] bool is_near() const { return centre_error <= 0.05; }
  [[nodiscard]] bool is_good() const { return is_right || is_near(); }
};

Verdict verdict_on(const Result& result, const SeenFrame& seen) {
  if (!result.answer) return {};
  const auto matched = matched_ellipse(*result.answer, seen.frame->truth, seen.size, Rule::kIou);
  const ellipse::Ellipse truth = matched.value_or(*seen.frame->truth.target);
  const double error_px = (result.answer->center() - truth.center()).norm();
  // Unlike judge(), accepts a match with a target that encloses the frame.
  const bool is_matched = matched || is_right(*result.answer, truth, seen.size, Rule::kIou);
  return {is_matched, error_px, error_px / truth.semi_major};
}

// Processes one sequence at a time.
class Follower {
 public:
  explicit Follower(TrackingMeasures& measures) : measures_(measures) {}

  void add(const SeenFrame& seen, const Result& result) {
    if (!seen.frame->truth.is_labelled) return;
    if (result.is_given) ++measures_.given;
    const bool is_in_view = evaluate::is_in_view(seen.frame->truth, seen.size);
    if (is_in_view) {
      add_target(visible_part(seen.frame->truth, seen.size), verdict_on(result, seen), result);
    } else {
      add_empty(result);
    }
  }

  void end() {
    if (waited_ > 0) measures_.returns.push_back(std::numeric_limits<double>::infinity());
    waited_ = 0;
  }

 private:
  void add_empty(const Result& result) {
    ++measures_.empty_frames;
    measures_.locks_on_nothing += result.answer ? 1 : 0;
    end();
    has_begun_ = false;
    was_lost_ = true;
    was_visible_ = false;
  }

  void add_target(double visible, const Verdict& verdict, const Result& result) {
    const bool is_visible = visible >= kMinToStart;
    has_begun_ = has_begun_ || is_visible;
    if (!has_begun_) {
      if (result.answer && !verdict.is_good()) ++measures_.wrong_before;
      return;
    }
    if (is_visible) {
      if (!was_visible_ && was_lost_ && has_begun_before_) waited_ = 1;
      has_begun_before_ = true;
      add_return(verdict, result);
      was_lost_ = false;
    } else {
      end();
      was_lost_ = was_lost_ || !verdict.is_good();
    }
    was_visible_ = is_visible;
    if (!result.is_given) count(range_of(visible), verdict, result);
  }

  void add_return(const Verdict& verdict, const Result& result) {
    if (waited_ == 0) return;
    if (verdict.is_right && !result.is_given) measures_.returns.push_back(waited_);
    waited_ = verdict.is_right ? 0 : waited_ + 1;
  }

  void count(std::size_t range, const Verdict& verdict, const Result& result) {
    RangeCounts& counts = measures_.ranges[range];
    ++counts.frames;
    counts.right += verdict.is_right ? 1 : 0;
    counts.centre_5 += verdict.is_near() ? 1 : 0;
    counts.centre_2 += verdict.centre_error <= 0.02 ? 1 : 0;
    counts.none += result.answer ? 0 : 1;
    counts.wrong += result.answer && !verdict.is_good() ? 1 : 0;
    if (range == 0 && verdict.is_right) {
      measures_.centre_errors_px.push_back(verdict.centre_error_px);
    }
  }

  TrackingMeasures& measures_;
  bool has_begun_ = false;  // since the target was last out of view
  bool has_begun_before_ = false;
  bool was_visible_ = false;  // at least kMinToStart in the previous frame
  bool was_lost_ = false;     // since was_visible_ was last true
  int waited_ = 0;            // frames since the return; 0 = not waiting
};

}  // namespace

int TrackingMeasures::wrong() const {
  int sum = wrong_before;
  for (const RangeCounts& counts : ranges) sum += counts.wrong;
  return sum;
}

TrackingMeasures tracking_measures_of(const Evaluation& evaluation,
                                      std::size_t method,
                                      const std::string& dataset) {
  TrackingMeasures measures;
  const Sequence* sequence = nullptr;
  std::optional<Follower> follower;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    const SeenFrame& seen = evaluation.frames[i];
    if (seen.sequence->dataset != dataset) continue;
    const Result& result = evaluation.methods[method].results[i];
    if (seen.sequence != sequence) {
      if (follower) follower->end();
      follower.emplace(measures);
      sequence = seen.sequence;
    }
    follower->add(seen, result);
    if (std::isfinite(result.processing_ms)) measures.times_ms.push_back(result.processing_ms);
  }
  if (follower) follower->end();
  return measures;
}

}  // namespace evaluate
