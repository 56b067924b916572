#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/resampling.hpp"

namespace evaluate {

/// The counts of a frame's outcome: a wrong target is a mistaken ellipse and a missed one.
[[nodiscard]] FrameCounts counts_of(Outcome outcome);

/// The sum of a method's counts over a source.
[[nodiscard]] FrameCounts source_counts(const Evaluation& evaluation,
                                        std::size_t method,
                                        const std::string& dataset);

/// What one method did on one source.
struct SourceGrade {
  double grade = 0.0;  ///< See grade_of().
  FrameCounts counts;
  Interval interval;
  /// From the first method. nullopt for the first method itself.
  std::optional<Interval> difference;
};

/// What all methods did on one source.
struct SourceResults {
  std::string source;
  int frames = 0;  ///< Judged or not.
  bool has_target = false;
  bool draws_sequences = false;          ///< How the intervals were made.
  std::vector<SourceGrade> methods;      ///< As in the evaluation.
  std::optional<std::size_t> best_peer;  ///< Of the methods that are not ours.
};

/// A source is a data set. In the order in which they were seen.
[[nodiscard]] std::vector<SourceResults> source_results(const Evaluation& evaluation);

/// How the sequences of a data set were seen.
[[nodiscard]] SourceFrames source_frames(const Evaluation& evaluation, const std::string& dataset);

}  // namespace evaluate
