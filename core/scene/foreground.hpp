#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <span>

#include "core/scene/scene.hpp"

namespace ellipse {

/// The light at the sensor, row by row.
struct LightImage {
  std::span<float> light;
  int width = 0;
  int height = 0;
};

/// A part of the picture in which one homography maps the plane.
struct Patch {
  int left = 0;  ///< [px]
  int top = 0;
  int width = 0;
  int height = 0;
  Eigen::Matrix3d plane_from_image;
};

/// Adds the sun's reflection in a patch. @param camera  Its position over the plane [pad radii].
void add_glare(const Glare& glare,
               const Eigen::Vector3d& camera,
               const Patch& patch,
               const LightImage& image);

/// Applies a linear change of the light. @param gradient  As Light::gradient.
void add_gradient(const Eigen::Vector2d& gradient, const LightImage& image);

/// Darkens the corners. @param share  As Light::vignette.
void add_vignette(double share, const LightImage& image);

/// Draws the bars in front of the camera.
void add_bars(const Scene& scene, double time_s, const LightImage& image);

}  // namespace ellipse
