#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/lens_view.hpp"
#include "core/detection/detector.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "core/image/luma.hpp"
#include "core/image/scale.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

/// One frame and its search region. Valid during one call only.
struct ScopedFrame {
  PixelView pixels;
  Rect searchable;                    ///< No pixel outside is read [px]; inside the frame.
  int finest_scale = 1;               ///< Min frame scale.
  LensView lens;                      ///< Of the whole frame.
  std::optional<Camera> camera = {};  ///< If known.
};

/// Searches frame regions with a detector at a given frame scale; results are in frame pixels.
/// Shared by all trackers.
///
/// One object serves one stream, one thread at a time. Deterministic.
class FrameSearch {
 public:
  explicit FrameSearch(std::unique_ptr<Detector> detector) : detector_(std::move(detector)) {}

  void configure(const TrackerSettings& settings);
  void set_detector(std::unique_ptr<Detector> detector);
  /// See Tracker::set_trace().
  void set_trace(DetectionTrace* trace);

  /// Thresholds for a search without a prior, at this scale.
  [[nodiscard]] Thresholds detecting_thresholds(int scale) const;
  /// Lowered thresholds for the surroundings of a tracked target.
  [[nodiscard]] Thresholds tracking_thresholds(int scale) const;

  /// Detects and selects the target, see select_target(). Its id and time stamp are not set.
  ///
  /// @param region       In frame pixels; inside the frame.
  /// @param last_target  Target of the previous frame [frame px]; nullopt = not tracking.
  [[nodiscard]] std::optional<Target> find_target(const ScopedFrame& frame,
                                                  const Rect& region,
                                                  int scale,
                                                  const Thresholds& thresholds,
                                                  const std::optional<Ellipse>& last_target = {});

  /// Searches the whole scope of the frame, without a prior.
  [[nodiscard]] std::optional<Target> detect(const ScopedFrame& frame);

  /// Drops the detections of the last search that are less probable.
  void drop_candidates_below(double probability);

  /// Begins a frame: clears the region and the candidates. Borrows the pixels until the next one.
  void begin(const PixelView& pixels);

  /// The luma of a region of the frame. Valid until the next call of this or of find_target().
  [[nodiscard]] ImageView read(const Rect& region);

  /// Region that was read last [px].
  [[nodiscard]] const Rect& region() const { return region_; }
  /// Detections of the last search [frame px].
  [[nodiscard]] std::span<const Detection> candidates() const { return candidates_; }
  [[nodiscard]] Detector& detector() { return *detector_; }

 private:
  [[nodiscard]] Thresholds thresholds_at(int scale, const Overlaps& overlaps) const;

  TrackerSettings settings_;
  std::unique_ptr<Detector> detector_;
  DetectionTrace* trace_ = nullptr;
  LumaReader luma_reader_;
  Scaler scaler_;
  Rect region_;
  std::vector<Detection> candidates_;
};

}  // namespace ellipse
