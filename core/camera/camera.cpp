// SPDX-License-Identifier: MIT
#include "core/camera/camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/camera/lens_model.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kWidestRad = 1.53;  // 87.7 degrees: the ideal plane diverges at 90
constexpr double kMinSlope = 0.05;   // of the radial map to count as one to one
constexpr int kMaxIterations = 20;   // of Newton's method
constexpr double kNearPx = 1e-5;     // residual after which one more step is exact

// In normalized coordinates (focal length 1).
LensPoint distorted(const Camera& camera, const Vector2d& p) {
  const Distorted<double> at = camera.lens == LensModel::kFisheye
                                   ? kannala_brandt(camera.distortion, p.x(), p.y())
                                   : brown_conrady(camera.distortion, p.x(), p.y());
  LensPoint point{{at.x, at.y}, {}};
  point.slope << at.x_by_x, at.x_by_y, at.y_by_x, at.y_by_y;
  return point;
}

Vector2d tangential_part(const Camera& camera, const Vector2d& p) {
  if (camera.lens == LensModel::kFisheye) return {0.0, 0.0};
  const Distorted<double> aside = tangential(camera.distortion, p.x(), p.y());
  return {aside.x, aside.y};
}

// Derivative of the distorted radius: by the angle for a fisheye, else by the ideal radius.
double radial_slope(const Camera& camera, double theta) {
  if (camera.lens == LensModel::kFisheye) return fisheye_angle(camera.distortion, theta).derivative;
  const double r = std::tan(theta);
  const Slope<double> factor = rational_factor(camera.distortion, r * r);
  return factor.value > 0.0 ? factor.value + 2.0 * r * r * factor.derivative : 0.0;
}

double radial_point(const Camera& camera, double theta) {
  if (camera.lens == LensModel::kFisheye) return fisheye_angle(camera.distortion, theta).value;
  const double r = std::tan(theta);
  return r * rational_factor(camera.distortion, r * r).value;
}

// Linear map of one coordinate to focal length 1, or back.
struct Axis {
  float scale;
  float offset;
};

struct Distortion {
  std::array<float, 8> distortion;
  float largest_squared;
  float focal_ratio;  // fx / fy
  Axis to_x, to_y, from_x, from_y;
};

template <LensModel kModel>
ELLIPSE_INLINE void distort_all(Distortion by, const CurveSamples& samples) {
  const auto far = static_cast<float>(kFarPx);
  ELLIPSE_NO_ALIAS
  for (std::size_t k = 0; k < samples.count; ++k) {
    const float x = by.to_x.scale * samples.x[k] + by.to_x.offset;
    const float y = by.to_y.scale * samples.y[k] + by.to_y.offset;
    const float nx = samples.nx[k];
    const float ny = samples.ny[k];
    const Distorted<float> at = kModel == LensModel::kFisheye ? kannala_brandt(by.distortion, x, y)
                                                              : brown_conrady(by.distortion, x, y);
    const float x_by_y = at.x_by_y * by.focal_ratio;
    const float y_by_x = at.y_by_x / by.focal_ratio;
    // Normals transform by the inverse transpose.
    const float across_x = at.y_by_y * nx - y_by_x * ny;
    const float across_y = at.x_by_x * ny - x_by_y * nx;
    const float along = std::sqrt(across_x * across_x + across_y * across_y);
    const bool is_shown = x * x + y * y <= by.largest_squared;
    samples.x[k] = is_shown ? by.from_x.scale * at.x + by.from_x.offset : far;
    samples.y[k] = is_shown ? by.from_y.scale * at.y + by.from_y.offset : far;
    samples.nx[k] = across_x / along;
    samples.ny[k] = across_y / along;
    samples.px_per_ideal_along[k] = along;
    samples.px_per_ideal[k] = (at.x_by_x * at.y_by_y - x_by_y * y_by_x) / along;
  }
}

void distort_baseline(LensModel model, const Distortion& by, const CurveSamples& samples) {
  model == LensModel::kFisheye ? distort_all<LensModel::kFisheye>(by, samples)
                               : distort_all<LensModel::kBrownConrady>(by, samples);
}

ELLIPSE_AVX2 void distort_avx2(LensModel model, const Distortion& by, const CurveSamples& samples) {
  model == LensModel::kFisheye ? distort_all<LensModel::kFisheye>(by, samples)
                               : distort_all<LensModel::kBrownConrady>(by, samples);
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
  const auto is_length = [](double v) { return v > 0.0 && v <= kFarPx; };
  const auto is_coordinate = [](double v) { return std::abs(v) <= kFarPx; };
  check(width > 0 && width <= kFarPx, "width is not between 1 and 1e6 px");
  check(height > 0 && height <= kFarPx, "height is not between 1 and 1e6 px");
  check(is_length(fx), "fx is not in (0, 1e6] px");
  check(is_length(fy), "fy is not in (0, 1e6] px");
  check(is_coordinate(cx), "cx is not between -1e6 and 1e6 px");
  check(is_coordinate(cy), "cy is not between -1e6 and 1e6 px");
  for (const double k : distortion) check(std::isfinite(k), "distortion is not finite");
}

