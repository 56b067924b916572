// SPDX-License-Identifier: MIT
#include "core/tracking/tracker.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/detection/detectors.hpp"
#include "core/tracking/edge_tracker.hpp"
#include "core/tracking/frame_search.hpp"
#include "core/tracking/redetect_tracker.hpp"

namespace ellipse {
namespace {

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
      edge_tracker_(std::make_unique<EdgeTracker>(*search_, last_target_)),
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
  last_target_.advance(elapsed_s);
  pose_estimator_.advance(elapsed_s);
  std::optional<Target> target = track(scoped, elapsed_s);
  had_target_ = target.has_value();
  if (!target) return std::nullopt;
  last_target_.remember(*target);
  target->pts_ns = pts_ns;
  target->covariance = parameter_covariance(target->ellipse, target->uncertainty);
  if (lens_) locate(*target);
  return target;
}

ScopedFrame Tracker::prepare_frame(const PixelView& frame, const SearchScope& scope) {
  const Rect searchable = intersect(scope.within, frame.bounds());
  const bool is_other_size = frame.bounds() != frame_bounds_;
  if (is_other_size || searchable.empty()) reset();
  frame_bounds_ = frame.bounds();
  if (is_other_size || is_lens_stale_) make_lens();
  search_->begin(frame);
  const auto finest_scale =
      static_cast<unsigned>(std::clamp(scope.finest_scale, 1, settings_.max_scale));
  return {frame,
          searchable,
          static_cast<int>(std::bit_floor(finest_scale)),
          lens(),
          lens_ ? std::optional(lens_->camera()) : std::nullopt};
}

std::optional<Target> Tracker::track(const ScopedFrame& frame, double elapsed_s) {
  if (settings_.tracking == TrackingMode::kEdges) {
    const std::optional<Target> target = edge_tracker_->track_target(frame, elapsed_s);
    state_ = edge_tracker_->state();
    return target;
  }
  std::optional<Target> target = settings_.tracking == TrackingMode::kRedetect
                                     ? redetect_tracker_->track_target(frame, *search_, settings_)
                                     : search_->detect(frame);
  if (target) target->id = had_target_ ? last_target_.id() : last_target_.id() + 1;
  state_ = target ? TrackerState::kFollowing : TrackerState::kSearching;
  return target;
}

// Adds the pose, which needs a camera.
void Tracker::locate(Target& target) {
  if (target.id != located_id_) pose_estimator_.reset();
  located_id_ = target.id;
  PoseEvidence evidence = edge_tracker_->pose_evidence();
  evidence.gravity = Eigen::Vector3d::Map(settings_.gravity.data());
  target.pose = pose_estimator_.estimate(
      *lens_, target.ellipse, target.uncertainty, evidence, 0.5 * settings_.target_diameter_m);
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
  last_target_.forget();
  clock_ = {};
  search_->begin({});
  *redetect_tracker_ = {};
  edge_tracker_->reset();
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
  const std::optional<Ellipse> tracked =
      had_target_ ? last_target_.ellipse() : edge_tracker_->outline();
  const bool is_excluded =
      tracked && settings_.limits.accepts_axes(*tracked) && !settings.limits.accepts_axes(*tracked);
  is_lens_stale_ = is_lens_stale_ || is_other_camera;
  settings_ = settings;
  search_->configure(settings);
  edge_tracker_->configure(settings);
  if (starts_over || is_other_camera || is_excluded) reset();
}

}  // namespace ellipse
