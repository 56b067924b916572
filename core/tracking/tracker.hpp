#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <limits>
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
struct LumaWindow;
struct ScopedFrame;

/// What the tracker is doing. See docs/architecture.md. Where edges are not followed it is
/// searching in a frame without a target and following in one with a target.
enum class TrackerState {
  kSearching,   ///< No target is known: the detector searches.
  kConfirming,  ///< Something is followed, but its odds are below the limit: not reported.
  kFollowing,   ///< The target is followed, and reported.
  kCoasting,    ///< The target is not seen in this frame; its motion is continued and reported.
};

/// What of one frame is searched, and how finely.
struct SearchScope {
  Rect within;           ///< [px] of the frame; clipped to it. Empty: nothing is searched.
  int finest_scale = 1;  ///< Frame scale that is not gone below: a power of two, up to 128.
};

/// Follows one elliptical target through a stream, in the way that TrackerSettings::tracking names.
///
/// One object serves one stream, one thread at a time. The same frames give the same targets.
class Tracker {
 public:
  /// Throws std::invalid_argument where the settings are not valid.
  explicit Tracker(const TrackerSettings& settings = {});
  /// With a detector of one's own, instead of the one that settings.detector names.
  Tracker(const TrackerSettings& settings, std::unique_ptr<Detector> detector);
  ~Tracker();

  /// From the next frame on. Throws like the constructor, and then keeps the old ones.
  void configure(const TrackerSettings& settings);

  /// @param frame   Borrowed for the call only. A change of its size starts over.
  /// @param pts_ns  Its time stamp, negative where it has none; copied into the target.
  /// @return The target, or nullopt where none was found.
  [[nodiscard]] std::optional<Target> process(const PixelView& frame, std::int64_t pts_ns);

  /// The same, where the frame is searched: no pixel outside is read, and what is followed is
  /// looked for inside only. Where nothing is searched the target is forgotten.
  [[nodiscard]] std::optional<Target> process(const PixelView& frame,
                                              std::int64_t pts_ns,
                                              const SearchScope& scope);

  /// Forgets the target, the scale and the region. Numbers of targets go on.
  void reset();

  /// All ellipses that the detector found in the last frame [px, as Target::ellipse]; none in a
  /// frame where it was not asked, see TrackerSettings::wants_candidates. Until the next call.
  [[nodiscard]] std::span<const Detection> candidates() const;

  /// Every search by the detector from now on tells there what it sees, and why what is not the
  /// target is not it: in pixels of the frame. What is followed by its edges is not told of, and
  /// where a frame is searched twice, the second time is. nullptr = no more. Borrowed.
  void set_trace(DetectionTrace* trace);

  /// After the last frame.
  [[nodiscard]] TrackerState state() const { return state_; }

  /// Where the last frame was searched [px].
  [[nodiscard]] const Rect& search_region() const;

  /// Through what lens the last frame was seen. Until the next call.
  [[nodiscard]] LensView lens() const;

 private:
  [[nodiscard]] ScopedFrame take_in(const PixelView& frame, const SearchScope& scope);
  [[nodiscard]] std::optional<Target> track(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> detect(const ScopedFrame& frame);
  void remember(const std::optional<Target>& target);
  void locate(Target& target);

  [[nodiscard]] std::optional<Target> follow(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] TrackerState state_after(const std::optional<Target>& target) const;
  [[nodiscard]] double wanted_log_odds() const;
  [[nodiscard]] bool wants_look(const std::optional<Target>& followed) const;
  [[nodiscard]] std::optional<Target> follow_edges(const ScopedFrame& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> look(const ScopedFrame& frame,
                                           const std::optional<Target>& followed);
  [[nodiscard]] bool is_better(const Target& chosen, const Target& followed) const;
  [[nodiscard]] bool is_too_large(const Ellipse& e) const;
  [[nodiscard]] Target acquire(const ScopedFrame& frame, Target target);
  [[nodiscard]] LumaWindow window_on(const ScopedFrame& frame, const Rect& region);
  void make_lens();

  TrackerSettings settings_;
  FrameClock clock_;
  std::unique_ptr<FrameSearch> search_;
  std::unique_ptr<RedetectTracker> redetect_tracker_;
  std::unique_ptr<PadTracker> pad_tracker_;
  std::unique_ptr<OutlineJudge> judge_;  // of what is followed by its edges
  PoseEstimator pose_estimator_;
  std::optional<Lens> lens_;  // of frames of this size
  Rect frame_bounds_;

  TrackerState state_ = TrackerState::kSearching;
  std::optional<Ellipse> hypothesis_;  // what is followed by its edges, reported or not
  std::uint64_t id_ = 0;               // of it, once it is reported
  Ellipse last_ellipse_;               // of a target that was reported
  std::uint64_t last_id_ = 0;          // of the same
  std::uint64_t located_id_ = 0;       // of the target that the pose estimator knows
  double absence_s_ = std::numeric_limits<double>::infinity();  // of a target that is reported
  double since_look_s_ = 0.0;  // of the detector, while following by edges
  bool had_target_ = false;    // in the last frame, reported or not
  bool is_lens_stale_ = true;
  bool is_detector_given_ = false;  // by the constructor, so that the settings do not choose it
};

}  // namespace ellipse
