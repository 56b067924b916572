// SPDX-License-Identifier: MIT
#include "core/tracking/frame_search.hpp"

#include "core/detection/detection_trace.hpp"
#include "core/detection/target_selection.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
void FrameSearch::configure(const TrackerSettings& settings) {
  settings_ = settings;
  detector_->set_evidence(settings.evidence);
}

void FrameSearch::set_detector(std::unique_ptr<Detector> detector) {
  detector_ = std::move(detector);
  detector_->set_trace(trace_);
  detector_->set_evidence(settings_.evidence);
}

void FrameSearch::set_trace(DetectionTrace* trace) {
  trace_ = trace;
  detector_->set_trace(trace);
}

Thresholds FrameSearch::detecting_thresholds(int scale) const {
  return thresholds_at(scale, settings_.detect_overlaps.or_own(detector_->detecting_overlaps()));
}

Thresholds FrameSearch::tracking_thresholds(int scale) const {
  return thresholds_at(scale, settings_.track_overlaps.or_own(detector_->tracking_overlaps()));
}

Thresholds FrameSearch::thresholds_at(int scale, const Overlaps& overlaps) const {
  Thresholds thresholds = settings_.limits.at_scale(scale);
  thresholds.wants_all = settings_.wants_candidates;
  thresholds.contour_overlap = overlaps.contour;
  thresholds.ellipse_overlap = overlaps.ellipse;
  return thresholds;
}

std::optional<Target> FrameSearch::find_target(const ScopedFrame& frame,
                                               const Rect& region,
                                               int scale,
                                               const Thresholds& thresholds,
                                               const std::optional<Ellipse>& last_target) {
  const LensView lens = frame.lens.part(Eigen::Vector2d(region.x, region.y)).reduced(scale);
  const auto detections =
      detector_->detect({scaler_.reduce(read(region), scale), lens, scale}, thresholds);
  candidates_.assign(detections.begin(), detections.end());
  for (Detection& candidate : candidates_) {
    candidate.ellipse = to_frame(candidate.ellipse, region, scale);
  }
  const std::optional<Ellipse> last =
      last_target ? std::optional(to_region(*last_target, region, scale)) : std::nullopt;
  const std::optional<Detection> selected = select_target(detections, last, trace_);
  if (trace_ != nullptr) trace_->to_frame_coordinates(region, scale, frame.lens);
  if (!selected) return std::nullopt;

  const PixelView& pixels = frame.pixels;
  Target target;
  target.ellipse = to_frame(selected->ellipse, region, scale);
  target.state = last_target ? TargetState::kTracked : TargetState::kDetected;
  target.contour_overlap = selected->contour_overlap;
  target.ellipse_overlap = selected->ellipse_overlap;
  target.probability = selected->probability;
  target.visible_fraction =
      visible_fraction(frame.lens, target.ellipse, pixels.width, pixels.height);
  target.scale = scale;
  target.search_region = region;
  target.uncertainty =
      expected_uncertainty(target.ellipse, pixels.width, pixels.height, kPixelError);
  return target;
}

std::optional<Target> FrameSearch::detect(const ScopedFrame& frame) {
  const int scale = frame.finest_scale;
  return find_target(frame, frame.searchable, scale, detecting_thresholds(scale));
}

void FrameSearch::drop_candidates_below(double probability) {
  std::erase_if(candidates_, [&](const Detection& one) { return one.probability < probability; });
}

void FrameSearch::begin(const PixelView& pixels) {
  luma_reader_.begin(pixels);
  region_ = {};
  candidates_.clear();
}

ImageView FrameSearch::read(const Rect& region) {
  region_ = region;
  return luma_reader_.read(region);
}

}  // namespace ellipse
