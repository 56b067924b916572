// SPDX-License-Identifier: MIT
#include "examples/evaluate/source_results.hpp"

namespace evaluate {
namespace {

constexpr double kDefaultFramesPerSecond = 30.0;

std::vector<FrameCounts> frame_counts(const Evaluation& evaluation,
                                      std::size_t method,
                                      const std::string& dataset) {
  std::vector<FrameCounts> counts;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    if (evaluation.frames[i].sequence->dataset != dataset) continue;
    counts.push_back(counts_of(evaluation.methods[method].results[i].outcome));
  }
  return counts;
}

double frames_per_second(const Sequence& sequence) {
  const double seconds =
      1e-9 * static_cast<double>(sequence.frames.back().pts_ns - sequence.frames.front().pts_ns);
  return seconds > 0.0 ? static_cast<double>(sequence.frames.size() - 1) / seconds
                       : kDefaultFramesPerSecond;
}

std::optional<std::size_t> best_peer(const Evaluation& evaluation,
                                     const std::vector<SourceGrade>& methods) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (is_ours(evaluation.methods[i].name)) continue;
    if (!best || methods[i].grade > methods[*best].grade) best = i;
  }
  return best;
}

SourceResults results_on(const Evaluation& evaluation, const std::string& dataset) {
  SourceResults results;
  results.source = dataset;
  const SourceFrames source = source_frames(evaluation, dataset);
  std::vector<FrameCounts> first;
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    const std::vector<FrameCounts> counts = frame_counts(evaluation, i, dataset);
    if (i == 0) first = counts;
    const Scheme scheme = scheme_for(source, counts);
    SourceGrade method;
    method.counts = total(counts);
    method.grade = grade_of(method.counts);
    method.interval = grade_interval(source, scheme, counts);
    if (i > 0) {
      method.difference =
          difference_interval(source, longer(scheme, scheme_for(source, first)), counts, first);
    }
    results.frames = static_cast<int>(counts.size());
    results.has_target = results.has_target || method.counts.has_target();
    results.draws_sequences = scheme.draws_sequences;
    results.methods.push_back(method);
  }
  results.best_peer = best_peer(evaluation, results.methods);
  return results;
}

}  // namespace

FrameCounts counts_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kTruePositive:
      return {1, 1, 0, 0};
    case Outcome::kTrueNegative:
      return {1, 0, 0, 0};
    case Outcome::kFalsePositive:
      return {1, 0, 1, 0};
    case Outcome::kFalseNegative:
      return {1, 0, 0, 1};
    case Outcome::kWrong:
      return {1, 0, 1, 1};
    case Outcome::kNotJudged:
      return {};
  }
  return {};
}

FrameCounts source_counts(const Evaluation& evaluation,
                          std::size_t method,
                          const std::string& dataset) {
  return total(frame_counts(evaluation, method, dataset));
}

SourceFrames source_frames(const Evaluation& evaluation, const std::string& dataset) {
  SourceFrames source;
  const Sequence* last = nullptr;
  double rates = 0.0;
  for (const SeenFrame& seen : evaluation.frames) {
    if (seen.sequence->dataset != dataset) continue;
    if (seen.sequence != last) {
      source.sequence_lengths.push_back(0);
      rates += frames_per_second(*seen.sequence);
    }
    last = seen.sequence;
    ++source.sequence_lengths.back();
  }
  source.frames_per_second = rates / static_cast<double>(source.sequence_lengths.size());
  return source;
}

std::vector<SourceResults> source_results(const Evaluation& evaluation) {
  std::vector<SourceResults> all;
  if (evaluation.methods.empty()) return all;
  for (const std::string& dataset : datasets_of(evaluation)) {
    all.push_back(results_on(evaluation, dataset));
  }
  return all;
}

}  // namespace evaluate
