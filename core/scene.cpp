// SPDX-License-Identifier: MIT
#include "core/scene.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr double kGroundPeriod = 0.35;  // of the coarser texture, in radii of the ring
constexpr double kPlateRim = 0.12;      // the painted rim of the plate, in radii of the ring

// [Steele2014] SplitMix64: a hash that is the same everywhere.
std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

// Random in [-1, 1] at the corners of a lattice, smooth between them [Perlin1985].
double value_noise(double x, double y, std::uint64_t seed) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto corner = [&](int dx, int dy) {
    const auto ix = static_cast<std::uint64_t>(static_cast<std::int64_t>(fx) + dx);
    const auto iy = static_cast<std::uint64_t>(static_cast<std::int64_t>(fy) + dy);
    const std::uint64_t h = (ix * 0x8da6b343U) ^ (iy * 0xd8163841U) ^ seed;
    return static_cast<double>((h * 0x9e3779b97f4a7c15U) >> 40U) / double{1 << 23} - 1.0;
  };
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = smooth(x - fx);
  const double v = smooth(y - fy);
  return std::lerp(
      std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

// A signed distance on the pad, negative inside, with its gradient. Shapes combine by min and max.
struct Distance {
  double value = 0.0;
  Vector2d gradient{1.0, 0.0};

  bool operator<(const Distance& other) const { return value < other.value; }
  Distance operator-() const { return {-value, -gradient}; }
};

Distance intersection(const Distance& a, const Distance& b) {
  return std::max(a, b);
}
Distance join(const Distance& a, const Distance& b) {
  return std::min(a, b);
}

Distance to_disc(const Vector2d& p, double radius) {
  const double r = p.norm();
  return {r - radius, r > 0.0 ? Vector2d(p / r) : Vector2d(1.0, 0.0)};
}

Distance to_half_plane(const Vector2d& p, const Vector2d& normal, double offset) {
  return {normal.dot(p) - offset, normal};
}

// A rectangle about the centre: |along . p| <= half_length, |across . p| <= half_width.
Distance to_box(const Vector2d& p, const Vector2d& along, double half_length, double half_width) {
  const Vector2d across(-along.y(), along.x());
  const Vector2d towards = along.dot(p) < 0.0 ? Vector2d(-along) : along;
  const Vector2d aside = across.dot(p) < 0.0 ? Vector2d(-across) : across;
  return intersection(to_half_plane(p, towards, half_length), to_half_plane(p, aside, half_width));
}

Distance to_gap(const Vector2d& p, double angle_rad, double width_rad) {
  const double half = width_rad / 2.0;
  const auto normal = [&](double direction) {
    return Vector2d(-std::sin(direction), std::cos(direction));
  };
  return intersection(to_half_plane(p, normal(angle_rad + half), 0.0),
                      to_half_plane(p, -normal(angle_rad - half), 0.0));
}

// The painted part of the pad.
Distance to_pattern(const Scene& scene, const Vector2d& p) {
  Distance paint = to_disc(p, 1.0);
  if (scene.pattern == Pattern::kDisc) return paint;
  paint = intersection(paint, -to_disc(p, 1.0 - scene.ring_width));
  for (const double gap : scene.gaps_rad) {
    paint = intersection(paint, -to_gap(p, gap, scene.gap_width_rad));
  }
  if (scene.pattern == Pattern::kRing) return paint;
  const double half_width = scene.cross_width / 2.0;
  const double diagonal = std::numbers::sqrt2 / 2.0;
  const Distance cross = join(to_box(p, {diagonal, diagonal}, scene.cross_length, half_width),
                              to_box(p, {diagonal, -diagonal}, scene.cross_length, half_width));
  return join(paint, cross);
}

// A step of light seen through the lens: how much of it is inside, by distance over blur.
double blurred_step(double distance_px, double blur_px) {
  return 0.5 * std::erfc(distance_px / (blur_px * std::numbers::sqrt2));
}

// The pad's plane as one pixel sees it.
struct PlanePoint {
  Vector2d p;
  Eigen::Matrix2d per_pixel;  // dp / d(pixel)
  bool is_in_front = false;
};

PlanePoint plane_point(const Matrix3d& pad_from_image, double x, double y) {
  const Eigen::Vector3d q = pad_from_image * Eigen::Vector3d(x, y, 1.0);
  PlanePoint result;
  // H (p, 1) = depth (x, y, 1), so that H^-1 (x, y, 1) = (p, 1) / depth.
  result.is_in_front = q.z() > 0.0;
  if (!result.is_in_front) return result;
  result.p = q.head<2>() / q.z();
  result.per_pixel =
      (pad_from_image.topLeftCorner<2, 2>() - result.p * pad_from_image.bottomLeftCorner<1, 2>()) /
      q.z();
  return result;
}

class Renderer {
 public:
  explicit Renderer(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] double light_at(const PlanePoint& at) const {
    double light = ground_light(at);
    const double reach = std::max(1.0, scene_.plate_half_width) * std::numbers::sqrt2;
    const double pixel = at.per_pixel.norm();
    if (at.p.norm() < reach + 4.0 * pixel * scene_.blur_px) {
      if (scene_.plate_half_width > 0.0) light = over_plate(at, light);
      light = over(at, to_pattern(scene_, at.p), scene_.paint_level, light);
    }
    return light;
  }

  [[nodiscard]] double over_bars(const Vector2d& pixel, double light) const {
    for (const Bar& bar : scene_.bars) {
      const Vector2d along = (bar.to_px - bar.from_px).normalized();
      const Vector2d middle = 0.5 * (bar.from_px + bar.to_px);
      const double half_length = 0.5 * (bar.to_px - bar.from_px).norm();
      const Distance d = to_box(pixel - middle, along, half_length, bar.width_px / 2.0);
      light = std::lerp(light, bar.level, blurred_step(d.value, scene_.blur_px));
    }
    return light;
  }

 private:
  [[nodiscard]] double over(const PlanePoint& at,
                            const Distance& shape,
                            double level,
                            double light) const {
    const double slope = (at.per_pixel.transpose() * shape.gradient).norm();
    return std::lerp(light, level, blurred_step(shape.value / slope, scene_.blur_px));
  }

  [[nodiscard]] double over_plate(const PlanePoint& at, double light) const {
    const Vector2d along(1.0, 0.0);
    const double half = scene_.plate_half_width;
    light = over(at, to_box(at.p, along, half, half), scene_.paint_level + 20.0, light);
    const double inner = half - kPlateRim;
    return over(at, to_box(at.p, along, inner, inner), scene_.plate_level, light);
  }

  // Two octaves, each fading out where it is finer than the pixels.
  [[nodiscard]] double ground_light(const PlanePoint& at) const {
    double light = scene_.ground_level;
    double period = kGroundPeriod;
    double amplitude = scene_.ground_contrast;
    for (std::uint64_t octave = 0; octave < 2; ++octave) {
      const double fade = std::clamp(period / (2.0 * at.per_pixel.norm()) - 0.5, 0.0, 1.0);
      if (fade > 0.0 && amplitude > 0.0) {
        light += fade * amplitude *
                 value_noise(at.p.x() / period, at.p.y() / period, scene_.seed + octave);
      }
      period /= 3.0;
      amplitude *= 0.6;
    }
    return light;
  }

  const Scene& scene_;
};

// The sum of four uniform bytes of a hash, nearly normal, with standard deviation 1.
double sensor_noise(std::uint64_t bits) {
  const auto sum =
      (bits & 0xffU) + ((bits >> 8U) & 0xffU) + ((bits >> 16U) & 0xffU) + ((bits >> 24U) & 0xffU);
  return (static_cast<double>(sum) - 510.0) / 147.8;
}

}  // namespace

