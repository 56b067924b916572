#pragma once  // SPDX-License-Identifier: MIT

#include <span>
#include <vector>

#include "core/scene/scene.hpp"
#include "core/scene/sheet_picture.hpp"

namespace ellipse {

/// An ellipse in a frame; in the ideal plane, as Truth.
struct TrueEllipse {
  Ellipse ellipse;  ///< The outline [px] or, if it is not an ellipse, the best fit.
  /// The outline's largest distance from it [px]; 0 if exact. Ignores motion blur: the ellipse is
  /// that of the exposure's middle.
  double deviation_px = 0.0;
  /// Share of the outline's length inside the frame that no sheet hides.
  double visible_fraction = 0.0;
  bool is_target = false;
};

/// All ellipses of a frame, both edges of rings, targets first, then by size. Omits invisible ones
/// and those with a semi-minor axis below min_semi_minor_px.
///
/// Thread-safe. Throws as camera_of().
[[nodiscard]] std::vector<TrueEllipse> true_ellipses(
    const Scene& scene, double time_s, int width, int height, double min_semi_minor_px = 2.0);

/// The target as a Truth.
[[nodiscard]] Truth target_of(std::span<const TrueEllipse> ellipses);

}  // namespace ellipse
