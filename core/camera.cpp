// SPDX-License-Identifier: MIT
#include "core/camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/ellipse_fit.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kWidestRad = 1.53;   // 87.7 degrees: near 90 the ideal plane is endless
constexpr double kLeastSlope = 0.05;  // of the radial map, where it is still one to one
constexpr int kRadialSteps = 512;     // by which that is told
constexpr int kMostIterations = 20;
constexpr double kNearPx = 1e-5;  // from where one step more is exact

// A radial factor and its derivative.
struct Factor {
  double value = 1.0;
  double slope = 0.0;
};

// xd = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) [Brown1971], in the
// rational form of OpenCV. By r^2.
Factor rational_factor(const std::array<double, 8>& d, double r2) {
  const double above = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const double below = 1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7]));
  const double above_slope = d[0] + r2 * (2.0 * d[1] + 3.0 * r2 * d[4]);
  const double below_slope = d[5] + r2 * (2.0 * d[6] + 3.0 * r2 * d[7]);
  const double value = above / below;
  return {value, (above_slope - value * below_slope) / below};
}

// theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) [KannalaBrandt2006] (6).
Factor fisheye_angle(const std::array<double, 8>& d, double theta) {
  const double t2 = theta * theta;
  return {theta * (1.0 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3])))),
          1.0 + t2 * (3.0 * d[0] + t2 * (5.0 * d[1] + t2 * (7.0 * d[2] + t2 * 9.0 * d[3])))};
}

// At focal length 1.
LensPoint distorted(const Camera& camera, const Vector2d& p) {
  const auto& d = camera.distortion;
  const double r2 = p.squaredNorm();
  if (camera.lens == LensModel::kFisheye) {
    const double r = std::sqrt(r2);
    if (r < 1e-9) return {p, Matrix2d::Identity()};
    const Factor angle = fisheye_angle(d, std::atan(r));
    const double factor = angle.value / r;
    const double slope = (angle.slope / (1.0 + r2) - factor) / r2;
    return {factor * p, factor * Matrix2d::Identity() + slope * p * p.transpose()};
  }
  const Factor factor = rational_factor(d, r2);
  const double p1 = d[2];
  const double p2 = d[3];
  const double x = p.x();
  const double y = p.y();
  LensPoint result;
  result.picture_px = factor.value * p + Vector2d(2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                                                  p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y);
  result.slope = factor.value * Matrix2d::Identity() + 2.0 * factor.slope * p * p.transpose();
  const double crossed = 2.0 * (p1 * x + p2 * y);
  result.slope +=
      (Matrix2d() << 2.0 * p1 * y + 6.0 * p2 * x, crossed, crossed, 6.0 * p1 * y + 2.0 * p2 * x)
          .finished();
  return result;
}

// How fast the distorted radius grows with the angle to the axis.
double radial_slope(const Camera& camera, double theta) {
  if (camera.lens == LensModel::kFisheye) return fisheye_angle(camera.distortion, theta).slope;
  const double r = std::tan(theta);
  const Factor factor = rational_factor(camera.distortion, r * r);
  return factor.value > 0.0 ? factor.value + 2.0 * r * r * factor.slope : 0.0;
}

double radial_place(const Camera& camera, double theta) {
  if (camera.lens == LensModel::kFisheye) return fisheye_angle(camera.distortion, theta).value;
  const double r = std::tan(theta);
  return r * rational_factor(camera.distortion, r * r).value;
}

void check(bool is_right, const char* what) {
  if (!is_right) throw std::invalid_argument(what);
}

}  // namespace

Camera Camera::with_hfov(double hfov_rad, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = width / 2.0 / std::tan(hfov_rad / 2.0);
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

bool Camera::is_distorted() const {
  return lens == LensModel::kFisheye ||
         std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; });
}

Camera Camera::resized(int new_width, int new_height) const {
  const double sx = static_cast<double>(new_width) / width;
  const double sy = static_cast<double>(new_height) / height;
  Camera result = *this;
  result.width = new_width;
  result.height = new_height;
  result.fx *= sx;
  result.fy *= sy;
  result.cx = (cx + 0.5) * sx - 0.5;
  result.cy = (cy + 0.5) * sy - 0.5;
  return result;
}

