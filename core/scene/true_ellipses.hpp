#pragma once  // SPDX-License-Identifier: MIT

#include <span>
#include <vector>

#include "core/scene/scene.hpp"
#include "core/scene/sheet_picture.hpp"

namespace ellipse {

/// An ellipse that a frame shows; of the ideal plane, as Truth.
struct TrueEllipse {
  Ellipse
      ellipse;  ///< The outline itself [px] or, where it is not an ellipse, the best fitting one.
  /// The outline's largest distance from it [px]; 0 where it is exact. Blur by motion is not
  /// counted: the ellipse is that of the exposure's middle.
  double deviation_px = 0.0;
  /// Share of the outline's length inside the frame that no sheet hides.
  double visible_fraction = 0.0;
  bool is_target = false;
};

/// All ellipses of a frame, both edges of rings, targets first, then by size. Those of which
/// nothing is visible, or whose semi-minor axis is below min_semi_minor_px, are left out.
///
/// Thread-safe. Throws as camera_of().
[[nodiscard]] std::vector<TrueEllipse> true_ellipses(
    const Scene& scene, double time_s, int width, int height, double min_semi_minor_px = 2.0);

/// The target as Truth has it.
[[nodiscard]] Truth target_of(std::span<const TrueEllipse> ellipses);

}  // namespace ellipse
