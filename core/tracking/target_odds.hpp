#pragma once  // SPDX-License-Identifier: MIT

namespace ellipse {

/// Log odds that what is followed is a target, from all frames so far.
///
/// The evidence of neighbouring frames is correlated. It is taken for a Gaussian autoregressive
/// process of first order whose mean has one sign for targets and the other for all else. A sample
/// l that follows a sample k with the correlation r then adds (l - r k) / (1 + r): the log
/// likelihood ratio of l given k. The correlation depends on seconds, not on the rate of frames.
///
/// Deterministic; allocates nothing; one thread at a time.
class TargetOdds {
 public:
  /// Bounds the sum: a target stays for seconds and may leave at any moment.
  static constexpr double kMax = 4.0;

  /// Begins with a new hypothesis.
  /// @param log_odds   By the frame that shows it.
  /// @param absence_s  Since a target was reported last: the sooner, the likelier it is back.
  ///                   Infinite where there was none.
  void start(double log_odds, double absence_s);

  /// @param log_odds   By one more frame; may be infinite.
  /// @param elapsed_s  Since the last frame that was counted.
  void add(double log_odds, double elapsed_s);

  [[nodiscard]] double value() const { return sum_; }

 private:
  double sum_ = 0.0;
  double last_ = 0.0;  // of one frame
};

}  // namespace ellipse
