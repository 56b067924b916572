// SPDX-License-Identifier: MIT
#include "core/scene/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/ellipse.hpp"
#include "core/scene/edge.hpp"
#include "core/scene/random.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

double superellipse_radius(double angle_rad, double power) {
  const double c = std::pow(std::abs(std::cos(angle_rad)), power);
  const double s = std::pow(std::abs(std::sin(angle_rad)), power);
  return std::pow(c + s, -1.0 / power);
}

// x^2 + (y / (1 + amount x))^2 = 1 along a ray, by bisection: the left side grows with the radius.
double egg_radius(double angle_rad, double amount) {
  double low = 0.5;
  double high = 1.5;
  for (int i = 0; i < 50; ++i) {
    const double r = 0.5 * (low + high);
    const double x = r * std::cos(angle_rad);
    const double y = r * std::sin(angle_rad) / (1.0 + amount * x);
    (x * x + y * y < 1.0 ? low : high) = r;
  }
  return low;
}

// The third to the ninth harmonic; lower ones would change the ellipse itself.
struct Waves {
  static constexpr std::size_t kCount = 7;
  std::array<double, kCount> amplitudes{};
  std::array<double, kCount> phases{};

  explicit Waves(std::uint64_t seed) {
    Random random(seed);
    for (std::size_t k = 0; k < kCount; ++k) {
      amplitudes[k] = random.between(0.2, 1.0) / (static_cast<double>(k) + 1.0);
      phases[k] = random.between(0.0, kTwoPi);
    }
  }
  [[nodiscard]] double at(double angle_rad) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < kCount; ++k) {
      sum += amplitudes[k] * std::cos((static_cast<double>(k) + 3.0) * angle_rad + phases[k]);
    }
    return sum;
  }
  [[nodiscard]] double largest() const {
    double largest = 0.0;
    for (int i = 0; i < 720; ++i) largest = std::max(largest, std::abs(at(kTwoPi * i / 720.0)));
    return largest;
  }
};

}  // namespace

ShapeEdge::ShapeEdge(const Shape& shape)
    : outline_(shape.outline),
      amount_(shape.amount),
      hole_(shape.hole),
      softness_(shape.softness),
      corners_(shape.corners) {
  if (outline_ == Outline::kMesh) {
    extent_ = std::numeric_limits<double>::infinity();
  } else if (outline_ == Outline::kPolygon) {
    extent_ = 0.0;
    for (const Vector2d& corner : corners_) extent_ = std::max(extent_, corner.norm());
    extent_ += amount_;
  } else if (outline_ != Outline::kEllipse) {
    make_table(shape.seed);
    const auto [low, high] = std::minmax_element(radii_.begin(), radii_.end());
    inner_ = *low;
    extent_ = *high;
  }
}

void ShapeEdge::make_table(std::uint64_t seed) {
  const Waves waves(seed);
  const double scale = outline_ == Outline::kWavy ? amount_ / waves.largest() : 0.0;
  radii_.resize(kTableSize);
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const double angle = kTwoPi * static_cast<double>(i) / kTableSize;
    double radius = 1.0 + scale * waves.at(angle);
    if (outline_ == Outline::kEgg) radius = egg_radius(angle, amount_);
    if (outline_ == Outline::kSuperellipse) radius = superellipse_radius(angle, amount_);
    radii_[i] = static_cast<float>(radius);
  }
}

double ShapeEdge::radius_at(double angle_rad) const {
  if (radii_.empty()) return 1.0;
  const double position = (angle_rad / kTwoPi - std::floor(angle_rad / kTwoPi)) * kTableSize;
  const auto i = static_cast<std::size_t>(position) % kTableSize;
  const auto next = (i + 1) % kTableSize;
  return std::lerp(static_cast<double>(radii_[i]),
                   static_cast<double>(radii_[next]),
                   position - std::floor(position));
}

