// SPDX-License-Identifier: MIT
#include "examples/evaluate/evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <ostream>
#include <stdexcept>

#include "core/scene/random.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

using Clock = std::chrono::steady_clock;

// Times cv::Canny and cv::findContours on a smoothed picture: the minimum cost of any contour-based
// method.
class Reference {
 public:
  void smooth(const cv::Mat& picture) { cv::GaussianBlur(picture, smooth_, {5, 5}, 1.0); }

  double run_ms() {
    const auto start = Clock::now();
    cv::Canny(smooth_, edges_, 40, 80);
    cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

 private:
  cv::Mat smooth_;
  cv::Mat edges_;
  std::vector<std::vector<cv::Point>> contours_;
};

Result judged(const Answer& answer, const SeenFrame& seen, double reference_ms, Rule rule) {
  Result result;
  result.answer = answer.target;
  result.tracker = answer.tracker;
  result.processing_ms = answer.processing_ms;
  result.reference_ms = reference_ms;
  result.scale = answer.scale;
  result.is_given = answer.is_given;
  result.outcome = answer.is_given ? Outcome::kNotJudged
                                   : judge(answer.target, seen.frame->truth, seen.size, rule);
  if (result.outcome == Outcome::kTruePositive) {
    const auto truth = matched_ellipse(*answer.target, seen.frame->truth, seen.size, rule);
    result.centre_error_px = (answer.target->center() - truth->center()).norm();
  }
  return result;
}

class Run {
 public:
  Run(const std::vector<std::unique_ptr<Method>>& methods, Rule rule, bool wants_all)
      : methods_(methods), rule_(rule), wants_all_(wants_all) {
    for (const auto& method : methods) evaluation_.methods.push_back({method->name(), {}, {}});
    answers_.resize(methods.size());
    order_.resize(methods.size() + 1);  // the last index is the reference
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  void process(const Sequence& sequence, const Frame& frame) {
    cv::Mat picture;
    try {
      picture = sequence.pictures->picture(frame);
    } catch (const std::runtime_error& error) {
      evaluation_.problems.emplace_back(error.what());
      ++evaluation_.missing_frames;
      return;
    }
    const SeenFrame seen{
        &sequence, &frame, {picture.cols, picture.rows, sequence.distortion.get()}};
    // The order is random because each method leaves its data in the caches for the next one.
    shuffle();
    double reference_ms = 0.0;
    for (const std::size_t i : order_) {
      reference_.smooth(picture);  // also loads the picture into the caches for the methods
      if (i == methods_.size()) {
        reference_ms = reference_.run_ms();
      } else {
        answers_[i] = methods_[i]->find(frame, picture, frame.pts_ns);
      }
    }
    for (std::size_t i = 0; i < methods_.size(); ++i) {
      if (seen.size.distortion != nullptr && answers_[i].target && !methods_[i]->knows_lens()) {
        answers_[i].target = seen.size.distortion->to_ideal(*answers_[i].target);
      }
      evaluation_.methods[i].results.push_back(judged(answers_[i], seen, reference_ms, rule_));
      if (wants_all_) compare_all_of(i, seen);
    }
    evaluation_.frames.push_back(seen);
  }

  [[nodiscard]] Evaluation& evaluation() { return evaluation_; }

 private:
  void shuffle() {
    for (std::size_t i = order_.size(); i > 1; --i) {
      std::swap(order_[i - 1],
                order_[static_cast<std::size_t>(random_.below(static_cast<int>(i)))]);
    }
  }

  void compare_all_of(std::size_t method, const SeenFrame& seen) {
    auto found = methods_[method]->all_found();
    if (!found) return;
    if (seen.size.distortion != nullptr && !methods_[method]->knows_lens()) {
      for (ellipse::Ellipse& e : *found) e = seen.size.distortion->to_ideal(e);
    }
    evaluation_.methods[method].all.push_back(compare_all(*found, seen.frame->truth, seen.size));
  }

  const std::vector<std::unique_ptr<Method>>& methods_;
  Rule rule_;
  bool wants_all_;
  Reference reference_;
  Evaluation evaluation_;
  ellipse::Random random_{1};
  std::vector<std::size_t> order_;
  std::vector<Answer> answers_;
};

// As in the JSON lines of ellipsejson.
const char* nick_of(ellipse::TrackerState state) {
  switch (state) {
    case ellipse::TrackerState::kSearching:
      return "searching";
    case ellipse::TrackerState::kConfirming:
      return "confirming";
    case ellipse::TrackerState::kFollowing:
      return "following";
    case ellipse::TrackerState::kCoasting:
      return "coasting";
  }
  return "unknown";
}

void add_new(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

Evaluation evaluate(const std::vector<Sequence>& sequences,
                    const std::vector<std::unique_ptr<Method>>& methods,
                    Rule rule,
                    const std::function<bool(const Frame&)>& advance,
                    bool wants_all) {
  Run run(methods, rule, wants_all);
  Evaluation& evaluation = run.evaluation();
  for (const Sequence& sequence : sequences) evaluation.planned_frames += sequence.frames.size();
  for (const Sequence& sequence : sequences) {
    for (const auto& method : methods) method->start(sequence.distortion.get());
    for (const Frame& frame : sequence.frames) {
      run.process(sequence, frame);
      evaluation.is_interrupted = !advance(frame);
      if (evaluation.is_interrupted) return std::move(evaluation);
    }
  }
  return std::move(evaluation);
}

Measures measures_of(const Evaluation& evaluation,
                     std::size_t method,
                     const std::function<bool(const SeenFrame&)>& claim) {
  Measures measures;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    if (claim(evaluation.frames[i])) measures.add(evaluation.methods[method].results[i]);
  }
  return measures;
}

std::vector<std::string> datasets_of(const Evaluation& evaluation) {
  std::vector<std::string> names;
  for (const SeenFrame& seen : evaluation.frames) add_new(names, seen.sequence->dataset);
  return names;
}

std::vector<std::string> sequences_of(const Evaluation& evaluation, const std::string& dataset) {
  std::vector<std::string> names;
  for (const SeenFrame& seen : evaluation.frames) {
    if (seen.sequence->dataset == dataset) add_new(names, seen.sequence->name);
  }
  return names;
}

void write_frames(std::ostream& out, const Evaluation& evaluation, std::size_t method) {
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    const SeenFrame& seen = evaluation.frames[i];
    const Result& result = evaluation.methods[method].results[i];
    if (!seen.frame->truth.is_labelled) continue;
    out << "{\"dataset\":" << std::quoted(seen.sequence->dataset)
        << ",\"image\":" << std::quoted(seen.frame->name) << ",\"pts_ns\":" << seen.frame->pts_ns
        << ",\"size\":[" << seen.size.width << ',' << seen.size.height << "],\"target\":";
    if (result.answer) {
      const ellipse::Ellipse& e = *result.answer;
      out << '[' << e.cx << ',' << e.cy << ',' << e.semi_major << ',' << e.semi_minor << ','
          << e.angle_rad << "],\"scale\":" << result.scale;
    } else {
      out << "null";
    }
    if (result.tracker) {
      out << ",\"tracker\":\"" << nick_of(result.tracker->state) << '"';
      if (result.tracker->probability) out << ",\"probability\":" << *result.tracker->probability;
    }
    out << ",\"visible\":" << visible_part(seen.frame->truth, seen.size) << ",\"ms\":["
        << json_number(result.processing_ms) << "],\"outcome\":\""
        << kOutcomeNames[static_cast<std::size_t>(result.outcome)] << "\"}\n";
  }
}

}  // namespace evaluate
