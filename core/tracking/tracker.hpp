#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/camera/circle_pose.hpp"
#include "core/image/luma.hpp"
#include "core/tracking/frame_clock.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

class FrameSearch;
class OutlineJudge;
class PadTracker;
class RedetectTracker;
struct EdgeTrack;
struct LumaWindow;
struct ScopedFrame;

/// State of the tracker, see docs/architecture.md. Without edge tracking it is kFollowing in a
/// frame with a target, else kSearching.
enum class TrackerState {
  kSearching,   ///< No target: the detector searches.
  kConfirming,  ///< A hypothesis is tracked, but not reported: its odds are below the limit.
  kFollowing,   ///< The target is tracked and reported.
  kCoasting,    ///< The target is not visible in this frame; its predicted ellipse is reported.
};

/// Search region and resolution for one frame.
struct SearchScope {
  Rect within;           ///< In frame pixels; clipped to the frame. Empty: no search.
  int finest_scale = 1;  ///< Min frame scale: a power of two, up to 128.
};

/// Tracks one elliptical target through a stream, by the method in TrackerSettings::tracking.
///
/// One object serves one stream, one thread at a time. The same frames give the same targets.
class Tracker {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit Tracker(const TrackerSettings& settings = {});
  /// Uses the given detector instead of settings.detector.
  Tracker(const TrackerSettings& settings, std::unique_ptr<Detector> detector);
  ~Tracker();

  /// Takes effect from the next frame. Throws like the constructor, then keeps the old settings.
  void configure(const TrackerSettings& settings);

  /// @param frame   Borrowed for the call only. A change of its size resets the tracker.
  /// @param pts_ns  Its time stamp, negative if it has none; copied into the target.
  /// @return The target, or nullopt if none was found.
  [[nodiscard]] std::optional<Target> process(const PixelView& frame, std::int64_t pts_ns);

  /// The same within a scope: no pixel outside is read, and a tracked target is searched inside
  /// only. An empty scope resets the tracker.
  [[nodiscard]] std::optional<Target> process(const PixelView& frame,
                                              std::int64_t pts_ns,
                                              const SearchScope& scope);

  /// Drops the target, the scale and the region. Target ids continue.
  void reset();

  /// All ellipses that the detector found in the last frame [px, as Target::ellipse]. Empty if it
  /// did not run, see TrackerSettings::wants_candidates. Valid until the next call.
  [[nodiscard]] std::span<const Detection> candidates() const;

  /// Records each further detector search in `trace`: its stages, and why candidates are rejected,
  /// in frame pixels. Edge tracking is not recorded. If a frame is searched twice, the trace holds
  /// the second search. nullptr stops recording. Borrowed.
  void set_trace(DetectionTrace* trace);

  /// State after the last frame.
  [[nodiscard]] TrackerState state() const { return state_; }

  /// Search region of the last frame [px].
  [[nodiscard]] const Rect& search_region() const;

  /// Lens of the last frame. Valid until the next call.
  [[nodiscard]] LensView lens() const;

 private:
  [[nodiscard]] ScopedFrame prepare_frame(const PixelView& frame, const SearchScope& scope);
  [[nodiscard]] std::optional<Target> track(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> detect(const ScopedFrame& frame);
  [[nodiscard]] std::optional<Target> detect_lost(const ScopedFrame& frame);
  [[nodiscard]] bool was_sure() const { return since_sure_s_ < kMemory_s; }
  void remember(const std::optional<Target>& target);
  [[nodiscard]] RingUncertainty uncertainty_of(const Target& target) const;
  void locate(Target& target, double elapsed_s);

  [[nodiscard]] std::optional<Target> follow(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] TrackerState state_after(const std::optional<Target>& target) const;
  [[nodiscard]] double required_log_odds() const;
  [[nodiscard]] bool needs_detection(const std::optional<Target>& followed) const;
  [[nodiscard]] bool is_detection_due() const;
  [[nodiscard]] std::optional<Target> follow_edges(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> look(const ScopedFrame& frame,
                                           const std::optional<Target>& followed);
  [[nodiscard]] std::optional<Target> target_of(const EdgeTrack& track,
                                                const ScopedFrame& frame,
                                                const Rect& region) const;
  [[nodiscard]] int first_scale(bool is_visible) const;
  [[nodiscard]] bool is_surer(const Target& chosen) const;
  [[nodiscard]] bool is_inner_edge(const Ellipse& e) const;
  [[nodiscard]] bool is_too_large(const Ellipse& e) const;
  [[nodiscard]] std::optional<Target> resume_nearby(const ScopedFrame& frame);
  [[nodiscard]] std::optional<Target> resume(const ScopedFrame& frame, const Target& detection);
  [[nodiscard]] Target acquire(const ScopedFrame& frame, Target target);
  bool add_detection(const Ellipse& outline, double detected_log_odds);
  [[nodiscard]] LumaWindow window_on(const ScopedFrame& frame, const Rect& region);
  void make_lens();

  TrackerSettings settings_;
  FrameClock clock_;
  std::unique_ptr<FrameSearch> search_;
  std::unique_ptr<RedetectTracker> redetect_tracker_;
  std::unique_ptr<PadTracker> pad_tracker_;
  std::unique_ptr<OutlineJudge> judge_;  // of the hypothesis
  PoseEstimator pose_estimator_;
  std::optional<Lens> lens_;  // for the current frame size
  Rect frame_bounds_;

  TrackerState state_ = TrackerState::kSearching;
  std::optional<Ellipse> hypothesis_;  // tracked by its edges, reported or not
  std::uint64_t id_ = 0;               // of the hypothesis, if it is reported
  Ellipse last_ellipse_;               // last reported target
  std::uint64_t last_id_ = 0;          // its id
  std::uint64_t located_id_ = 0;       // target of the pose estimator
  double absence_s_ = kMemory_s;       // since a target was reported, or since the start
  double since_sure_s_ = kMemory_s;    // since its odds were certain, or since the start
  double since_detection_s_ = 0.0;     // since the detector ran
  double since_full_search_s_ = 0.0;   // since it ran on the whole frame at the full resolution
  bool had_target_ = false;            // in the last frame, reported or not
  bool is_lens_stale_ = true;
  bool is_detector_given_ = false;  // by the constructor; overrides the settings
};

}  // namespace ellipse