Matrix3d image_from_pad(const CameraPose& pose, double hfov_rad, int width, int height) {
  const Eigen::Vector3d forward = (pose.looks_at - pose.position).normalized();
  const Eigen::Vector3d north(0.0, 1.0, 0.0);
  const Eigen::Vector3d right = forward.cross(north).normalized();
  const Eigen::Vector3d down = forward.cross(right);
  Matrix3d camera_from_pad;
  camera_from_pad << right.transpose(), down.transpose(), forward.transpose();
  camera_from_pad = Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                    camera_from_pad;

  const double focal_px = width / 2.0 / std::tan(hfov_rad / 2.0);
  Matrix3d intrinsics;
  intrinsics << focal_px, 0.0, (width - 1) / 2.0, 0.0, focal_px, (height - 1) / 2.0, 0.0, 0.0, 1.0;
  Matrix3d plane;
  plane << camera_from_pad.leftCols<2>(), -camera_from_pad * pose.position;
  return intrinsics * plane;
}

Matrix3d image_from_pad(const Ellipse& outer_edge) {
  const double c = std::cos(outer_edge.angle_rad);
  const double s = std::sin(outer_edge.angle_rad);
  Matrix3d affine;
  affine << outer_edge.semi_major * c, -outer_edge.semi_minor * s, outer_edge.cx,
      outer_edge.semi_major * s, outer_edge.semi_minor * c, outer_edge.cy, 0.0, 0.0, 1.0;
  return affine;
}