Vector2d ShapeEdge::outline_at(double angle_rad) const {
  return radius_at(angle_rad) * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

ShapeEdge::Nearness ShapeEdge::from_radius(const Vector2d& point) const {
  const double r = point.norm();
  if (!(r > 0.0)) return {-inner_, {1.0, 0.0}};
  if (radii_.empty()) return {r - 1.0, point / r};
  constexpr double kStep = kTwoPi / kTableSize;
  const double angle = std::atan2(point.y(), point.x());
  const double per_rad = (radius_at(angle + kStep) - radius_at(angle - kStep)) / (2.0 * kStep);
  const Vector2d turned(-point.y(), point.x());
  return {r - radius_at(angle), point / r - per_rad / (r * r) * turned};
}

ShapeEdge::Nearness ShapeEdge::from_corners(const Vector2d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  Vector2d from_outline(1.0, 0.0);
  bool is_inside = false;
  for (std::size_t i = 0, j = corners_.size() - 1; i < corners_.size(); j = i++) {
    const Vector2d& a = corners_[j];
    const Vector2d& b = corners_[i];
    const Vector2d along = b - a;
    const double t = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vector2d off = point - a - t * along;
    if (off.squaredNorm() < nearest) {
      nearest = off.squaredNorm();
      from_outline = off;
    }
    const bool is_crossed = (a.y() > point.y()) != (b.y() > point.y());
    if (is_crossed && point.x() < a.x() + (point.y() - a.y()) / along.y() * along.x()) {
      is_inside = !is_inside;
    }
  }
  const double distance = std::sqrt(nearest);
  const double sign = is_inside ? -1.0 : 1.0;
  const Vector2d gradient =
      distance > 1e-12 ? Vector2d(sign * from_outline / distance) : Vector2d(1.0, 0.0);
  return {sign * distance - amount_, gradient};
}

ShapeEdge::Nearness ShapeEdge::at(const Vector2d& point) const {
  if (outline_ == Outline::kPolygon) return from_corners(point);
  if (outline_ != Outline::kMesh) return from_radius(point);
  const Vector2d off(point.x() - std::round(point.x()), point.y() - std::round(point.y()));
  const bool is_x = std::abs(off.x()) < std::abs(off.y());
  const double d = is_x ? off.x() : off.y();
  const double sign = d < 0.0 ? -1.0 : 1.0;
  return {std::abs(d) - amount_, is_x ? Vector2d(sign, 0.0) : Vector2d(0.0, sign)};
}

double ShapeEdge::mesh_coverage(const Vector2d& point,
                                const Matrix2d& point_per_px,
                                double blur_px) const {
  double uncovered = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double spacing_px = 1.0 / point_per_px.row(axis).norm();
    const double sigma = std::hypot(blur_px / spacing_px, softness_);
    double share = 2.0 * amount_;
    // Wires closer to each other than this blur to an even grey.
    if (sigma < 0.4) {
      const double d = std::abs(point(axis) - std::round(point(axis)));
      const auto wire = [&](double off) {
        return blurred_step((off - amount_) / sigma) - blurred_step((off + amount_) / sigma);
      };
      share = std::min(1.0, wire(d) + wire(1.0 - d));
    }
    uncovered *= 1.0 - share;
  }
  return 1.0 - uncovered;
}

double ShapeEdge::coverage(const Vector2d& point,
                           const Matrix2d& point_per_px,
                           double blur_px) const {
  if (outline_ == Outline::kMesh) return mesh_coverage(point, point_per_px, blur_px);
  const Nearness edge = at(point);
  const double per_px = (point_per_px.transpose() * edge.gradient).norm();
  const double blur = blur_px * per_px;
  const double sigma = std::sqrt(blur * blur + softness_ * softness_);
  const double whole = blurred_step(edge.distance / sigma);
  if (!(hole_ > 0.0) || whole <= 0.0) return whole;
  return whole - blurred_step(hole_ * at(point / hole_).distance / sigma);
}

double ShapeEdge::clearance(const Vector2d& point) const {
  if (outline_ == Outline::kMesh) return 0.0;
  if (outline_ == Outline::kPolygon) {
    const double outer = from_corners(point).distance;
    if (outer > 0.0 || !(hole_ > 0.0)) return outer;
    const double hole = hole_ * from_corners(point / hole_).distance;
    return hole < 0.0 ? -hole : std::max(outer, -hole);
  }
  const double r = point.norm();
  if (r > extent_) return r - extent_;
  if (!(hole_ > 0.0)) return std::min(0.0, r - inner_);
  if (r < hole_ * inner_) return hole_ * inner_ - r;
  return std::min(0.0, std::max(r - inner_, hole_ * extent_ - r));
}

}  // namespace ellipse
