#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera/circle_pose.hpp"
#include "core/image/luma.hpp"
#include "core/image/scale.hpp"
#include "core/tracking/frame_clock.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target_odds.hpp"

namespace ellipse {

class PadTracker;
struct LumaWindow;

enum class TargetState {
  kDetected,   ///< Found where nothing was known of it.
  kTracked,    ///< Found around its last place.
  kPredicted,  ///< Not seen in this frame; its motion was continued.
};

/// The target in one frame.
struct Target {
  Ellipse ellipse;       ///< The outer edge [px]; in the ideal plane where the lens is distorted.
  std::uint64_t id = 0;  ///< The same while it is not lost, from 1.
  TargetState state = TargetState::kDetected;
  /// [Keipour2021] Eq. (1). Where edges are followed: share of the pad's edges in view that were
  /// matched, inner ones included.
  double contour_overlap = 0.0;
  /// [Keipour2021] Eq. (2). Where edges are followed: share of the outer edge in view that was
  /// matched.
  double ellipse_overlap = 0.0;
  /// That it is an ellipse: where edges are followed, by all frames so far (TargetOdds); else by
  /// the detector in this frame, 1 where it does not say.
  double probability = 1.0;
  double visible_fraction = 0.0;  ///< Share of the perimeter inside the frame.
  int scale = 1;                  ///< Frame scale that it was found at.
  Rect search_region;             ///< Where it was looked for [px].
  std::int64_t pts_ns = 0;        ///< Of its frame.
  std::optional<RingUncertainty> uncertainty =
      {};                               ///< Of the ellipse, while its edges are followed.
  std::optional<TargetPose> pose = {};  ///< Where a camera is known.
};

/// What the tracker is doing, where edges are followed. See docs/architecture.md.
enum class TrackerState {
  kSearching,   ///< Nothing is known: the detector searches.
  kConfirming,  ///< Something is followed, but its odds are below the limit: not reported.
  kFollowing,   ///< The target is followed, and reported.
  kCoasting,    ///< The target is not seen in this frame; its motion is continued and reported.
};

/// What of one frame is searched, and how finely.
struct SearchScope {
  Rect within;           ///< [px] of the frame; clipped to it. Empty: nothing is searched.
  int finest_scale = 1;  ///< Frame scale that is not gone below: a power of two, up to 128.
};

/// Follows one elliptical target through a stream: TrackTarget of [Keipour2021] Algorithm 2.
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
  [[nodiscard]] std::span<const Detection> candidates() const { return candidates_; }

  /// Every search by the detector from now on tells there what it sees, and why what is not the
  /// target is not it: in pixels of the frame. What is followed by its edges is not told of, and
  /// where a frame is searched twice, the second time is. nullptr = no more. Borrowed.
  void set_trace(DetectionTrace* trace);

  /// After the last frame; kSearching where edges are not followed.
  [[nodiscard]] TrackerState state() const { return state_; }

  /// Where the last frame was searched [px].
  [[nodiscard]] const Rect& search_region() const { return search_region_; }

  /// Through what lens the last frame was seen. Until the next call.
  [[nodiscard]] LensView lens() const;

 private:
  [[nodiscard]] std::optional<Target> follow(const PixelView& frame, double elapsed_s);
  [[nodiscard]] std::optional<Target> follow_edges(const PixelView& frame, double elapsed);
  void judge_outline(const LumaWindow& window, const Target& target);
  [[nodiscard]] bool is_too_large(const Ellipse& e) const;
  void take_evidence(double log_odds);
  [[nodiscard]] bool is_believed() const;
  [[nodiscard]] std::optional<Target> challenge(const PixelView& frame,
                                                const std::optional<Target>& followed);
  [[nodiscard]] bool is_better_than(const Target& followed, const Target& chosen) const;
  [[nodiscard]] std::optional<Target> acquire(const PixelView& frame, Target target);
  void lock_edges(const PixelView& frame, const Target& target);
  [[nodiscard]] std::optional<Target> search_target(const PixelView& frame);
  [[nodiscard]] std::optional<Target> detect_target(const PixelView& frame, bool is_tracking);
  [[nodiscard]] Thresholds determine_thresholds(bool is_tracking) const;
  void take_in(const PixelView& frame, const SearchScope& scope);
  void prepare_next_frame(const std::optional<Target>& target);
  [[nodiscard]] LumaWindow window_on(const PixelView& frame, const Rect& region);
  void locate(Target& target);
  void make_lens();

  TrackerSettings settings_;
  std::unique_ptr<Detector> detector_;
  DetectionTrace* trace_ = nullptr;
  std::vector<Detection> candidates_;
  FrameClock clock_;
  LumaReader luma_reader_;
  Scaler scaler_;
  std::unique_ptr<PadTracker> pad_tracker_;
  PoseEstimator pose_estimator_;
  std::optional<Lens> lens_;      // of frames of this size
  std::uint64_t located_id_ = 0;  // of the target that the estimator knows

  Rect roi_;  // where the target is expected, while it is being tracked
  Rect search_region_;
  Rect frame_bounds_;
  Rect searchable_;  // of this frame
  Ellipse last_ellipse_;
  std::uint64_t last_id_ = 0;  // of a target that was reported
  std::uint64_t id_ = 0;       // of what is followed, once it is reported
  int scale_ = 1;
  int finest_scale_ = 1;
  std::optional<Ellipse> hypothesis_;  // of the last frame, reported or not
  TrackerState state_ = TrackerState::kSearching;
  TargetOdds odds_;  // of what is followed
  double since_judged_s_ = 0.0;
  double most_visible_ = 0.0;    // of the perimeter of what is followed, so far
  double judged_overlap_ = 0.0;  // share of the outline that was matched then
  double absence_s_ = std::numeric_limits<double>::infinity();  // of a target that is reported
  double since_look_s_ = 0.0;  // of the detector, while following by edges
  bool is_lens_stale_ = true;
  bool is_tracking_ = false;
  bool had_target_ = false;         // a hypothesis, reported or not
  bool is_detector_given_ = false;  // by the constructor, so that the settings do not choose it
};

}  // namespace ellipse
