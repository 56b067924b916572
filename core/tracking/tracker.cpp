// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/detection/detection_trace.hpp"
#include "core/detection/target_selection.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/roi.hpp"

namespace ellipse {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;     // the clock's unit
constexpr double kLook_s = 8.0 * kFrame_s;  // between the detector's looks while following,
constexpr double kJudge_s = 0.15;           // and between judgements of a sure outline
constexpr double kSure = 3.0;               // log odds
constexpr double kGivenUp = -3.0;           // log odds
constexpr double kKeepsNumber_s = 0.4;      // in which a target that was lost may return
constexpr double kLessMatched = 0.1;        // of the outline, than when it was judged last
constexpr double kEnoughToJudge = 0.5;      // of the perimeter in view
constexpr double kJudgedExpansion = 2.0;    // of the region, as TrackerSettings::roi_expansion
constexpr int kCoarsestScale = 4;           // of the detector
constexpr double kEnoughToLock = 0.45;      // of the perimeter in view, to follow what was found
constexpr double kFartherOut = 1.1;
constexpr double kMuchBetter = 1.5;       // in score, to leave one target for another
constexpr double kMinPredicted = 0.5;     // of the perimeter in view, to report what is not seen
constexpr double kMinCoverage = 0.4;      // of its edges, all the same
constexpr double kDetectedSigmaPx = 0.3;  // of the edges of an ellipse that is not followed

bool is_better(const ConcentricSet& chosen, const ConcentricSet& followed) {
  if (!(followed < chosen)) return false;
  return chosen.has_two_edges > followed.has_two_edges ||
         chosen.score > kMuchBetter * followed.score;
}

// An edge of the same target, farther out: an inner edge was followed.
bool is_outside_of(const Ellipse& chosen, const Ellipse& followed) {
  return are_concentric(chosen, followed) && chosen.semi_major > kFartherOut * followed.semi_major;
}

// Of a target that is too large for the detector the inner edges are all that it finds.
bool lies_in(const Ellipse& inner, const Ellipse& outer) {
  return (inner.center() - outer.center()).norm() + inner.semi_minor < outer.semi_major &&
         inner.semi_major < outer.semi_major;
}

bool has_same_camera(const TrackerSettings& a, const TrackerSettings& b) {
  return a.camera == b.camera && a.hfov_rad == b.hfov_rad && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px;
}

double or_own(double setting, double own) {
  return setting > 0.0 ? setting : own;
}

}  // namespace

Tracker::Tracker(const TrackerSettings& settings)
    : detector_(make_detector(settings.detector)), pad_tracker_(std::make_unique<PadTracker>()) {
  configure(settings);
}

Tracker::Tracker(const TrackerSettings& settings, std::unique_ptr<Detector> detector)
    : detector_(std::move(detector)),
      pad_tracker_(std::make_unique<PadTracker>()),
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
  take_in(frame, scope);
  const double elapsed = clock_.advance_to(pts_ns);
  if (searchable_.empty()) return std::nullopt;
  const bool follows = settings_.tracking == TrackingMode::kEdges;
  std::optional<Target> target = follows ? follow(frame, elapsed * kFrame_s) : search_target(frame);
  if (target) target->pts_ns = pts_ns;
  prepare_next_frame(target);
  if (target && lens_) locate(*target);
  return target;
}

// What a camera adds to what is seen.
void Tracker::locate(Target& target) {
  const Camera& camera = lens_->camera();
  const bool is_followed = pad_tracker_->is_locked();
  if (!target.uncertainty && is_followed) target.uncertainty = pad_tracker_->uncertainty();
  if (!target.uncertainty) {
    target.uncertainty =
        expected_uncertainty(target.ellipse, camera.width, camera.height, kDetectedSigmaPx);
  }
  if (target.id != located_id_) pose_estimator_.forget();
  located_id_ = target.id;
  target.pose = pose_estimator_.estimate(
      *lens_,
      target.ellipse,
      *target.uncertainty,
      is_followed ? pad_tracker_->inner_edges() : std::span<const FittedEllipse>(),
      0.5 * settings_.target_diameter_m,
      Eigen::Vector3d::Map(settings_.gravity.data()));
}

LensView Tracker::lens() const {
  return lens_ ? LensView(*lens_) : LensView();
}

LumaWindow Tracker::window_on(const PixelView& frame, const Rect& region) {
  return {luma_reader_.read(frame, region),
          Eigen::Vector2d(region.x, region.y),
          Eigen::Vector2d(frame.width, frame.height),
          lens(),
          lens_ ? std::optional(lens_->camera()) : std::nullopt};
}

