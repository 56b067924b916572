#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/frame_search.hpp"
#include "core/tracking/settings.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

/// The tracker of [Keipour2021] Algorithms 2 and 3. While tracking, it detects again in every
/// frame, with lowered thresholds, in a region around the last target, at a frame scale that suits
/// the target's size. Deviations from the paper: docs/provenance.md.
///
/// One object serves one stream, one thread at a time. Deterministic.
class RedetectTracker {
 public:
  /// One iteration of TrackTarget of Algorithm 2.
  /// @return The target, without id and time stamp; nullopt if not found.
  [[nodiscard]] std::optional<Target> track_target(const ScopedFrame& frame,
                                                   FrameSearch& search,
                                                   const TrackerSettings& settings);

 private:
  void prepare_next_frame(const ScopedFrame& frame,
                          const std::optional<Target>& target,
                          double roi_expansion);

  int scale_ = 1;
  Rect roi_;                            // region of the next search while tracking
  std::optional<Ellipse> last_target_;  // isTracking if set
};

/// Frame scale for the next frame, from Algorithm 2: doubled (up to max_scale) if the target's full
/// major axis at the processed scale exceeds max_size_px, halved (down to 1) if it is below
/// min_size_px.
[[nodiscard]] int next_scale(
    int scale, int max_scale, double size_px, double min_size_px, double max_size_px);

}  // namespace ellipse
