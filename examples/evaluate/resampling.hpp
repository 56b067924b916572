#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace evaluate {

/// What a method did in one frame, or in many: the counts that precision, recall and F1 come from.
struct FrameCounts {
  int judged = 0;    ///< Frames that count.
  int right = 0;     ///< Ellipses.
  int mistaken = 0;  ///< Reported ellipses that match nothing.
  int missed = 0;    ///< True ellipses that nothing matches.

  FrameCounts& operator+=(const FrameCounts& other);
  [[nodiscard]] bool has_error() const { return mistaken > 0 || missed > 0; }
  [[nodiscard]] bool has_target() const { return right > 0 || missed > 0; }
};

[[nodiscard]] FrameCounts total(std::span<const FrameCounts> counts);

/// F1, NaN where there is no ellipse to be found.
[[nodiscard]] double f1_of(const FrameCounts& sum);

/// F1; of a source without any ellipse the share of the frames without a mistaken one.
[[nodiscard]] double grade_of(const FrameCounts& sum);

/// The frames of one source, those of a sequence side by side.
struct SourceFrames {
  std::vector<std::size_t> sequence_lengths;
  double frames_per_second = 30.0;
};

/// Sources with this many sequences are resampled by whole sequences.
inline constexpr std::size_t kMinSequences = 5;

/// How a source is resampled. Neighbouring frames show nearly the same picture, so that frames are
/// no independent draws: whole sequences are drawn with replacement, or, where the source has fewer
/// than kMinSequences, blocks of consecutive frames of each sequence (circular block bootstrap
/// [PolitisRomano1992]).
struct Scheme {
  bool draws_sequences = false;
  std::size_t block_frames = 1;  ///< Where blocks are drawn.
};

/// A block lasts one second, or longer where the errors of a method last longer: their integrated
/// autocorrelation time. At most a fifth of the longest sequence.
[[nodiscard]] Scheme scheme_for(const SourceFrames& source, std::span<const FrameCounts> counts);

/// The longer blocks of two schemes for one source.
[[nodiscard]] Scheme longer(const Scheme& a, const Scheme& b);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The central 95 % of the grade over kResamples resamples; the same on every machine. NaN for both
/// ends where no frame has an error: resampling cannot show what has not happened.
[[nodiscard]] Interval grade_interval(const SourceFrames& source,
                                      const Scheme& scheme,
                                      std::span<const FrameCounts> counts);

/// The same of grade(a) - grade(b), both in the same resampled frames.
[[nodiscard]] Interval difference_interval(const SourceFrames& source,
                                           const Scheme& scheme,
                                           std::span<const FrameCounts> a,
                                           std::span<const FrameCounts> b);

/// Whether a difference may be claimed: its interval lies on one side of 0.
[[nodiscard]] inline bool is_difference(const Interval& difference) {
  return difference.low > 0.0 || difference.high < 0.0;
}

}  // namespace evaluate
