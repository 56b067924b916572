#pragma once  // SPDX-License-Identifier: MIT

#include "core/detection/detector.hpp"
#include "core/detection/thresholds.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/target.hpp"
#include "core/tracking/target_odds.hpp"

namespace ellipse {

/// The evidence for what is followed by its edges: what the detector thinks of its outline, added
/// up over frames.
///
/// One object serves one stream, one thread at a time. Deterministic.
class OutlineJudge {
 public:
  /// The detector found something new. See TargetOdds::start().
  void start(double log_odds, double absence_s);
  /// The detector found what is followed.
  void confirm(double log_odds);

  /// Time passes [s], once a frame.
  void advance(double elapsed_s) { since_judged_s_ += elapsed_s; }

  /// Asks the detector about the outline of a target that is visible in the window: at once where
  /// the odds are open or where less of it is matched than before, else now and then.
  ///
  /// @param limits  Thresholds of edges; the overlaps are the detector's own.
  void judge(Detector& detector,
             const LumaWindow& window,
             const Target& target,
             const Thresholds& limits);

  /// By all frames so far.
  [[nodiscard]] double log_odds() const { return odds_.value(); }
  /// Whether nothing has to be added soon.
  [[nodiscard]] bool is_sure() const;

 private:
  [[nodiscard]] bool is_due(const Target& target) const;
  void add(double log_odds);

  TargetOdds odds_;
  double since_judged_s_ = 0.0;
  double most_visible_ = 0.0;    // of the perimeter, so far
  double judged_overlap_ = 0.0;  // share of the outline that was matched when it was judged last
};

}  // namespace ellipse
