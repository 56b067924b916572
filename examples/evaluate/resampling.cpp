// SPDX-License-Identifier: MIT
#include "examples/evaluate/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/scene/random.hpp"
#include "examples/evaluate/measures.hpp"

namespace evaluate {
namespace {

constexpr int kResamples = 2000;
constexpr std::size_t kMinBlocks = 5;
constexpr double kBlockSeconds = 1.0;

// Prefix sums: the sum over any range of frames in O(1).
class Sums {
 public:
  explicit Sums(std::span<const FrameCounts> counts) : before_(1) {
    for (const FrameCounts& one : counts) {
      before_.push_back(before_.back());
      before_.back() += one;
    }
  }

  [[nodiscard]] FrameCounts between(std::size_t begin, std::size_t end) const {
    const FrameCounts& a = before_[begin];
    const FrameCounts& b = before_[end];
    return {b.judged - a.judged, b.right - a.right, b.mistaken - a.mistaken, b.missed - a.missed};
  }

 private:
  std::vector<FrameCounts> before_;
};

// A range of frames, as indices in the source.
struct FrameRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// Draws the frame ranges of resamples.
class Draw {
 public:
  Draw(const SourceFrames& source, const Scheme& scheme) : scheme_(scheme) {
    std::size_t begin = 0;
    for (const std::size_t length : source.sequence_lengths) {
      sequences_.push_back({begin, begin + length});
      begin += length;
    }
  }

  const std::vector<FrameRange>& next() {
    ranges_.clear();
    if (scheme_.draws_sequences) {
      for (std::size_t i = 0; i < sequences_.size(); ++i) {
        ranges_.push_back(sequences_[below(sequences_.size())]);
      }
    } else {
      for (const FrameRange& sequence : sequences_) draw_blocks(sequence);
    }
    return ranges_;
  }

 private:
  void draw_blocks(const FrameRange& sequence) {
    const std::size_t frames = sequence.end - sequence.begin;
    for (std::size_t drawn = 0; drawn < frames;) {
      const std::size_t length = std::min(scheme_.block_frames, frames - drawn);
      const std::size_t begin = sequence.begin + below(frames);
      const std::size_t end = begin + length;
      ranges_.push_back({begin, std::min(end, sequence.end)});
      if (end > sequence.end) ranges_.push_back({sequence.begin, end - frames});
      drawn += length;
    }
  }

  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(count)));
  }

  Scheme scheme_;
  std::vector<FrameRange> sequences_;
  std::vector<FrameRange> ranges_;
  ellipse::Random random_{1};
};

FrameCounts sum_of(const Sums& sums, const std::vector<FrameRange>& ranges) {
  FrameCounts sum;
  for (const FrameRange& range : ranges) sum += sums.between(range.begin, range.end);
  return sum;
}

double clean_share(const FrameCounts& sum) {
  return sum.judged > 0 ? 1.0 - static_cast<double>(sum.mistaken) / sum.judged : kNaN;
}

Interval central_95(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

// Covariance of errors between frames that are `lag` apart in the same sequence.
double covariance(const SourceFrames& source,
                  const std::vector<double>& deviations,
                  std::size_t lag) {
  double sum = 0.0;
  std::size_t begin = 0;
  for (const std::size_t length : source.sequence_lengths) {
    for (std::size_t i = begin; i + lag < begin + length; ++i) {
      sum += deviations[i] * deviations[i + lag];
    }
    begin += length;
  }
  return sum;
}

// 1 + 2 (rho_1 + rho_2 + ...), up to the first non-positive term.
double autocorrelation_time(const SourceFrames& source,
                            std::span<const FrameCounts> counts,
                            std::size_t max_lag) {
  std::vector<double> deviations;
  for (const FrameCounts& one : counts) deviations.push_back(one.has_error() ? 1.0 : 0.0);
  const double mean = std::accumulate(deviations.begin(), deviations.end(), 0.0) /
                      static_cast<double>(deviations.size());
  for (double& value : deviations) value -= mean;
  const double variance = covariance(source, deviations, 0);
  double time = 1.0;
  for (std::size_t lag = 1; variance > 0.0 && lag <= max_lag; ++lag) {
    const double rho = covariance(source, deviations, lag) / variance;
    if (rho <= 0.0) break;
    time += 2.0 * rho;
  }
  return time;
}

}  // namespace

FrameCounts& FrameCounts::operator+=(const FrameCounts& other) {
  judged += other.judged;
  right += other.right;
  mistaken += other.mistaken;
  missed += other.missed;
  return *this;
}

FrameCounts total(std::span<const FrameCounts> counts) {
  return std::accumulate(counts.begin(), counts.end(), FrameCounts{}, [](auto sum, const auto& c) {
    return sum += c;
  });
}

double f1_of(const FrameCounts& sum) {
  if (!sum.has_target()) return kNaN;
  return 2.0 * sum.right / (2.0 * sum.right + sum.mistaken + sum.missed);
}

double grade_of(const FrameCounts& sum) {
  return sum.has_target() ? f1_of(sum) : clean_share(sum);
}

Scheme scheme_for(const SourceFrames& source, std::span<const FrameCounts> counts) {
  if (source.sequence_lengths.size() >= kMinSequences) return {true, 1};
  const std::size_t longest = *std::ranges::max_element(source.sequence_lengths);
  const std::size_t max_frames = std::max<std::size_t>(1, longest / kMinBlocks);
  const double frames = std::max(kBlockSeconds * source.frames_per_second,
                                 autocorrelation_time(source, counts, max_frames));
  return {false, std::min(max_frames, static_cast<std::size_t>(std::ceil(frames)))};
}

Scheme longer(const Scheme& a, const Scheme& b) {
  return {a.draws_sequences, std::max(a.block_frames, b.block_frames)};
}

Interval grade_interval(const SourceFrames& source,
                        const Scheme& scheme,
                        std::span<const FrameCounts> counts) {
  if (!total(counts).has_error()) return {kNaN, kNaN};
  const auto grade = total(counts).has_target() ? f1_of : clean_share;
  const Sums sums(counts);
  Draw draw(source, scheme);
  std::vector<double> grades;
  for (int i = 0; i < kResamples; ++i) grades.push_back(grade(sum_of(sums, draw.next())));
  return central_95(std::move(grades));
}

Interval difference_interval(const SourceFrames& source,
                             const Scheme& scheme,
                             std::span<const FrameCounts> a,
                             std::span<const FrameCounts> b) {
  const auto grade = total(a).has_target() ? f1_of : clean_share;
  const Sums sums_a(a);
  const Sums sums_b(b);
  Draw draw(source, scheme);
  std::vector<double> differences;
  for (int i = 0; i < kResamples; ++i) {
    const std::vector<FrameRange>& ranges = draw.next();
    differences.push_back(grade(sum_of(sums_a, ranges)) - grade(sum_of(sums_b, ranges)));
  }
  return central_95(std::move(differences));
}

}  // namespace evaluate
