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

/// The sun's mirror image, where the view tells the camera's place.
void add_glare(const Glare& glare, const View& view, const LightImage& image);

/// More light on one side than on the other. @param gradient  As Light::gradient.
void add_gradient(const Eigen::Vector2d& gradient, const LightImage& image);

/// What is between the camera and the ground.
void add_bars(const Scene& scene, double time_s, const LightImage& image);

}  // namespace ellipse
