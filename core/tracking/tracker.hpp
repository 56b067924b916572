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
#include "core/tracking/target_memory.hpp"
#include "core/tracking/tracker_state.hpp"

namespace ellipse {

class EdgeTracker;
class FrameSearch;
class RedetectTracker;
struct ScopedFrame;

/// Search region and resolution for one frame.
struct SearchScope {
  Rect within;           ///< In frame pixels; clipped to the frame. Empty: no search.
  int finest_scale = 1;  ///< Min frame scale; rounded down to a power of two, max_scale at most.
};

/// Tracks one elliptical target through a stream, by the method in TrackerSettings::tracking.
///
/// One object serves one stream, one thread at a time. The same frames give the same targets. With
/// DetectorKind::kArcs process() allocates nothing in the steady state.
class Tracker {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit Tracker(const TrackerSettings& settings = {});
  /// Uses the given detector, which is not null, instead of settings.detector. Throws like the
  /// constructor above.
  Tracker(const TrackerSettings& settings, std::unique_ptr<Detector> detector);
  ~Tracker();

  /// Takes effect from the next frame. Throws like the constructor, then keeps the old settings.
  void configure(const TrackerSettings& settings);

  /// @param frame   Borrowed for the call only. A change of its size resets the tracker.
  /// @param pts_ns  Its time stamp, negative if it has none; copied into the target.
  /// @return The target, or nullopt if none was found. No content of a frame throws.
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
  /// in frame pixels. Edge tracking is not recorded. If a frame is searched several times,
  /// the trace holds the last search. nullptr stops recording. Borrowed.
  void set_trace(DetectionTrace* trace);

  /// State after the last frame.
  [[nodiscard]] TrackerState state() const { return state_; }

  /// The region that was read last in the last frame [px].
  [[nodiscard]] const Rect& search_region() const;

  /// Lens of the last frame. Valid until the next call.
  [[nodiscard]] LensView lens() const;

 private:
  [[nodiscard]] ScopedFrame prepare_frame(const PixelView& frame, const SearchScope& scope);
  [[nodiscard]] std::optional<Target> track(const ScopedFrame& frame, double elapsed_s);
  void locate(Target& target);
  void make_lens();

  TrackerSettings settings_;
  FrameClock clock_;
  std::unique_ptr<FrameSearch> search_;
  TargetMemory last_target_;
  std::unique_ptr<RedetectTracker> redetect_tracker_;
  std::unique_ptr<EdgeTracker> edge_tracker_;
  PoseEstimator pose_estimator_;
  std::uint64_t located_id_ = 0;  // target of the pose estimator
  std::optional<Lens> lens_;      // for the current frame size
  Rect frame_bounds_;
  TrackerState state_ = TrackerState::kSearching;
  bool had_target_ = false;  // in the last frame
  bool is_lens_stale_ = true;
  bool is_detector_given_ = false;  // by the constructor; overrides the settings
};

}  // namespace ellipse
