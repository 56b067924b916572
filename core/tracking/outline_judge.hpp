#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/camera/picture.hpp"
#include "core/detection/detector.hpp"
#include "core/detection/thresholds.hpp"
#include "core/tracking/target.hpp"
#include "core/tracking/target_odds.hpp"

namespace ellipse {

/// While a target is certain: period of its evaluation, and of searches for a better one. Not
/// a multiple of common frame intervals, so that rounded time stamps do not change which frames are
/// evaluated.
inline constexpr double kCheckPeriod_s = 0.18;

/// Accumulates the detector's evidence for the outline of the tracked hypothesis over frames.
///
/// One object serves one stream, one thread at a time. Deterministic.
class OutlineJudge {
 public:
  /// Starts a hypothesis from a new detection. See TargetOdds::start().
  void start(double log_odds, double prior);
  /// Adds a detection of the tracked hypothesis.
  /// @param prior  Of a new hypothesis at its position. See TargetOdds::raise().
  void add_detection(double log_odds, double prior);

  /// Call once per frame.
  void advance(double elapsed_s) { since_judged_s_ += elapsed_s; }

  /// Evaluates the outline of a visible target with the detector: at once while the odds are
  /// uncertain or when the matched share drops, else periodically.
  ///
  /// @param picture  The frame, or the part of it that shows the target.
  /// @param limits   Edge thresholds; the overlaps are replaced by the detector's own.
  void judge(Detector& detector,
             const Picture& picture,
             const Target& target,
             const Thresholds& limits);

  /// Evaluates the outline now, whether or not it is due, at most once per frame, and adds the
  /// result to the odds. Parameters as above.
  /// @return Its log odds in this frame, bounded as in TargetOdds; nullopt if they are unknown, or
  ///         if less than half of the outline is visible: a short arc hardly shows what it is, and
  ///         the pad was locked when most of it was visible.
  std::optional<double> evaluate(Detector& detector,
                                 const Picture& picture,
                                 const Target& target,
                                 const Thresholds& limits);

  /// Log odds from all frames so far.
  [[nodiscard]] double log_odds() const { return odds_.value(); }
  /// Log odds from the last frame that was evaluated.
  [[nodiscard]] double last_log_odds() const { return odds_.last(); }
  /// Whether the odds are high enough for periodic evaluation.
  [[nodiscard]] bool is_certain() const;

 private:
  [[nodiscard]] bool is_due(const Target& target) const;
  void add(double log_odds);

  TargetOdds odds_;
  double since_judged_s_ = 0.0;
  double judged_overlap_ = 1.0;  // matched share of the outline at the last evaluation; 1 before it
};

}  // namespace ellipse
