#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/resampling.hpp"

namespace evaluate {

/// The counts of a frame's outcome. A wrong target counts as one mistaken and one missed ellipse.
[[nodiscard]] FrameCounts counts_of(Outcome outcome);

/// The sum of a method's counts over a source.
[[nodiscard]] FrameCounts source_counts(const Evaluation& evaluation,
                                        std::size_t method,
                                        const std::string& dataset);

/// A method's result on one source.
struct SourceGrade {
  double grade = 0.0;  ///< See grade_of().
  FrameCounts counts;
  Interval interval;
  /// Interval of the difference from the first method; nullopt for the first method itself.
  std::optional<Interval> difference;
};

/// Results of all methods on one source.
struct SourceResults {
  std::string source;
  int frames = 0;  ///< All frames, judged or not.
  bool has_target = false;
  bool draws_sequences = false;          ///< Resampling by sequences instead of blocks.
  std::vector<SourceGrade> methods;      ///< In the order of the evaluation.
  std::optional<std::size_t> best_peer;  ///< Best method that is not ours.
};

/// Results per source (data set), in order of evaluation.
[[nodiscard]] std::vector<SourceResults> source_results(const Evaluation& evaluation);

/// The frames of a data set, grouped by sequence as evaluated.
[[nodiscard]] SourceFrames source_frames(const Evaluation& evaluation, const std::string& dataset);

}  // namespace evaluate
