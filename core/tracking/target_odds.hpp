#pragma once  // SPDX-License-Identifier: MIT

namespace ellipse {

/// Log odds that the tracked hypothesis is a target, accumulated over frames.
///
/// The evidence of neighbouring frames is correlated. It is modelled as a first-order Gaussian
/// autoregressive process whose mean has opposite signs for targets and non-targets. A sample l
/// that follows a sample k with correlation r then adds (l - r k) / (1 + r): the log likelihood
/// ratio of l given k. The correlation depends on elapsed time, not on the frame rate.
///
/// Deterministic; allocates nothing; one thread at a time.
class TargetOdds {
 public:
  /// Bound of the log odds' magnitude. Larger values of one frame are not calibrated. For the sum,
  /// it limits how long a target that has left is still reported.
  static constexpr double kMax = 5.0;
  /// Correlation time of the evidence in a stream.
  static constexpr double kCorrelation_s = 0.5;

  /// Starts a new hypothesis.
  /// @param log_odds  From its first frame; may be infinite.
  /// @param prior     Log odds before that frame.
  void start(double log_odds, double prior);

  /// Raises the value to that of a new hypothesis with these log odds and this prior, if it is
  /// lower: a followed target is at least as likely as one that is found for the first time.
  void raise(double log_odds, double prior);

  /// @param log_odds   From one more frame; may be infinite.
  /// @param elapsed_s  Since the last frame that was added.
  void add(double log_odds, double elapsed_s);

  [[nodiscard]] double value() const { return sum_; }
  /// Of the last frame that was added.
  [[nodiscard]] double last() const { return last_; }

 private:
  double sum_ = 0.0;
  double last_ = 0.0;  // of one frame
};

}  // namespace ellipse
