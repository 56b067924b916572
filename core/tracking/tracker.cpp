// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <utility>

#include "core/detection/target_selection.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/tracking/frame_search.hpp"
#include "core/tracking/outline_judge.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/redetect_tracker.hpp"

namespace ellipse {
namespace {

constexpr double kMinPredicted = 0.4;  // min matched share of a reported prediction

// Log odds of a hypothesis before its first frame, see docs/provenance.md, "Evidence over time".
constexpr double kNewPrior = -0.4;  // of a new target
constexpr double kLostPrior = 2.0;  // of a target that was certain shortly before

// Of a target before and after a short loss.
constexpr Tolerance kShortLoss{0.0, 0.5};

bool is_near(const Ellipse& e, const Ellipse& target) {
  return (e.center() - target.center()).norm() < target.semi_major;
}

// Whether a detection may be an inner edge of the pad with this outer edge.
bool lies_in(const Ellipse& inner, const Ellipse& outer) {
  return (inner.center() - outer.center()).norm() + inner.semi_minor < outer.semi_major &&
         inner.semi_major < outer.semi_major;
}

bool has_same_camera(const TrackerSettings& a, const TrackerSettings& b) {
  return a.camera == b.camera && a.hfov_rad == b.hfov_rad && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px;
}

}  // namespace

Tracker::Tracker(const TrackerSettings& settings)
    : Tracker(settings, make_detector(settings.detector)) {
  is_detector_given_ = false;
}

Tracker::Tracker(const TrackerSettings& settings, std::unique_ptr<Detector> detector)
    : search_(std::make_unique<FrameSearch>(std::move(detector))),
      redetect_tracker_(std::make_unique<RedetectTracker>()),
      pad_tracker_(std::make_unique<PadTracker>()),
      judge_(std::make_unique<OutlineJudge>()),
      is_detector_given_(true) {
  configure(settings);
}

Tracker::~Tracker() = default;

std::optional<Target> Tracker::process(const PixelView& frame, std::int64_t pts_ns) {
  return process(frame, pts_ns, {.within = frame.bounds()});
}

std::optional<Target> Tracker::process(const PixelView& frame,
                                       std::int64_t pts_ns,
                                       const SearchScope& scope) {
  const ScopedFrame scoped = prepare_frame(frame, scope);
  const double elapsed_s = clock_.advance_to(pts_ns);
  if (scoped.searchable.empty()) return std::nullopt;
  std::optional<Target> target = track(scoped, elapsed_s);
  remember(target);
  if (!target) return std::nullopt;
  target->pts_ns = pts_ns;
  target->uncertainty = uncertainty_of(*target);
  target->covariance = parameter_covariance(target->ellipse, target->uncertainty);
  if (lens_) locate(*target, elapsed_s);
  return target;
}

ScopedFrame Tracker::prepare_frame(const PixelView& frame, const SearchScope& scope) {
  const Rect searchable = intersect(scope.within, frame.bounds());
  const bool is_other_size = frame.bounds() != frame_bounds_;
  if (is_other_size || searchable.empty()) reset();
  frame_bounds_ = frame.bounds();
  if (is_other_size || is_lens_stale_) make_lens();
  search_->begin(frame);
  int finest_scale = scope.finest_scale;
  while (finest_scale > settings_.max_scale) finest_scale /= 2;
  return {frame, searchable, finest_scale, lens()};
}

std::optional<Target> Tracker::track(const ScopedFrame& frame, double elapsed_s) {
  if (settings_.tracking == TrackingMode::kEdges) return follow(frame, elapsed_s);
  std::optional<Target> target = settings_.tracking == TrackingMode::kRedetect
                                     ? redetect_tracker_->track_target(frame, *search_, settings_)
                                     : detect(frame);
  if (target) target->id = had_target_ ? last_id_ : last_id_ + 1;
  state_ = target ? TrackerState::kFollowing : TrackerState::kSearching;
  return target;
}

// Detects in this frame alone.
std::optional<Target> Tracker::detect(const ScopedFrame& frame) {
  const int scale = frame.finest_scale;
  return search_->find_target(frame, frame.searchable, scale, search_->detecting_thresholds(scale));
}

// Also accepts a less clear ellipse if it resembles a target that was certain shortly before.
std::optional<Target> Tracker::detect_lost(const ScopedFrame& frame) {
  if (!was_sure()) return detect(frame);
  const int scale = frame.finest_scale;
  Thresholds thresholds = search_->detecting_thresholds(scale);
  const double required = thresholds.min_probability;
  thresholds.min_probability = probability_of(log_odds(required) - kLostPrior);
  const auto target = search_->find_target(frame, frame.searchable, scale, thresholds);
  search_->drop_candidates_below(required);
  const bool is_accepted = target && (target->probability >= required ||
                                      is_same(target->ellipse, last_ellipse_, kShortLoss));
  return is_accepted ? target : std::nullopt;
}

// Advances the state machine by one frame. The odds accumulate all frames of the hypothesis.
std::optional<Target> Tracker::follow(const ScopedFrame& frame, double elapsed_s) {
  judge_->advance(elapsed_s);
  since_detection_s_ += elapsed_s;
  since_full_search_s_ += elapsed_s;
  absence_s_ += elapsed_s;
  since_sure_s_ += elapsed_s;

  std::optional<Target> target = follow_edges(frame, elapsed_s);
  if (needs_detection(target)) target = look(frame, target);
  if (judge_->log_odds() < -kCertainLogOdds) pad_tracker_->forget();

  if (target || !pad_tracker_->is_locked()) hypothesis_.reset();
  if (target) hypothesis_ = target->ellipse;
  state_ = state_after(target);
  if (state_ == TrackerState::kSearching || state_ == TrackerState::kConfirming) return {};
  target->probability = probability_of(judge_->log_odds());
  absence_s_ = 0.0;
  if (judge_->is_sure()) since_sure_s_ = 0.0;
  return target;
}

// The new state does not depend on the previous one.
TrackerState Tracker::state_after(const std::optional<Target>& target) const {
  if (!target) return TrackerState::kSearching;
  if (judge_->log_odds() < required_log_odds()) return TrackerState::kConfirming;
  if (target->state == TargetState::kPredicted) return TrackerState::kCoasting;
  return TrackerState::kFollowing;
}

double Tracker::required_log_odds() const {
  const bool has_limit = search_->detector().has_probability();
  const double required = has_limit ? log_odds(settings_.limits.min_probability) : 0.0;
  return std::min(required, TargetOdds::kMax);
}

// Detects in each frame unless a visible target has sufficient odds. Then detects periodically,
// since a better target may have come into view, and while an uncertain outline looks wrong in this
// frame.
bool Tracker::needs_detection(const std::optional<Target>& followed) const {
  const bool is_visible = followed && followed->state == TargetState::kTracked;
  const double required = required_log_odds();
  const bool looks_wrong = !judge_->is_sure() && judge_->last_log_odds() < required;
  return !is_visible || judge_->log_odds() < required || looks_wrong || is_detection_due();
}

bool Tracker::is_detection_due() const {
  return settings_.wants_candidates || since_detection_s_ >= kCheckPeriod_s;
}

// Reads only the search window of the pad.
std::optional<Target> Tracker::follow_edges(const ScopedFrame& frame, double elapsed_s) {
  if (!pad_tracker_->is_locked()) return std::nullopt;
  const Rect region =
      intersect(pad_tracker_->region_after(elapsed_s, frame.pixels.width, frame.pixels.height),
                frame.searchable);
  const LumaWindow window = window_on(frame, region);
  const auto track = pad_tracker_->track(window, elapsed_s);
  const std::optional<Target> target = track ? target_of(*track, frame, region) : std::nullopt;
  // At most one of the periodic evaluation and the periodic detection runs per frame.
  const bool is_put_off = judge_->is_sure() && is_detection_due() && !settings_.wants_candidates;
  if (target && track->is_visible && !is_put_off) {
    judge_->judge(search_->detector(), window, *target, settings_.limits);
  }
  return target;
}

// nullopt if too little is known about the pad's position.
std::optional<Target> Tracker::target_of(const EdgeTrack& track,
                                         const ScopedFrame& frame,
                                         const Rect& region) const {
  Target target;
  target.ellipse = track.ellipse;
  target.state = track.is_visible ? TargetState::kTracked : TargetState::kPredicted;
  target.id = id_;
  target.contour_overlap = track.coverage;
  target.ellipse_overlap = track.outline;
  target.visible_fraction =
      visible_fraction(frame.lens, track.ellipse, frame.pixels.width, frame.pixels.height);
  target.search_region = region;
  const bool is_likely = target.visible_fraction >= kMajority && track.coverage >= kMinPredicted;
  return track.is_visible || is_likely ? std::optional(target) : std::nullopt;
}

// Runs the detector. Cheaper searches come first, which limits the frame time: near a lost pad, or
// in a reduced frame. The full resolution follows if the reduced frame shows a better target.
std::optional<Target> Tracker::look(const ScopedFrame& frame,
                                    const std::optional<Target>& followed) {
  const bool is_visible = followed && followed->state == TargetState::kTracked;
  const bool is_likely = is_visible && judge_->log_odds() >= required_log_odds();
  const auto is_rival = [&](const std::optional<Target>& candidate) {
    if (!candidate) return false;
    if (is_surer(*candidate)) return true;
    return !is_inner_edge(candidate->ellipse) &&
           (!is_likely ||
            is_better_target(candidate->ellipse, followed->ellipse, search_->candidates()));
  };
  const auto search = [&](const ScopedFrame& searched) {
    return is_visible ? detect(searched) : detect_lost(searched);
  };
  since_detection_s_ = 0.0;
  if (auto resumed = is_visible ? std::nullopt : resume_nearby(frame)) return resumed;
  ScopedFrame reduced = frame;
  reduced.finest_scale = std::max(frame.finest_scale, first_scale(is_visible));
  if (reduced.finest_scale > frame.finest_scale && !is_rival(search(reduced))) return followed;
  since_full_search_s_ = 0.0;
  const std::optional<Target> chosen = search(frame);
  if (!chosen) return followed;
  if (auto resumed = is_visible ? std::nullopt : resume(frame, *chosen)) return resumed;
  if (is_rival(chosen)) return acquire(frame, *chosen);
  if (followed && is_same(chosen->ellipse, followed->ellipse, kSameTarget)) {
    judge_->confirm(log_odds(chosen->probability), 0.0);
  }
  return followed;
}

// The scale of the first search of the whole frame: the coarsest while a visible target is certain,
// half the size while a target is absent for long, except once per kCheckPeriod_s.
int Tracker::first_scale(bool is_visible) const {
  if (settings_.wants_candidates) return 1;
  if (is_visible && judge_->is_sure()) return kCoarsestScale;
  const bool is_absent = !hypothesis_ && absence_s_ > kLongAbsence_s;
  return is_absent && since_full_search_s_ < kCheckPeriod_s ? 2 : 1;
}

// Whether a certain detection competes with an uncertain outline.
bool Tracker::is_surer(const Target& chosen) const {
  return !judge_->is_sure() && is_certain(chosen.probability);
}

// Whether an ellipse may be an inner edge of the pad, which is predicted if it is not visible.
bool Tracker::is_inner_edge(const Ellipse& e) const {
  const auto outer = pad_tracker_->is_locked() ? pad_tracker_->outline() : std::nullopt;
  if (!outer || judge_->log_odds() < required_log_odds()) return false;
  if (is_same(e, *outer, kSameTarget)) return false;
  if (judge_->is_sure() && is_too_large(*outer) && lies_in(e, *outer)) return true;
  return are_concentric(e, *outer) && e.semi_major < outer->semi_major;
}

// Whether the detector can find only the inner edges of a target of this size.
bool Tracker::is_too_large(const Ellipse& e) const {
  return !settings_.limits.accepts_axes(e) ||
         2.0 * e.semi_major > std::max(frame_bounds_.width, frame_bounds_.height);
}

// Searches a lost pad where it is predicted. Only a certain detection spares the whole frame.
std::optional<Target> Tracker::resume_nearby(const ScopedFrame& frame) {
  if (!pad_tracker_->is_locked() || settings_.wants_candidates) return std::nullopt;
  ScopedFrame nearby = frame;
  nearby.searchable = intersect(
      pad_tracker_->region_after(0.0, frame.pixels.width, frame.pixels.height), frame.searchable);
  const std::optional<Target> found = detect(nearby);
  return found && is_certain(found->probability) ? resume(frame, *found) : std::nullopt;
}

// Continues with the known pad where the detector found one of its circles.
std::optional<Target> Tracker::resume(const ScopedFrame& frame, const Target& detection) {
  const bool is_elsewhere = !hypothesis_ || !is_near(*hypothesis_, detection.ellipse);
  if (pad_tracker_->is_locked() && is_elsewhere) return std::nullopt;
  const LumaWindow window = window_on(frame, frame.searchable);
  const auto track = pad_tracker_->resume(window, detection.ellipse);
  if (!track) return std::nullopt;
  std::optional<Target> target = target_of(*track, frame, detection.search_region);
  if (!target) return std::nullopt;
  add_detection(track->ellipse, log_odds(detection.probability));
  target->id = id_;
  if (id_ != last_id_) target->state = TargetState::kDetected;
  return target;
}

// Replaces or confirms the hypothesis by a detection. Locks only if most of its perimeter is
// visible.
Target Tracker::acquire(const ScopedFrame& frame, Target target) {
  const bool is_confirmed = add_detection(target.ellipse, log_odds(target.probability));
  target.id = id_;
  if (target.visible_fraction >= kMajority) {
    (void)pad_tracker_->lock(window_on(frame, frame.searchable), target.ellipse);
  } else if (!is_confirmed) {
    pad_tracker_->release();
  }
  return target;
}

// Adds to the odds of the hypothesis if it has this outline, else starts another one.
// Returns whether it has.
bool Tracker::add_detection(const Ellipse& outline, double detected_log_odds) {
  const bool is_back = absence_s_ < kMemory_s && is_near(last_ellipse_, outline);
  const bool is_confirmed = hypothesis_ && is_same(*hypothesis_, outline, kSameTarget);
  const bool is_lost_target = was_sure() && is_same(outline, last_ellipse_, kShortLoss);
  const double prior = is_lost_target ? kLostPrior : is_back ? 0.0 : kNewPrior;
  if (is_confirmed) {
    judge_->confirm(detected_log_odds, prior);
  } else {
    judge_->start(detected_log_odds, prior);
    id_ = is_back ? last_id_ : last_id_ + 1;
  }
  return is_confirmed;
}

LumaWindow Tracker::window_on(const ScopedFrame& frame, const Rect& region) {
  return {search_->read(region),
          Eigen::Vector2d(region.x, region.y),
          Eigen::Vector2d(frame.pixels.width, frame.pixels.height),
          frame.lens,
          lens_ ? std::optional(lens_->camera()) : std::nullopt};
}

void Tracker::remember(const std::optional<Target>& target) {
  had_target_ = target.has_value() || pad_tracker_->is_locked();
  if (!target) return;
  last_id_ = target->id;
  last_ellipse_ = target->ellipse;
}

RingUncertainty Tracker::uncertainty_of(const Target& target) const {
  if (pad_tracker_->is_locked()) return pad_tracker_->uncertainty();
  return expected_uncertainty(
      target.ellipse, frame_bounds_.width, frame_bounds_.height, kPixelError);
}

// Adds the pose, which needs a camera.
void Tracker::locate(Target& target, double elapsed_s) {
  const bool is_followed = pad_tracker_->is_locked();
  if (target.id != located_id_) pose_estimator_.reset();
  located_id_ = target.id;
  PoseEvidence evidence{.gravity = Eigen::Vector3d::Map(settings_.gravity.data())};
  if (is_followed) {
    evidence.inner_edges = pad_tracker_->inner_edges();
    evidence.pattern = pad_tracker_->pattern();
  }
  target.pose = pose_estimator_.estimate(*lens_,
                                         target.ellipse,
                                         target.uncertainty,
                                         evidence,
                                         0.5 * settings_.target_diameter_m,
                                         elapsed_s);
}

std::span<const Detection> Tracker::candidates() const {
  return search_->candidates();
}

const Rect& Tracker::search_region() const {
  return search_->region();
}

LensView Tracker::lens() const {
  return lens_ ? LensView(*lens_) : LensView();
}

void Tracker::set_trace(DetectionTrace* trace) {
  search_->set_trace(trace);
}

void Tracker::make_lens() {
  is_lens_stale_ = false;
  lens_.reset();
  if (frame_bounds_.empty()) return;
  const auto camera = settings_.camera_for(frame_bounds_.width, frame_bounds_.height);
  if (camera) lens_.emplace(*camera);
}

void Tracker::reset() {
  had_target_ = false;
  state_ = TrackerState::kSearching;
  hypothesis_.reset();
  absence_s_ = since_sure_s_ = kMemory_s;
  clock_ = {};
  search_->begin({});
  *redetect_tracker_ = {};
  pad_tracker_->forget();
  pose_estimator_.reset();
}

void Tracker::configure(const TrackerSettings& settings) {
  settings.validate();
  const bool starts_over = settings.detector != settings_.detector ||
                           settings.tracking != settings_.tracking ||
                           settings.ring_ratio != settings_.ring_ratio;
  if (settings.detector != settings_.detector && !is_detector_given_) {
    search_->set_detector(make_detector(settings.detector));
  }
  const bool is_other_camera = !has_same_camera(settings, settings_);
  // A tracked target may outgrow the limits; changed limits that exclude it reset the tracker.
  const bool is_excluded = had_target_ && settings_.limits.accepts_axes(last_ellipse_) &&
                           !settings.limits.accepts_axes(last_ellipse_);
  is_lens_stale_ = is_lens_stale_ || is_other_camera;
  settings_ = settings;
  search_->configure(settings);
  pad_tracker_->configure(settings.refine, settings.ring_ratio);
  if (starts_over || is_other_camera || is_excluded) reset();
}

}  // namespace ellipse