// From its edges alone: nothing else of the frame is read.
std::optional<Target> Tracker::follow_edges(const PixelView& frame, double elapsed) {
  search_region_ =
      intersect(pad_tracker_->region_after(elapsed, frame.width, frame.height), searchable_);
  candidates_.clear();
  const LumaWindow window = window_on(frame, search_region_);
  const auto track = pad_tracker_->track(window, elapsed);
  if (!track) return std::nullopt;
  const double visible = visible_fraction(lens(), track->ellipse, frame.width, frame.height);
  const bool is_likely = visible >= kMinPredicted && track->coverage >= kMinCoverage;
  if (!track->is_visible && !is_likely) return std::nullopt;
  Target target;
  target.ellipse = track->ellipse;
  target.state = track->is_visible ? TargetState::kTracked : TargetState::kPredicted;
  target.id = id_;
  target.contour_overlap = track->coverage;
  target.ellipse_overlap = track->outline;
  target.visible_fraction = visible;
  target.search_region = search_region_;
  if (lens_) target.uncertainty = pad_tracker_->uncertainty();
  if (track->is_visible) judge_outline(window, target);
  return target;
}

// One frame of the state machine, see TrackerState. The detector searches where nothing is followed
// that is seen and believed, and now and then, because something better may have come into view.
std::optional<Target> Tracker::follow(const PixelView& frame, double elapsed_s) {
  since_judged_s_ += elapsed_s;
  since_look_s_ += elapsed_s;
  absence_s_ += elapsed_s;
  std::optional<Target> target;
  if (pad_tracker_->is_locked()) target = follow_edges(frame, elapsed_s / kFrame_s);
  const bool is_visible = target && target->state == TargetState::kTracked;
  const bool is_time = settings_.wants_candidates || since_look_s_ >= kLook_s;
  if (!is_visible || !is_believed() || is_time) target = challenge(frame, target);
  if (odds_.value() < kGivenUp) pad_tracker_->release();
  if (target || !pad_tracker_->is_locked()) hypothesis_.reset();
  if (target) hypothesis_ = target->ellipse;
  if (!target) {
    state_ = TrackerState::kSearching;
  } else if (!is_believed()) {
    state_ = TrackerState::kConfirming;
    target.reset();
  } else {
    const bool is_predicted = target->state == TargetState::kPredicted;
    state_ = is_predicted ? TrackerState::kCoasting : TrackerState::kFollowing;
    target->probability = probability_of(odds_.value());
    absence_s_ = 0.0;
  }
  return target;
}

bool Tracker::is_believed() const {
  const bool has_limit = detector_->tells_probability();
  const double wanted = has_limit ? log_odds(settings_.limits.min_probability) : 0.0;
  return odds_.value() >= std::min(wanted, TargetOdds::kMax);
}

// The detector judges the outline that is followed: at once where the odds are open or where less
// of it is matched than before, else now and then. A short arc tells too little against an outline
// that was seen whole: below half of the perimeter only outlines are judged that never showed more.
void Tracker::judge_outline(const LumaWindow& window, const Target& target) {
  const auto seen = distorted(window.lens, target.ellipse);
  most_visible_ = std::max(most_visible_, target.visible_fraction);
  if (!seen || target.visible_fraction < std::min(kEnoughToJudge, most_visible_)) return;
  const bool is_sure =
      odds_.value() >= kSure && target.ellipse_overlap >= judged_overlap_ - kLessMatched;
  if (is_sure && since_judged_s_ < kJudge_s) return;
  judged_overlap_ = target.ellipse_overlap;
  const Rect around = intersect(
      calculate_roi(
          *seen, kJudgedExpansion, kCoarsestScale, frame_bounds_.width, frame_bounds_.height),
      search_region_);
  const Eigen::Vector2d origin(around.x, around.y);
  detector_->set_lens(window.lens.part(origin));
  const ImageView luma = window.luma.region(
      {around.x - search_region_.x, around.y - search_region_.y, around.width, around.height});
  const Ellipse there = translated(target.ellipse, -origin.x(), -origin.y());
  Thresholds thresholds = settings_.limits;
  thresholds.contour_overlap = detector_->tracking_overlaps().contour;
  thresholds.ellipse_overlap = detector_->tracking_overlaps().ellipse;
  const auto judged = detector_->log_odds_of(luma, there, thresholds);
  if (judged) take_evidence(*judged);
}

