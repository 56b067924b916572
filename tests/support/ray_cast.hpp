#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/circle_pose.hpp"
#include "tests/support/picture.hpp"

namespace support {

/// Light of a plane [grey levels] at a point in pad radii from the pad's centre.
using PlanePaint = std::function<double(const Eigen::Vector2d&)>;

/// A dark ring on a bright square plate on grey ground.
inline PlanePaint painted_ring(double inner_radius) {
  return [inner_radius](const Eigen::Vector2d& at) {
    const double radius = at.norm();
    if (radius <= 1.0 && radius >= inner_radius) return 55.0;
    return at.cwiseAbs().maxCoeff() < 1.5 ? 220.0 : 120.0;
  };
}

/// The same with a free-standing X inside.
inline PlanePaint painted_ring_with_x(double inner_radius) {
  const PlanePaint ring = painted_ring(inner_radius);
  return [ring](const Eigen::Vector2d& at) {
    const double along = std::abs(at.x() + at.y()) * M_SQRT1_2;
    const double across = std::abs(at.x() - at.y()) * M_SQRT1_2;
    const bool is_mark = std::max(along, across) < 0.5 && std::min(along, across) < 0.1;
    return is_mark ? 55.0 : ring(at);
  };
}

/// Renders a plane by ray casting, without code of core/scene: samples the light on a grid inside
/// each pixel, then blurs it with a Gaussian.
class RayCaster {
 public:
  RayCaster(const ellipse::Camera& camera, PlanePaint paint)
      : camera_(camera), lens_(camera), paint_(std::move(paint)) {}

  /// @param pose  Pose of the pad's unit circle.
  [[nodiscard]] std::vector<double> light(const ellipse::CirclePose& pose, double blur_px) const {
    const Eigen::Vector3d first = pose.normal.unitOrthogonal();
    const Eigen::Vector3d second = pose.normal.cross(first);
    const auto light_at = [&](double x, double y) {
      const Eigen::Vector2d ideal =
          camera_.is_distorted() ? lens_.approximate_ideal({x, y}) : Eigen::Vector2d(x, y);
      if (!ideal.allFinite()) return 0.0;
      const Eigen::Vector3d ray(
          (ideal.x() - camera_.cx) / camera_.fx, (ideal.y() - camera_.cy) / camera_.fy, 1.0);
      const double depth = pose.position.dot(pose.normal) / ray.dot(pose.normal);
      if (!(depth > 0.0)) return kSky;
      const Eigen::Vector3d off = depth * ray - pose.position;
      return paint_(Eigen::Vector2d(off.dot(first), off.dot(second)));
    };
    std::vector<double> light;
    light.reserve(static_cast<std::size_t>(camera_.width) *
                  static_cast<std::size_t>(camera_.height));
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) light.push_back(pixel(light_at, x, y));
    }
    blur(light, blur_px);
    return light;
  }

  /// Adds white noise and rounds to grey levels.
  [[nodiscard]] GrayPicture picture(const std::vector<double>& light,
                                    double noise,
                                    std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, noise);
    GrayPicture picture(camera_.width, camera_.height);
    for (std::size_t i = 0; i < light.size(); ++i) {
      picture.pixels[i] =
          static_cast<std::uint8_t>(std::clamp(std::lround(light[i] + normal(random)), 0L, 255L));
    }
    return picture;
  }

 private:
  static constexpr double kSky = 150.0;
  static constexpr int kGrid = 8;  // samples per side of a pixel that an edge crosses

  template <class Light>
  [[nodiscard]] static double pixel(const Light& light_at, int x, int y) {
    const double middle = light_at(x, y);
    bool is_even = true;
    for (const double dy : {-0.5, 0.0, 0.5}) {
      for (const double dx : {-0.5, 0.0, 0.5}) is_even &= light_at(x + dx, y + dy) == middle;
    }
    if (is_even) return middle;
    double sum = 0.0;
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        sum += light_at(x + (i + 0.5) / kGrid - 0.5, y + (j + 0.5) / kGrid - 0.5);
      }
    }
    return sum / (kGrid * kGrid);
  }

  void blur(std::vector<double>& light, double sigma_px) const {
    if (!(sigma_px > 0.0)) return;
    const int reach = static_cast<int>(std::ceil(4.0 * sigma_px));
    std::vector<double> kernel;
    double sum = 0.0;
    for (int i = -reach; i <= reach; ++i) {
      kernel.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
      sum += kernel.back();
    }
    for (double& weight : kernel) weight /= sum;
    const int w = camera_.width;
    const int h = camera_.height;
    std::vector<double> rows(light.size());
    const auto at = [w](int x, int y) { return static_cast<std::size_t>(y * w + x); };
    const auto filter =
        [&](const std::vector<double>& in, std::vector<double>& out, int dx, int dy) {
          for (int y = 0; y < h; ++y) {
            for (int x = 0; x < w; ++x) {
              double total = 0.0;
              for (int i = -reach; i <= reach; ++i) {
                total += kernel[static_cast<std::size_t>(i + reach)] *
                         in[at(std::clamp(x + i * dx, 0, w - 1), std::clamp(y + i * dy, 0, h - 1))];
              }
              out[at(x, y)] = total;
            }
          }
        };
    filter(light, rows, 1, 0);
    filter(rows, light, 0, 1);
  }

  ellipse::Camera camera_;
  ellipse::Lens lens_;
  PlanePaint paint_;
};

}  // namespace support
