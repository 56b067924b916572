// SPDX-License-Identifier: MIT
#include "core/tracking/edge_tracker.hpp"

#include <algorithm>

#include "core/detection/evidence.hpp"
#include "core/detection/target_selection.hpp"

namespace ellipse {
namespace {

constexpr double kMinPredicted = 0.4;  // min matched share of a reported prediction

// Whether a detection may be an inner edge of the pad with this outer edge.
bool lies_in(const Ellipse& inner, const Ellipse& outer) {
  return (inner.center() - outer.center()).norm() + inner.semi_minor < outer.semi_major &&
         inner.semi_major < outer.semi_major;
}

bool is_coarser(const ScopedFrame& frame, const ScopedFrame& other) {
  return frame.finest_scale > other.finest_scale;
}

}  // namespace

void EdgeTracker::configure(const TrackerSettings& settings) {
  settings_ = settings;
  pad_tracker_.configure(settings.refine, settings.ring_ratio);
}

void EdgeTracker::reset() {
  state_ = TrackerState::kSearching;
  hypothesis_.reset();
  is_pad_ = false;
  pad_tracker_.forget();
}

std::optional<Ellipse> EdgeTracker::outline() const {
  return pad_tracker_.is_locked() ? pad_tracker_.outline() : hypothesis_;
}

PoseEvidence EdgeTracker::pose_evidence() const {
  if (!is_pad_) return {};
  return {.inner_edges = pad_tracker_.inner_edges(), .pattern = pad_tracker_.pattern()};
}

std::optional<Target> EdgeTracker::track_target(const ScopedFrame& frame, double elapsed_s) {
  judge_.advance(elapsed_s);
  since_detection_s_ += elapsed_s;
  since_full_search_s_ += elapsed_s;

  is_pad_ = true;
  std::optional<Target> target = follow_edges(frame, elapsed_s);
  if (needs_detection(target)) target = run_detector(frame, target);
  if (judge_.log_odds() < -kCertainLogOdds) pad_tracker_.forget();

  if (target || !pad_tracker_.is_locked()) hypothesis_.reset();
  if (target) hypothesis_ = target->ellipse;
  state_ = state_after(target);
  if (state_ == TrackerState::kSearching || state_ == TrackerState::kConfirming) return {};
  target->probability = probability_of(judge_.log_odds());
  return target;
}

// The new state does not depend on the previous one.
TrackerState EdgeTracker::state_after(const std::optional<Target>& target) const {
  if (!target) return TrackerState::kSearching;
  if (judge_.log_odds() < required_log_odds()) return TrackerState::kConfirming;
  if (target->state == TargetState::kPredicted) return TrackerState::kCoasting;
  return TrackerState::kFollowing;
}

double EdgeTracker::required_log_odds() const {
  const bool has_limit = search_.detector().has_probability();
  const double required = has_limit ? log_odds(settings_.limits.min_probability) : 0.0;
  return std::min(required, TargetOdds::kMax);
}

// Detects in each frame unless a visible target has sufficient odds. Then detects periodically,
// since a better target may have come into view, and while an uncertain outline looks wrong in this
// frame.
bool EdgeTracker::needs_detection(const std::optional<Target>& followed) const {
  const bool is_visible = followed && followed->state == TargetState::kTracked;
  const double required = required_log_odds();
  const bool looks_wrong = !judge_.is_certain() && judge_.last_log_odds() < required;
  return !is_visible || judge_.log_odds() < required || looks_wrong || is_detection_due();
}

bool EdgeTracker::is_detection_due() const {
  return settings_.wants_candidates || since_detection_s_ >= kCheckPeriod_s;
}

// Reads only the search window of the pad.
std::optional<Target> EdgeTracker::follow_edges(const ScopedFrame& frame, double elapsed_s) {
  if (!pad_tracker_.is_locked()) return std::nullopt;
  const Rect region =
      intersect(pad_tracker_.region_after(elapsed_s, frame.pixels.width, frame.pixels.height),
                frame.searchable);
  const PadFrame part = pad_frame_of(frame, region);
  const auto track = pad_tracker_.track(part, elapsed_s);
  const std::optional<Target> target = track ? target_of(*track, frame, region) : std::nullopt;
  // At most one of the periodic evaluation and the periodic detection runs per frame; is_better()
  // may add an evaluation.
  const bool is_deferred = judge_.is_certain() && is_detection_due() && !settings_.wants_candidates;
  if (target && track->is_visible && !is_deferred) {
    judge_.judge(search_.detector(), part.picture, *target, settings_.limits);
  }
  return target;
}

// nullopt if too little is known about the pad's position.
std::optional<Target> EdgeTracker::target_of(const PadTrack& track,
                                             const ScopedFrame& frame,
                                             const Rect& region) const {
  Target target;
  target.ellipse = track.ellipse;
  target.state = track.is_visible ? TargetState::kTracked : TargetState::kPredicted;
  target.id = id_;
  target.contour_overlap = track.coverage;
  target.ellipse_overlap = track.outer_coverage;
  target.visible_fraction =
      visible_fraction(frame.lens, track.ellipse, frame.pixels.width, frame.pixels.height);
  target.search_region = region;
  target.uncertainty = pad_tracker_.uncertainty();
  const bool is_likely = target.visible_fraction >= kMajority && track.coverage >= kMinPredicted;
  return track.is_visible || is_likely ? std::optional(target) : std::nullopt;
}

std::optional<Target> EdgeTracker::run_detector(const ScopedFrame& frame,
                                                const std::optional<Target>& followed) {
  since_detection_s_ = 0.0;
  const bool is_visible = followed && followed->state == TargetState::kTracked;
  return is_visible ? challenge(frame, *followed) : find_again(frame, followed);
}

// Looks for a better target than a visible one. While it is certain, the coarsest scale comes first
// and the full resolution follows only if it shows a rival.
Target EdgeTracker::challenge(const ScopedFrame& frame, const Target& followed) {
  const auto is_rival = [&](const std::optional<Target>& candidate) {
    if (!candidate) return false;
    if (is_certain_rival(*candidate)) return true;
    if (is_inner_edge(candidate->ellipse, frame)) return false;
    return judge_.log_odds() < required_log_odds() || is_better(*candidate, followed, frame);
  };
  const ScopedFrame coarse = reduced(frame, judge_.is_certain() ? kCoarsestScale : 1);
  if (is_coarser(coarse, frame) && !is_rival(search_.detect(coarse))) return followed;
  since_full_search_s_ = 0.0;
  const std::optional<Target> chosen = search_.detect(frame);
  if (is_rival(chosen)) return acquire(frame, *chosen);
  if (chosen) add_if_same(*chosen, followed);
  return followed;
}

// Searches a target that is not visible: first where it is predicted, then everywhere. While it is
// absent for long, half the size comes first, except once per kCheckPeriod_s.
std::optional<Target> EdgeTracker::find_again(const ScopedFrame& frame,
                                              const std::optional<Target>& predicted) {
  if (auto resumed = resume_nearby(frame)) return resumed;
  const auto may_be_another = [&](const Target& candidate) {
    return is_certain_rival(candidate) || !is_inner_edge(candidate.ellipse, frame);
  };
  const bool is_absent = !hypothesis_ && last_.absence_s() > kLongAbsence_s;
  const ScopedFrame half =
      reduced(frame, is_absent && since_full_search_s_ < kCheckPeriod_s ? 2 : 1);
  if (is_coarser(half, frame)) {
    const auto candidate = detect_lost(half);
    if (!candidate || !may_be_another(*candidate)) return predicted;
  }
  since_full_search_s_ = 0.0;
  const std::optional<Target> chosen = detect_lost(frame);
  if (!chosen) return predicted;
  if (auto resumed = resume(frame, *chosen)) return resumed;
  if (may_be_another(*chosen)) return acquire(frame, *chosen);
  if (predicted) add_if_same(*chosen, *predicted);
  return predicted;
}

// The frame, searched at this scale or coarser only; unchanged if all candidates are wanted.
ScopedFrame EdgeTracker::reduced(const ScopedFrame& frame, int scale) const {
  ScopedFrame result = frame;
  if (!settings_.wants_candidates) result.finest_scale = std::max(frame.finest_scale, scale);
  return result;
}

void EdgeTracker::add_if_same(const Target& detection, const Target& followed) {
  if (!is_same(detection.ellipse, followed.ellipse, kSameTarget)) return;
  judge_.add_detection(log_odds(detection.probability), 0.0);
}

// The search may have ended at a reduced size, before it found the followed target. Therefore the
// detector evaluates this target before it is replaced, if its scores are log odds.
bool EdgeTracker::is_better(const Target& candidate,
                            const Target& followed,
                            const ScopedFrame& frame) {
  KnownTarget known{.ellipse = followed.ellipse, .has_two_edges = pad_tracker_.has_inner_edges()};
  const bool seems_better = is_better_target(candidate.ellipse, known, search_.candidates());
  if (!seems_better || !search_.detector().has_probability()) return seems_better;
  known.score = judge_.evaluate(
      search_.detector(), picture_of(frame, frame.searchable), followed, settings_.limits);
  return is_better_target(candidate.ellipse, known, search_.candidates());
}

// Also accepts a less clear ellipse if it resembles a target that was certain shortly before.
std::optional<Target> EdgeTracker::detect_lost(const ScopedFrame& frame) {
  if (!last_.was_certain()) return search_.detect(frame);
  const int scale = frame.finest_scale;
  Thresholds thresholds = search_.detecting_thresholds(scale);
  const double required = thresholds.min_probability;
  thresholds.min_probability = probability_of(log_odds(required) - TargetMemory::kLostPrior);
  const auto target = search_.find_target(frame, frame.searchable, scale, thresholds);
  search_.drop_candidates_below(required);
  const bool is_accepted =
      target && (target->probability >= required || last_.was_certain_as(target->ellipse));
  return is_accepted ? target : std::nullopt;
}

// Whether a certain detection competes with an uncertain outline.
bool EdgeTracker::is_certain_rival(const Target& chosen) const {
  return !judge_.is_certain() && is_certain(chosen.probability);
}

// Whether an ellipse may be an inner edge of the pad, which is predicted if it is not visible.
bool EdgeTracker::is_inner_edge(const Ellipse& e, const ScopedFrame& frame) const {
  const auto outer = pad_tracker_.is_locked() ? pad_tracker_.outline() : std::nullopt;
  if (!outer || judge_.log_odds() < required_log_odds()) return false;
  if (is_same(e, *outer, kSameTarget)) return false;
  if (judge_.is_certain() && is_too_large(*outer, frame) && lies_in(e, *outer)) return true;
  return are_concentric(e, *outer) && e.semi_major < outer->semi_major;
}

// Whether the detector can find only the inner edges of a target of this size.
bool EdgeTracker::is_too_large(const Ellipse& e, const ScopedFrame& frame) const {
  return !settings_.limits.accepts_axes(e) ||
         2.0 * e.semi_major > std::max(frame.pixels.width, frame.pixels.height);
}

// Searches a lost pad where it is predicted. A certain detection there makes a search of the whole
// frame unnecessary.
std::optional<Target> EdgeTracker::resume_nearby(const ScopedFrame& frame) {
  if (!pad_tracker_.is_locked() || settings_.wants_candidates) return std::nullopt;
  ScopedFrame nearby = frame;
  nearby.searchable = intersect(
      pad_tracker_.region_after(0.0, frame.pixels.width, frame.pixels.height), frame.searchable);
  const std::optional<Target> found = search_.detect(nearby);
  return found && is_certain(found->probability) ? resume(frame, *found) : std::nullopt;
}

// Continues with the known pad where the detector found one of its circles.
std::optional<Target> EdgeTracker::resume(const ScopedFrame& frame, const Target& detection) {
  const bool is_elsewhere = !hypothesis_ || !is_near(*hypothesis_, detection.ellipse);
  if (pad_tracker_.is_locked() && is_elsewhere) return std::nullopt;
  const auto track = pad_tracker_.resume(pad_frame_of(frame, frame.searchable), detection.ellipse);
  if (!track) return std::nullopt;
  add_detection(track->ellipse, log_odds(detection.probability));
  std::optional<Target> target = target_of(*track, frame, detection.search_region);
  if (!target) return std::nullopt;
  if (id_ != last_.id()) target->state = TargetState::kDetected;
  return target;
}

// Replaces or confirms the hypothesis by a detection. Locks only if most of its perimeter is
// visible.
Target EdgeTracker::acquire(const ScopedFrame& frame, Target target) {
  const bool is_same_outline = add_detection(target.ellipse, log_odds(target.probability));
  target.id = id_;
  is_pad_ = target.visible_fraction >= kMajority &&
            pad_tracker_.lock(pad_frame_of(frame, frame.searchable), target.ellipse);
  if (is_pad_) {
    target.uncertainty = pad_tracker_.uncertainty();
  } else if (!is_same_outline) {
    pad_tracker_.release();
  }
  return target;
}

// Adds to the odds of the hypothesis if it has this outline, else starts another one.
// Returns whether it has.
bool EdgeTracker::add_detection(const Ellipse& outline, double detected_log_odds) {
  const bool is_same_outline = hypothesis_ && is_same(*hypothesis_, outline, kSameTarget);
  if (is_same_outline) {
    judge_.add_detection(detected_log_odds, last_.prior_of(outline));
  } else {
    judge_.start(detected_log_odds, last_.prior_of(outline));
    id_ = last_.was_near(outline) ? last_.id() : last_.id() + 1;
  }
  return is_same_outline;
}

Picture EdgeTracker::picture_of(const ScopedFrame& frame, const Rect& region) {
  const Eigen::Vector2d origin_px(region.x, region.y);
  Picture picture(search_.read(region), frame.lens.part(origin_px));
  picture.origin_px = origin_px;
  return picture;
}

PadFrame EdgeTracker::pad_frame_of(const ScopedFrame& frame, const Rect& region) {
  return {picture_of(frame, region),
          Eigen::Vector2d(frame.pixels.width, frame.pixels.height),
          frame.camera};
}

}  // namespace ellipse