void Tracker::take_evidence(double log_odds) {
  odds_.add(log_odds, since_judged_s_);
  since_judged_s_ = 0.0;
}

// The detector is asked what it would choose.
std::optional<Target> Tracker::challenge(const PixelView& frame,
                                         const std::optional<Target>& followed) {
  const std::optional<Target> chosen = search_target(frame);
  since_look_s_ = 0.0;
  if (!chosen) return followed;
  const bool is_followed = followed && followed->state == TargetState::kTracked;
  if (is_followed && !is_better_than(*followed, *chosen)) return followed;
  return acquire(frame, *chosen);
}

// Whether something else is a better target: an edge of the same one farther out, or another set.
bool Tracker::is_better_than(const Target& followed, const Target& chosen) const {
  if (is_too_large(followed.ellipse) && lies_in(chosen.ellipse, followed.ellipse)) return false;
  return is_outside_of(chosen.ellipse, followed.ellipse) ||
         is_better(set_around(chosen.ellipse, candidates_),
                   set_around(followed.ellipse, candidates_));
}

// Of a target that large the detector finds the inner edges only.
bool Tracker::is_too_large(const Ellipse& e) const {
  return !settings_.limits.admit_axes_of(e) ||
         2.0 * e.semi_major > std::max(frame_bounds_.width, frame_bounds_.height);
}

std::optional<Target> Tracker::acquire(const PixelView& frame, Target target) {
  const auto is_near = [&](const Ellipse& e) {
    return (e.center() - target.ellipse.center()).norm() < target.ellipse.semi_major;
  };
  if (hypothesis_ && is_near(*hypothesis_)) {
    take_evidence(log_odds(target.probability));
  } else {
    odds_.start(log_odds(target.probability), absence_s_);
    since_judged_s_ = 0.0;
    id_ = absence_s_ < kKeepsNumber_s && is_near(last_ellipse_) ? last_id_ : last_id_ + 1;
  }
  target.id = id_;
  judged_overlap_ = 0.0;
  most_visible_ = 0.0;
  lock_edges(frame, target);
  return target;
}

// A part of an ellipse may be part of anything: it is not followed.
void Tracker::lock_edges(const PixelView& frame, const Target& target) {
  pad_tracker_->release();
  if (target.visible_fraction < kEnoughToLock) return;
  (void)pad_tracker_->lock(window_on(frame, searchable_), target.ellipse);
}

// [Keipour2021] Algorithm 2, TrackTarget: one turn of its loop.
std::optional<Target> Tracker::search_target(const PixelView& frame) {
  search_region_ = is_tracking_ ? intersect(roi_, searchable_) : searchable_;
  std::optional<Target> target = detect_target(frame, is_tracking_);
  if (!target && scale_ > finest_scale_) {
    scale_ /= 2;
    target = detect_target(frame, false);
  } else if (target && settings_.tracking == TrackingMode::kRedetect) {
    scale_ = next_scale(scale_,
                        settings_.max_scale,
                        2.0 * target->ellipse.semi_major / scale_,
                        settings_.min_target_size_px,
                        settings_.max_target_size_px);
  }
  return target;
}

// [Keipour2021] Algorithm 3, DetectTarget: in the search region, at the frame scale.
std::optional<Target> Tracker::detect_target(const PixelView& frame, bool is_tracking) {
  const ImageView region = luma_reader_.read(frame, search_region_);
  const ImageView reduced = scaler_.reduce(region, scale_);
  detector_->set_lens(
      lens().part(Eigen::Vector2d(search_region_.x, search_region_.y)).reduced(scale_));
  const auto detections = detector_->detect(reduced, determine_thresholds(is_tracking));
  candidates_.assign(detections.begin(), detections.end());
  for (Detection& candidate : candidates_) {
    candidate.ellipse = to_frame(candidate.ellipse, search_region_, scale_);
  }
  const std::optional<Ellipse> last_target =
      is_tracking_ ? std::optional(to_region(last_ellipse_, search_region_, scale_)) : std::nullopt;
  const std::optional<Detection> selected = select_target(detections, last_target, trace_);
  if (trace_ != nullptr) trace_->place_in_frame(search_region_, scale_, lens());
  if (!selected) return std::nullopt;

  Target target;
  target.ellipse = to_frame(selected->ellipse, search_region_, scale_);
  target.state = is_tracking_ ? TargetState::kTracked : TargetState::kDetected;
  target.id = had_target_ ? last_id_ : last_id_ + 1;
  target.contour_overlap = selected->contour_overlap;
  target.ellipse_overlap = selected->ellipse_overlap;
  target.probability = selected->probability;
  target.visible_fraction = visible_fraction(lens(), target.ellipse, frame.width, frame.height);
  target.scale = scale_;
  target.search_region = search_region_;
  return target;
}

