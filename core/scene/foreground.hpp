#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <span>

#include "core/scene/scene.hpp"

namespace ellipse {

/// The light that reaches the sensor, row by row.
struct LightImage {
  std::span<float> light;
  int width = 0;
  int height = 0;
};

/// A part of the picture in which the plane is seen by one homography.
struct Patch {
  int left = 0;  ///< [px]
  int top = 0;
  int width = 0;
  int height = 0;
  Eigen::Matrix3d plane_from_image;
};

/// The sun's mirror image in a patch. @param camera  Its place over the plane [radii of the pad].
void add_glare(const Glare& glare,
               const Eigen::Vector3d& camera,
               const Patch& patch,
               const LightImage& image);

/// More light on one side than on the other. @param gradient  As Light::gradient.
void add_gradient(const Eigen::Vector2d& gradient, const LightImage& image);

/// Less light towards the corners. @param share  As Light::vignette.
void add_vignette(double share, const LightImage& image);

/// What is between the camera and the ground.
void add_bars(const Scene& scene, double time_s, const LightImage& image);

}  // namespace ellipse
