#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace evaluate {

/// Counts of one or more frames, from which precision, recall and F1 are computed.
struct FrameCounts {
  int judged = 0;    ///< Judged frames.
  int right = 0;     ///< Matched ellipses.
  int mistaken = 0;  ///< Reported ellipses without a match.
  int missed = 0;    ///< True ellipses without a match.

  FrameCounts& operator+=(const FrameCounts& other);
  [[nodiscard]] bool has_error() const { return mistaken > 0 || missed > 0; }
  [[nodiscard]] bool has_target() const { return right > 0 || missed > 0; }
};

[[nodiscard]] FrameCounts total(std::span<const FrameCounts> counts);

/// F1; NaN if there is no ellipse to find.
[[nodiscard]] double f1_of(const FrameCounts& sum);

/// F1; for a source without ellipses, the fraction of frames without a mistaken one.
[[nodiscard]] double grade_of(const FrameCounts& sum);

/// The frames of one source, grouped by sequence.
struct SourceFrames {
  std::vector<std::size_t> sequence_lengths;
  double frames_per_second = 30.0;
};

/// Sources with at least this many sequences are resampled by whole sequences.
inline constexpr std::size_t kMinSequences = 5;

/// Resampling scheme of a source. Consecutive frames show almost the same picture and are not
/// independent draws. Whole sequences are therefore drawn with replacement; sources with fewer than
/// kMinSequences use blocks of consecutive frames within each sequence (circular block bootstrap
/// [PolitisRomano1992]).
struct Scheme {
  bool draws_sequences = false;
  std::size_t block_frames = 1;  ///< Block length, if blocks are drawn.
};

/// Chooses the scheme. A block lasts one second or the integrated autocorrelation time of the
/// method's errors, whichever is longer, but at most a fifth of the longest sequence.
[[nodiscard]] Scheme scheme_for(const SourceFrames& source, std::span<const FrameCounts> counts);

/// The scheme with the longer blocks.
[[nodiscard]] Scheme longer(const Scheme& a, const Scheme& b);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The central 95 % of the grade over kResamples resamples; identical on every machine. NaN for
/// both ends if no frame has an error, because resampling cannot show unobserved errors.
[[nodiscard]] Interval grade_interval(const SourceFrames& source,
                                      const Scheme& scheme,
                                      std::span<const FrameCounts> counts);

/// The same for grade(a) - grade(b), with both on the same resampled frames.
[[nodiscard]] Interval difference_interval(const SourceFrames& source,
                                           const Scheme& scheme,
                                           std::span<const FrameCounts> a,
                                           std::span<const FrameCounts> b);

/// Whether a difference is significant: its interval excludes 0.
[[nodiscard]] inline bool is_difference(const Interval& difference) {
  return difference.low > 0.0 || difference.high < 0.0;
}

}  // namespace evaluate
