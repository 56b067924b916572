// SPDX-License-Identifier: MIT
#include "core/scene/foreground.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/edge.hpp"

namespace ellipse {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

void add_glare(const Glare& glare,
               const Vector3d& camera,
               const Patch& patch,
               const LightImage& image) {
  const Vector2d middle = camera.head<2>() + camera.z() * glare.tilt;
  const double spread = camera.z() * glare.spread;
  for (int y = patch.top; y < patch.top + patch.height; ++y) {
    float* light =
        &image.light[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(patch.left)];
    for (int x = patch.left; x < patch.left + patch.width; ++x, ++light) {
      const Vector3d q = patch.plane_from_image * Vector3d(x, y, 1.0);
      if (!(q.z() > 0.0)) continue;
      const double off = ((q.hnormalized() - middle) / spread).squaredNorm();
      if (off < 24.0) *light += static_cast<float>(glare.level * std::exp(-0.5 * off));
    }
  }
}

void add_gradient(const Vector2d& gradient, const LightImage& image) {
  const Vector2d per_px = gradient / std::max(image.width, 1);
  if (per_px.isZero()) return;
  float* light = image.light.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++light) {
      const Vector2d from_middle(x - 0.5 * (image.width - 1), y - 0.5 * (image.height - 1));
      *light *= static_cast<float>(std::max(0.0, 1.0 + per_px.dot(from_middle)));
    }
  }
}

void add_vignette(double share, const LightImage& image) {
  if (!(share > 0.0)) return;
  const Vector2d middle(0.5 * (image.width - 1), 0.5 * (image.height - 1));
  const double per_squared_px = share / std::max(middle.squaredNorm(), 1.0);
  float* light = image.light.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++light) {
      *light *= static_cast<float>(1.0 - per_squared_px * (Vector2d(x, y) - middle).squaredNorm());
    }
  }
}

void add_bars(const Scene& scene, double time_s, const LightImage& image) {
  const double blur_px = scene.sensor.blur_px;
  Matrix3d bars_from_image;
  bars_from_image << 1.0, 0.0, -0.5 * (image.width - 1), 0.0, 1.0, -0.5 * (image.height - 1), 0.0,
      0.0, image.width;
  for (const Bar& bar : scene.bars) {
    const double swing = std::sin(0.5 * std::numbers::pi * time_s);
    const Vector2d middle = 0.5 * (bar.from + bar.to) + swing * bar.swing;
    const Vector2d length = bar.to - bar.from;
    const Box box = project_box(
        bars_from_image, middle, length.normalized(), 0.5 * length.norm(), 0.5 * bar.width);
    float* light = image.light.data();
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x, ++light) {
        const auto share = static_cast<float>(box.coverage(Vector2d(x, y), blur_px));
        *light += share * (static_cast<float>(bar.level) - *light);
      }
    }
  }
}

}  // namespace ellipse