// [Keipour2021] Algorithm 3, DetermineParams.
Thresholds Tracker::determine_thresholds(bool is_tracking) const {
  const Overlaps& wanted = is_tracking ? settings_.track_overlaps : settings_.detect_overlaps;
  const Overlaps own =
      is_tracking ? detector_->tracking_overlaps() : detector_->detecting_overlaps();
  Thresholds thresholds = settings_.limits.at_scale(scale_);
  thresholds.wants_all = settings_.wants_candidates;
  thresholds.contour_overlap = or_own(wanted.contour, own.contour);
  thresholds.ellipse_overlap = or_own(wanted.ellipse, own.ellipse);
  return thresholds;
}

// [Keipour2021] Algorithm 2, its end: the tracking status and the region for the next frame.
void Tracker::prepare_next_frame(const std::optional<Target>& target) {
  had_target_ = target.has_value() || pad_tracker_->is_locked();
  if (target) {
    last_id_ = target->id;
    last_ellipse_ = target->ellipse;
  }
  is_tracking_ = had_target_ && settings_.tracking == TrackingMode::kRedetect;
  roi_ = {};
  if (!is_tracking_) return;
  const auto seen = distorted(lens(), target->ellipse);
  roi_ =
      seen ? calculate_roi(
                 *seen, settings_.roi_expansion, scale_, frame_bounds_.width, frame_bounds_.height)
           : frame_bounds_;
}

void Tracker::take_in(const PixelView& frame, const SearchScope& scope) {
  searchable_ = intersect(scope.within, frame.bounds());
  const bool is_other_size = frame.bounds() != frame_bounds_;
  if (is_other_size || searchable_.empty()) reset();
  frame_bounds_ = frame.bounds();
  if (is_other_size || is_lens_stale_) make_lens();
  finest_scale_ = scope.finest_scale;
  while (finest_scale_ > settings_.max_scale) finest_scale_ /= 2;
  const bool adapts = settings_.tracking == TrackingMode::kRedetect;
  scale_ = adapts ? std::max(scale_, finest_scale_) : finest_scale_;
}

void Tracker::set_trace(DetectionTrace* trace) {
  trace_ = trace;
  detector_->set_trace(trace);
}

void Tracker::make_lens() {
  is_lens_stale_ = false;
  lens_.reset();
  if (frame_bounds_.empty()) return;
  const auto camera = settings_.camera_for(frame_bounds_.width, frame_bounds_.height);
  if (camera) lens_.emplace(*camera);
}

void Tracker::reset() {
  is_tracking_ = false;
  had_target_ = false;
  state_ = TrackerState::kSearching;
  hypothesis_.reset();
  absence_s_ = std::numeric_limits<double>::infinity();
  scale_ = 1;
  roi_ = {};
  search_region_ = {};
  clock_ = {};
  candidates_.clear();
  pad_tracker_->release();
  pose_estimator_.forget();
}

void Tracker::configure(const TrackerSettings& settings) {
  settings.validate();
  const bool starts_over = settings.detector != settings_.detector ||
                           settings.tracking != settings_.tracking ||
                           settings.ring_ratio != settings_.ring_ratio;
  if (settings.detector != settings_.detector && !is_detector_given_) {
    detector_ = make_detector(settings.detector);
    detector_->set_trace(trace_);
  }
  const bool is_other_camera = !has_same_camera(settings, settings_);
  // A target may outgrow the limits; limits that are drawn anew leave it out.
  const bool is_excluded = had_target_ && settings_.limits.admit_axes_of(last_ellipse_) &&
                           !settings.limits.admit_axes_of(last_ellipse_);
  is_lens_stale_ = is_lens_stale_ || is_other_camera;
  settings_ = settings;
  detector_->set_evidence(settings.evidence);
  pad_tracker_->configure(settings.refine, settings.ring_ratio);
  if (starts_over || is_other_camera || is_excluded) reset();
  while (scale_ > settings_.max_scale) scale_ /= 2;
}

}  // namespace ellipse