Eigen::Matrix3d Camera::matrix() const {
  Eigen::Matrix3d k;
  k << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0;
  return k;
}

void Camera::validate() const {
  constexpr double kLargest = 1e6;
  const auto is_length = [](double v) { return v > 0.0 && v <= kLargest; };
  const auto is_place = [](double v) { return std::abs(v) <= kLargest; };
  check(width > 0 && width <= kLargest, "width is not between 1 and 1e6 px");
  check(height > 0 && height <= kLargest, "height is not between 1 and 1e6 px");
  check(is_length(fx), "fx is not above 0");
  check(is_length(fy), "fy is not above 0");
  check(is_place(cx), "cx is no place in a picture");
  check(is_place(cy), "cy is no place in a picture");
  for (const double k : distortion) check(std::isfinite(k), "distortion is not finite");
}

Lens::Lens(const Camera& camera) : camera_(camera) {
  double widest = 0.0;
  for (int i = 1; i <= kRadialSteps; ++i) {
    const double theta = kWidestRad * i / kRadialSteps;
    if (!(radial_slope(camera, theta) > kLeastSlope)) break;
    widest = theta;
  }
  largest_squared_ = std::pow(std::tan(widest), 2);
  largest_picture_ = radial_place(camera, widest);
}

std::optional<LensPoint> Lens::picture_from_ideal(const Vector2d& ideal_px) const {
  const Vector2d focal(camera_.fx, camera_.fy);
  const Vector2d middle(camera_.cx, camera_.cy);
  const Vector2d p = (ideal_px - middle).cwiseQuotient(focal);
  if (!(p.squaredNorm() <= largest_squared_)) return std::nullopt;
  LensPoint point = distorted(camera_, p);
  point.picture_px = point.picture_px.cwiseProduct(focal) + middle;
  point.slope = focal.asDiagonal() * point.slope * focal.cwiseInverse().asDiagonal();
  return point;
}

std::optional<Vector2d> Lens::ideal_from_picture(const Vector2d& picture_px) const {
  const Vector2d focal(camera_.fx, camera_.fy);
  const Vector2d middle(camera_.cx, camera_.cy);
  const Vector2d wanted = (picture_px - middle).cwiseQuotient(focal);
  const double radius = wanted.norm();
  if (!(radius <= 1.1 * largest_picture_)) return std::nullopt;
  // A start that is right at small angles, and for an equidistant lens at all.
  Vector2d p = wanted;
  if (camera_.lens == LensModel::kFisheye && radius > 0.0) {
    p *= std::tan(std::min(radius, kWidestRad)) / radius;
  }
  for (int i = 0; i < kMostIterations; ++i) {
    const double beyond = p.squaredNorm() / largest_squared_;
    if (beyond > 1.0) p /= std::sqrt(beyond);
    const LensPoint here = distorted(camera_, p);
    const Vector2d rest = wanted - here.picture_px;
    p += here.slope.inverse() * rest;
    if (rest.cwiseProduct(focal).squaredNorm() < kNearPx * kNearPx) {
      return p.cwiseProduct(focal) + middle;
    }
  }
  return std::nullopt;
}

void bent_outline(const Lens& lens, const Ellipse& ideal, std::span<Vector2d> points_px) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(points_px.size());
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    const auto point = lens.picture_from_ideal(ideal.point_at(step * static_cast<double>(i)));
    points_px[i] =
        point ? point->picture_px : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

std::optional<Ellipse> unbent(const Lens& lens, const Ellipse& in_picture) {
  constexpr int kPoints = 24;
  std::optional<Moments> moments;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * std::numbers::pi * i / kPoints;
    const auto point = lens.ideal_from_picture(in_picture.point_at(t));
    if (!point) continue;
    if (!moments) moments.emplace(*point);
    moments->add(*point);
  }
  return moments ? fit_ellipse(*moments) : std::nullopt;
}

}  // namespace ellipse
