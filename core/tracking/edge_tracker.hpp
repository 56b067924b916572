#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>

#include "core/tracking/frame_search.hpp"
#include "core/tracking/outline_judge.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"
#include "core/tracking/target_memory.hpp"
#include "core/tracking/tracker_state.hpp"

namespace ellipse {

/// Our tracker, TrackingMode::kEdges: a state machine over one hypothesis. PadTracker follows its
/// edges, the detector finds and challenges it, and OutlineJudge accumulates the evidence of all
/// frames. States: docs/architecture.md.
///
/// One object serves one stream, one thread at a time. Deterministic.
class EdgeTracker {
 public:
  /// @param search  Runs the detector.
  /// @param last    The last reported target; the owner updates it between the frames.
  /// Both are borrowed and must outlive this object.
  EdgeTracker(FrameSearch& search, const TargetMemory& last) : search_(search), last_(last) {}

  void configure(const TrackerSettings& settings);
  /// Drops the hypothesis and forgets the pad.
  void reset();

  /// Advances the state machine by one frame.
  /// @return The target, without time stamp; nullopt if none is reported.
  [[nodiscard]] std::optional<Target> track_target(const ScopedFrame& frame, double elapsed_s);

  /// State after the last frame.
  [[nodiscard]] TrackerState state() const { return state_; }
  /// The outline of the hypothesis, reported or not, in the last frame.
  [[nodiscard]] std::optional<Ellipse> outline() const;
  /// What the pad's edges inside the last target show of its pose, without gravity; nothing if it
  /// is a detection that is not locked. Valid until the next call.
  [[nodiscard]] PoseEvidence pose_evidence() const;

 private:
  [[nodiscard]] TrackerState state_after(const std::optional<Target>& target) const;
  [[nodiscard]] double required_log_odds() const;
  [[nodiscard]] bool needs_detection(const std::optional<Target>& followed) const;
  [[nodiscard]] bool is_detection_due() const;
  [[nodiscard]] std::optional<Target> follow_edges(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> target_of(const PadTrack& track,
                                                const ScopedFrame& frame,
                                                const Rect& region) const;
  [[nodiscard]] std::optional<Target> run_detector(const ScopedFrame& frame,
                                                   const std::optional<Target>& followed);
  [[nodiscard]] Target challenge(const ScopedFrame& frame, const Target& followed);
  [[nodiscard]] std::optional<Target> find_again(const ScopedFrame& frame,
                                                 const std::optional<Target>& predicted);
  [[nodiscard]] ScopedFrame reduced(const ScopedFrame& frame, int scale) const;
  void add_if_same(const Target& detection, const Target& followed);
  [[nodiscard]] bool is_better(const Target& candidate,
                               const Target& followed,
                               const ScopedFrame& frame);
  [[nodiscard]] std::optional<Target> detect_lost(const ScopedFrame& frame);
  [[nodiscard]] bool is_certain_rival(const Target& chosen) const;
  [[nodiscard]] bool is_inner_edge(const Ellipse& e, const ScopedFrame& frame) const;
  [[nodiscard]] bool is_too_large(const Ellipse& e, const ScopedFrame& frame) const;
  [[nodiscard]] std::optional<Target> resume_nearby(const ScopedFrame& frame);
  [[nodiscard]] std::optional<Target> resume(const ScopedFrame& frame, const Target& detection);
  [[nodiscard]] Target acquire(const ScopedFrame& frame, Target target);
  bool add_detection(const Ellipse& outline, double detected_log_odds);
  [[nodiscard]] Picture picture_of(const ScopedFrame& frame, const Rect& region);
  [[nodiscard]] PadFrame pad_frame_of(const ScopedFrame& frame, const Rect& region);

  FrameSearch& search_;
  const TargetMemory& last_;
  TrackerSettings settings_;
  PadTracker pad_tracker_;
  OutlineJudge judge_;  // of the hypothesis

  TrackerState state_ = TrackerState::kSearching;
  std::optional<Ellipse> hypothesis_;  // its outline when it was last found or predicted
  bool is_pad_ = false;                // whether the target is the pad's outline
  std::uint64_t id_ = 0;               // of the hypothesis, if it is reported
  double since_detection_s_ = 0.0;     // since the detector ran
  double since_full_search_s_ = 0.0;   // since it ran on the whole frame at the full resolution
};

}  // namespace ellipse
