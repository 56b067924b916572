// SPDX-License-Identifier: MIT
#include "core/scene/scene.hpp"

namespace ellipse {

Truth truth_of(const Pad& pad, const Eigen::Matrix3d& image_from_pad, int width, int height) {
  Truth truth;
  if (pad.pattern == Pattern::kNone) return truth;
  truth.outer_edge = project_circle(image_from_pad, 1.0);
  if (!truth.outer_edge) return truth;
  truth.visible_fraction = visible_fraction(*truth.outer_edge, width, height);
  if (const auto radius = inner_radius(pad)) {
    truth.inner_edge = project_circle(image_from_pad, *radius);
  }
  return truth;
}

Eigen::Matrix3d image_from_pad(const Scene& scene, double time_s, int width, int height) {
  return image_from_pad(pose_at(scene.flight, time_s), scene.hfov_rad, width, height);
}

}  // namespace ellipse
