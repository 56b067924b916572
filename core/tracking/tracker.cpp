// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <utility>

#include "core/detection/detection_trace.hpp"
#include "core/detection/target_selection.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/roi.hpp"

namespace ellipse {
namespace {

constexpr int kLookInterval = 8;          // frames between the detector's looks while following
constexpr int kNextLook = 2;              // the same, after one that did not find the target
constexpr int kMaxTrust = 4;              // one for each look that finds the target, and
constexpr int kLossOfTrust = 2;           // for each that does not; below 0 it is given up
constexpr double kEnoughToBeFound = 0.5;  // of the perimeter in view, for the detector to find it
constexpr double kCoarsePx = 20.0;        // full minor axis at a coarse scale, for the same
constexpr double kEnoughToLock = 0.45;    // the same, to follow what was found
constexpr double kEnoughAlone = 0.6;      // the same, of an edge without another, to report it
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
  return (chosen.center() - followed.center()).norm() < 0.15 * chosen.semi_major &&
         chosen.semi_major > kFartherOut * followed.semi_major;
}

// Of a target that is too large for the detector the inner edges are all that it finds.
bool lies_in(const Ellipse& inner, const Ellipse& outer) {
  return (inner.center() - outer.center()).norm() + inner.semi_minor < outer.semi_major &&
         inner.semi_major < outer.semi_major;
}

// Whether the detector, looking at this scale, should find what is followed.
bool can_be_found(const Target& followed, int scale) {
  const bool is_too_coarse = scale > 1 && 2.0 * followed.ellipse.semi_minor < kCoarsePx * scale;
  return followed.visible_fraction >= kEnoughToBeFound && !is_too_coarse;
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
  std::optional<Target> target;
  if (pad_tracker_->is_locked()) target = follow_edges(frame, elapsed);
  const bool is_visible = target && target->state == TargetState::kTracked;
  const int next_look = settings_.wants_candidates ? 1 : next_look_;
  if (!is_visible || ++frames_since_look_ >= next_look) target = look_at_all(frame, target);
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
  target.id = last_id_;
  target.contour_overlap = track->coverage;
  target.ellipse_overlap = track->outline;
  target.probability = last_probability_;
  target.visible_fraction = visible;
  target.search_region = search_region_;
  if (lens_) target.uncertainty = pad_tracker_->uncertainty();
  return target;
}

// What is followed may have been the wrong thing, or there may be something better by now: the
// detector is asked what it would choose.
std::optional<Target> Tracker::look_at_all(const PixelView& frame,
                                           const std::optional<Target>& followed) {
  std::optional<Target> chosen = search_target(frame);
  if (settings_.tracking != TrackingMode::kEdges) return chosen;
  frames_since_look_ = 0;
  next_look_ = kLookInterval;
  const bool is_followed = followed && followed->state == TargetState::kTracked;
  if (is_followed) {
    const ConcentricSet old_set = set_around(followed->ellipse, candidates_);
    const bool is_found = old_set.score > 0.0;
    if (is_found) trust_ = std::min(trust_ + 1, kMaxTrust);
    const bool is_beyond =
        !settings_.limits.admit_axes_of(followed->ellipse) ||
        2.0 * followed->ellipse.semi_major > std::max(frame_bounds_.width, frame_bounds_.height);
    const bool is_own_inside = is_beyond && chosen && lies_in(chosen->ellipse, followed->ellipse);
    const bool is_new = chosen && !is_own_inside &&
                        (is_outside_of(chosen->ellipse, followed->ellipse) ||
                         is_better(set_around(chosen->ellipse, candidates_), old_set));
    if (!is_new) {
      if (is_found || is_beyond || !can_be_found(*followed, scale_)) return followed;
      next_look_ = kNextLook;
      trust_ -= kLossOfTrust;
      if (trust_ >= 0) return followed;
      pad_tracker_->release();
      return std::nullopt;
    }
  }
  if (!chosen) return followed;
  Target target = *chosen;
  if (is_followed && !is_outside_of(target.ellipse, followed->ellipse)) target.id = last_id_ + 1;
  lock_edges(frame, target);
  trust_ = 0;  // it must be confirmed at once
  next_look_ = 1;
  if (!had_target_ && is_doubtful(target)) {
    if (pad_tracker_->is_locked()) {
      last_id_ = target.id;
      last_probability_ = target.probability;
    }
    return std::nullopt;
  }
  return target;
}

// Half an outline by itself may be anything: edges that can be followed have to confirm it.
bool Tracker::is_doubtful(const Target& target) const {
  return target.visible_fraction < kEnoughAlone &&
         !set_around(target.ellipse, candidates_).has_two_edges;
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
    last_probability_ = target->probability;
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