std::optional<Ellipse> project_circle(const Matrix3d& image_from_pad, double radius) {
  // The circle is in front of the camera where the third row is positive all along it.
  const Eigen::RowVector3d depth = image_from_pad.row(2);
  if (!(depth(2) > radius * depth.head<2>().norm())) return std::nullopt;
  const Matrix3d pad_from_image = image_from_pad.inverse();
  const Eigen::Vector3d circle(1.0, 1.0, -radius * radius);
  return from_conic(pad_from_image.transpose() * circle.asDiagonal() * pad_from_image);
}

void render(const Scene& scene,
            const Matrix3d& image_from_pad,
            std::uint64_t frame,
            const MutableImage& picture) {
  const Matrix3d pad_from_image = image_from_pad.inverse();
  const Renderer renderer(scene);
  const std::uint64_t noise_seed = hash(scene.seed ^ hash(frame));
  for (int y = 0; y < picture.height; ++y) {
    std::uint8_t* row = picture.data + y * picture.stride;
    for (int x = 0; x < picture.width; ++x) {
      const PlanePoint at = plane_point(pad_from_image, x, y);
      double light = at.is_in_front ? renderer.light_at(at) : scene.plate_level;
      light = renderer.over_bars(Vector2d(x, y), light);
      const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(picture.width) +
                         static_cast<std::uint64_t>(x);
      const double level =
          scene.gain * light + scene.noise * sensor_noise(hash(noise_seed + pixel));
      row[x] = static_cast<std::uint8_t>(std::clamp(level + 0.5, 0.0, 255.0));
    }
  }
}

CameraPose approach_pose(double time_s, double duration_s) {
  constexpr double kHighest = 20.0;
  constexpr double kLowest = 2.6;
  const double progress = 0.5 - 0.5 * std::cos(std::numbers::pi * time_s / duration_s);
  const double height = kHighest * std::pow(kLowest / kHighest, progress);
  const double sway = 0.04 * height;
  CameraPose pose;
  pose.position = {0.45 * height * (1.0 - progress) + sway * std::sin(1.7 * time_s),
                   -0.55 * height * (1.0 - progress) + sway * std::sin(1.1 * time_s + 1.0),
                   height};
  pose.looks_at = {0.12 * height * std::sin(0.9 * time_s) * (1.0 - 0.8 * progress),
                   0.08 * height * std::sin(1.3 * time_s) * (1.0 - 0.8 * progress),
                   0.0};
  pose.roll_rad = 0.35 * std::sin(0.4 * time_s);
  return pose;
}

}  // namespace ellipse
