// SPDX-License-Identifier: MIT
#include "core/tracking/redetect_tracker.hpp"

#include <algorithm>

#include "core/camera/lens_view.hpp"
#include "core/image/roi.hpp"

namespace ellipse {
namespace {

// Algorithm 3, DetectTarget. find_target() implements ScaleImage, DetectEllipses, SelectTarget,
// ScaleSize, and CompensateOffset of Algorithm 2.
std::optional<Target> detect_target(const ScopedFrame& frame,
                                    FrameSearch& search,
                                    const Rect& region,
                                    int scale,
                                    bool is_tracking,
                                    const std::optional<Ellipse>& last_target) {
  const Thresholds thresholds =  // DetermineParams
      is_tracking ? search.tracking_thresholds(scale) : search.detecting_thresholds(scale);
  return search.find_target(frame, region, scale, thresholds, last_target);
}

}  // namespace

std::optional<Target> RedetectTracker::track_target(const ScopedFrame& frame,
                                                    FrameSearch& search,
                                                    const TrackerSettings& settings) {
  while (scale_ > settings.max_scale) scale_ /= 2;
  scale_ = std::max(scale_, frame.finest_scale);
  const bool is_tracking = last_target_.has_value();
  const Rect region = is_tracking ? intersect(roi_, frame.searchable) : frame.searchable;

  auto target = detect_target(frame, search, region, scale_, is_tracking, last_target_);
  if (!target && scale_ > frame.finest_scale) {
    scale_ /= 2;
    target = detect_target(frame, search, region, scale_, false, last_target_);
  } else if (target) {
    scale_ = next_scale(scale_,
                        settings.max_scale,
                        2.0 * target->ellipse.semi_major / scale_,
                        settings.min_target_size_px,
                        settings.max_target_size_px);
  }
  prepare_next_frame(frame, target, settings.roi_expansion);
  return target;
}

// End of Algorithm 2: the tracking status and the region for the next frame.
void RedetectTracker::prepare_next_frame(const ScopedFrame& frame,
                                         const std::optional<Target>& target,
                                         double roi_expansion) {
  last_target_.reset();
  roi_ = {};
  if (!target) return;
  last_target_ = target->ellipse;
  const Rect whole = frame.pixels.bounds();
  const auto outline = distorted(frame.lens, target->ellipse);
  roi_ =
      outline ? calculate_roi(*outline, roi_expansion, scale_, whole.width, whole.height) : whole;
}

int next_scale(int scale, int max_scale, double size_px, double min_size_px, double max_size_px) {
  if (size_px > max_size_px && 2 * scale <= max_scale) return 2 * scale;
  if (size_px < min_size_px && scale > 1) return scale / 2;
  return scale;
}

}  // namespace ellipse