Lens::Lens(const Camera& camera)
    : camera_(camera),
      focal_(camera.fx, camera.fy),
      inverse_focal_(focal_.cwiseInverse()),
      middle_(camera.cx, camera.cy) {
  double widest = 0.0;
  for (std::size_t i = 1; i <= kTableSize; ++i) {
    const double theta = kWidestRad * static_cast<double>(i) / kTableSize;
    if (!(radial_slope(camera, theta) > kMinSlope)) break;
    widest = theta;
  }
  largest_squared_ = std::pow(std::tan(widest), 2);
  largest_picture_ = radial_point(camera, widest);
  if (camera.is_distorted()) make_table();
}

// Radius of the picture's corners, with their tangential distortion.
double Lens::farthest_radius() const {
  double farthest = 0.0;
  for (const double x : {-1.0, 1.0 * camera_.width}) {
    for (const double y : {-1.0, 1.0 * camera_.height}) {
      const auto ideal = ideal_from_picture({x, y});
      if (!ideal) return largest_picture_;
      const double aside = tangential_part(camera_, ray(*ideal)).norm();
      farthest = std::max(farthest, ray({x, y}).norm() + aside);
    }
  }
  return std::min(farthest, largest_picture_);
}

// Covers the picture to its corners. Inverts the radial part by Newton's method, starting from the
// angle of the previous entry.
void Lens::make_table() {
  const double end = farthest_radius();
  table_scale_ = kTableSize / (end * end);
  table_[0] = 1.0F;
  double theta = 0.0;
  for (std::size_t i = 1; i <= kTableSize; ++i) {
    const double distorted_radius = std::sqrt(static_cast<double>(i) / table_scale_);
    for (int step = 0; step < kMaxIterations; ++step) {
      const double t = std::tan(theta);
      const double per_angle = camera_.lens == LensModel::kFisheye ? 1.0 : 1.0 + t * t;
      theta += (distorted_radius - radial_point(camera_, theta)) /
               (per_angle * radial_slope(camera_, theta));
    }
    table_[i] = static_cast<float>(std::tan(theta) / distorted_radius);
  }
  table_.back() = table_[kTableSize];
}

// Ignores the tangential part.
Vector2d Lens::from_table(const Vector2d& distorted) const {
  const double at = distorted.squaredNorm() * table_scale_;
  if (!(at <= kTableSize)) return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const auto k = static_cast<std::size_t>(at);
  const auto beyond = static_cast<float>(at - static_cast<double>(k));
  return static_cast<double>(table_[k] + beyond * (table_[k + 1] - table_[k])) * distorted;
}

Vector2d Lens::approximate_ideal(const Vector2d& picture_px) const {
  if (!(table_scale_ > 0.0)) return picture_px;
  const Vector2d distorted_ray = ray(picture_px);
  const Vector2d first = from_table(distorted_ray);
  const Vector2d aside = tangential_part(camera_, first);
  return pixel(aside.isZero(0.0) ? first : from_table(distorted_ray - aside));
}

std::optional<LensPoint> Lens::picture_from_ideal(const Vector2d& ideal_px) const {
  const Vector2d p = ray(ideal_px);
  if (!(p.squaredNorm() <= largest_squared_)) return std::nullopt;
  LensPoint point = distorted(camera_, p);
  point.picture_px = pixel(point.picture_px);
  point.slope(0, 1) *= focal_.x() * inverse_focal_.y();
  point.slope(1, 0) *= focal_.y() * inverse_focal_.x();
  return point;
}

void Lens::distort(const Vector2d& origin_px, double scale, const CurveSamples& samples) const {
  Distortion by{};
  for (std::size_t i = 0; i < by.distortion.size(); ++i) {
    by.distortion[i] = static_cast<float>(camera_.distortion[i]);
  }
  by.largest_squared = static_cast<float>(largest_squared_);
  by.focal_ratio = static_cast<float>(camera_.fx / camera_.fy);
  const auto axis = [](double factor, double offset) {
    return Axis{static_cast<float>(factor), static_cast<float>(offset)};
  };
  const Vector2d first = ray(origin_px);
  const Vector2d back = (middle_ - origin_px) / scale;
  by.to_x = axis(scale * inverse_focal_.x(), first.x());
  by.to_y = axis(scale * inverse_focal_.y(), first.y());
  by.from_x = axis(focal_.x() / scale, back.x());
  by.from_y = axis(focal_.y() / scale, back.y());
  (best_simd() == Simd::kAvx2 ? distort_avx2 : distort_baseline)(camera_.lens, by, samples);
}

std::optional<Vector2d> Lens::ideal_from_picture(const Vector2d& picture_px) const {
  const Vector2d distorted_ray = ray(picture_px);
  const double radius = distorted_ray.norm();
  if (!std::isfinite(radius)) return std::nullopt;
  // Initial value: exact at small angles, and at all angles for an equidistant lens.
  Vector2d p = distorted_ray;
  if (camera_.lens == LensModel::kFisheye && radius > 0.0) {
    p *= std::tan(std::min(radius, kWidestRad)) / radius;
  }
  for (int i = 0; i < kMaxIterations; ++i) {
    const double beyond = p.squaredNorm() / largest_squared_;
    if (beyond > 1.0) p /= std::sqrt(beyond);
    const LensPoint here = distorted(camera_, p);
    const Vector2d rest = distorted_ray - here.picture_px;
    p += here.slope.inverse() * rest;
    if (rest.cwiseProduct(focal_).squaredNorm() < kNearPx * kNearPx) return pixel(p);
  }
  return std::nullopt;
}

}  // namespace ellipse
