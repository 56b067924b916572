#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/frame_search.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

/// The tracker of the paper: [Keipour2021] Algorithms 2 and 3. While it tracks, it detects again in
/// every frame, with lowered thresholds, in a region around the last target, at a frame scale that
/// suits the target's size. What is different and why: docs/provenance.md.
///
/// One object serves one stream, one thread at a time. Deterministic.
class RedetectTracker {
 public:
  /// TrackTarget of Algorithm 2: one turn of its loop.
  /// @return The target, without an id and a time; nullopt where it was not found.
  [[nodiscard]] std::optional<Target> track_target(const ScopedFrame& frame,
                                                   FrameSearch& search,
                                                   const TrackerSettings& settings);

 private:
  void prepare_next_frame(const ScopedFrame& frame,
                          const std::optional<Target>& target,
                          double roi_expansion);

  int scale_ = 1;
  Rect roi_;                            // where the target is expected, while it is being tracked
  std::optional<Ellipse> last_target_;  // isTracking: whether there is one
};

/// The scale for the next frame, of Algorithm 2: twice as coarse (up to max_scale) where the
/// target's full major axis at the processed scale is above max_size_px, twice as fine (down to 1)
/// where it is below min_size_px.
[[nodiscard]] int next_scale(
    int scale, int max_scale, double size_px, double min_size_px, double max_size_px);

}  // namespace ellipse
