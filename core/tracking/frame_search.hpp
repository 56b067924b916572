#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/camera/lens_view.hpp"
#include "core/detection/detector.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "core/image/luma.hpp"
#include "core/image/scale.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

/// One frame, and what of it is searched. A value for the time of one call.
struct ScopedFrame {
  PixelView pixels;
  Rect searchable;       ///< No pixel outside is read [px]; inside the frame.
  int finest_scale = 1;  ///< Frame scale that is not gone below.
  LensView lens;         ///< Of the whole frame.
};

/// Searches regions of frames with a detector, at a frame scale, and tells what it finds in pixels
/// of the frame: what all trackers have in common.
///
/// One object serves one stream, one thread at a time. Deterministic.
class FrameSearch {
 public:
  explicit FrameSearch(std::unique_ptr<Detector> detector) : detector_(std::move(detector)) {}

  void configure(const TrackerSettings& settings);
  void set_detector(std::unique_ptr<Detector> detector);
  /// See Tracker::set_trace().
  void set_trace(DetectionTrace* trace);

  /// The thresholds where nothing is known of the target, for a search at this scale.
  [[nodiscard]] Thresholds detecting_thresholds(int scale) const;
  /// The lowered ones, for the surroundings of a target that is being tracked.
  [[nodiscard]] Thresholds tracking_thresholds(int scale) const;

  /// Detects, and chooses the target; see select_target(). It has no id and no time yet.
  ///
  /// @param region       [px] of the frame; clipped to it.
  /// @param last_target  The target of the frame before [px of the frame]; nullopt = not tracking.
  [[nodiscard]] std::optional<Target> find_target(const ScopedFrame& frame,
                                                  const Rect& region,
                                                  int scale,
                                                  const Thresholds& thresholds,
                                                  const std::optional<Ellipse>& last_target = {});

  /// The luma of a region. Until the next call of this or of find_target().
  [[nodiscard]] ImageView read(const ScopedFrame& frame, const Rect& region);

  /// Forgets the region and the candidates.
  void clear();

  /// Where was read last [px].
  [[nodiscard]] const Rect& region() const { return region_; }
  /// What the last search found [px of the frame].
  [[nodiscard]] std::span<const Detection> candidates() const { return candidates_; }
  [[nodiscard]] Detector& detector() { return *detector_; }

 private:
  [[nodiscard]] Thresholds thresholds_at(int scale,
                                         const Overlaps& wanted,
                                         const Overlaps& own) const;

  TrackerSettings settings_;
  std::unique_ptr<Detector> detector_;
  DetectionTrace* trace_ = nullptr;
  LumaReader luma_reader_;
  Scaler scaler_;
  Rect region_;
  std::vector<Detection> candidates_;
};

}  // namespace ellipse
