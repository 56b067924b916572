// SPDX-License-Identifier: MIT
#include "core/scene/pad.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "core/scene/random.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRimWidth = 0.12;  // of the plate [radii]
constexpr double kHBarAt = 0.36;    // the H's upright bars, from the middle [radii]
constexpr int kFirstHarmonic = 3;   // lower ones would move the ellipse itself

// Capacity for the bullseye. An array, since every view computes it.
struct Radii {
  std::array<double, 5> values{};
  std::size_t count = 0;

  [[nodiscard]] std::span<const double> all() const { return {values.data(), count}; }
};

// The edges of the painted circles, from the outermost.
Radii radii_of(const Pad& pad) {
  const double inner = 1.0 - pad.ring_width;
  switch (pad.pattern) {
    case Pattern::kNone:
      return {};
    case Pattern::kDisc:
      return {{1.0}, 1};
    case Pattern::kBullseye:
      return {{1.0, inner, 0.75 * inner, 0.5 * inner, 0.25 * inner}, 5};
    case Pattern::kRingX:
    case Pattern::kRing:
    case Pattern::kRingH:
      break;
  }
  return {{1.0, inner}, 2};
}

}  // namespace

std::optional<double> inner_radius(const Pad& pad) {
  const Radii radii = radii_of(pad);
  return radii.count > 1 ? std::optional(radii.values[1]) : std::nullopt;
}

std::vector<double> edge_radii(const Pad& pad) {
  const Radii radii = radii_of(pad);
  return {radii.all().begin(), radii.all().end()};
}

PadPicture::PadPicture(const Pad& pad, double blur_px, std::uint64_t seed)
    : pad_(pad), blur_px_(blur_px) {
  if (pad_.deformation > 0.0) deform_edges(seed);
}

// A smooth random deviation from the circle, scaled to the given amplitude.
void PadPicture::deform_edges(std::uint64_t seed) {
  Random random(seed);
  for (std::size_t k = 0; k < kHarmonics; ++k) {
    const double fall = std::sqrt(static_cast<double>(k) + 1.0);
    cosines_[k] = random.between(-1.0, 1.0) / fall;
    sines_[k] = random.between(-1.0, 1.0) / fall;
  }
  double largest = 0.0;
  for (int i = 0; i < 720; ++i) {
    double value = 0.0;
    for (std::size_t k = 0; k < kHarmonics; ++k) {
      const double angle = (static_cast<double>(k) + kFirstHarmonic) * i * std::numbers::pi / 360.0;
      value += cosines_[k] * std::cos(angle) + sines_[k] * std::sin(angle);
    }
    largest = std::max(largest, std::abs(value));
  }
  for (std::size_t k = 0; k < kHarmonics; ++k) {
    cosines_[k] *= pad_.deformation / largest;
    sines_[k] *= pad_.deformation / largest;
  }
}

void PadPicture::look(const Matrix3d& plane_from_image) {
  plane_from_image_ = plane_from_image;
  circles_.clear();
  bars_.clear();
  gaps_.clear();
  const Radii radii = radii_of(pad_);
  for (const double radius : radii.all()) circles_.emplace_back(plane_from_image, radius);
  if (circles_.empty()) return;

  const auto box = [&](const Vector2d& center, const Vector2d& along, double length, double width) {
    return project_box(plane_from_image, center, along, length, width);
  };
  const double half_width = pad_.mark_width / 2.0;
  const double diagonal = std::numbers::sqrt2 / 2.0;
  if (pad_.pattern == Pattern::kRingX) {
    bars_.push_back(box({0.0, 0.0}, {diagonal, diagonal}, pad_.mark_length, half_width));
    bars_.push_back(box({0.0, 0.0}, {diagonal, -diagonal}, pad_.mark_length, half_width));
  } else if (pad_.pattern == Pattern::kRingH) {
    const double upright = 0.8 * pad_.mark_length;
    bars_.push_back(box({-kHBarAt, 0.0}, {0.0, 1.0}, upright, half_width));
    bars_.push_back(box({kHBarAt, 0.0}, {0.0, 1.0}, upright, half_width));
    bars_.push_back(box({0.0, 0.0}, {1.0, 0.0}, kHBarAt, half_width));
  }
  for (const double angle : pad_.gaps_rad) {
    const double left = angle + pad_.gap_width_rad / 2.0;
    const double right = angle - pad_.gap_width_rad / 2.0;
    gaps_.push_back(
        {project_half_plane(plane_from_image, {-std::sin(left), std::cos(left)}, 0.0),
         project_half_plane(plane_from_image, {std::sin(right), -std::cos(right)}, 0.0)});
  }
  const double half = pad_.plate_half_width;
  rim_ = box({0.0, 0.0}, {1.0, 0.0}, half, half);
  plate_ = box({0.0, 0.0}, {1.0, 0.0}, half - kRimWidth, half - kRimWidth);
}

PadPicture::Layers PadPicture::at(const Vector2d& pixel) const {
  Layers layers;
  if (circles_.empty()) return layers;
  if (pad_.plate_half_width > 0.0) {
    layers.rim = rim_.coverage(pixel, blur_px_);
    layers.plate = plate_.coverage(pixel, blur_px_);
  }
  layers.paint = painted(pixel);
  return layers;
}

// Blur is linear, so nested discs combine exactly: a ring is a disc minus a smaller disc.
double PadPicture::painted(const Vector2d& pixel) const {
  double ring = 0.0;
  double innermost = 0.0;
  double sign = 1.0;
  for (const CircularEdge& circle : circles_) {
    innermost = inside(circle, pixel);
    ring += sign * innermost;
    sign = -sign;
    if (innermost <= 0.0) break;
  }
  for (const Wedge& gap : gaps_) {
    ring *= 1.0 - gap.left.coverage(pixel, blur_px_) * gap.right.coverage(pixel, blur_px_);
  }
  return bars_.empty() || innermost <= 0.0 ? ring : ring + innermost * mark(pixel);
}

double PadPicture::mark(const Vector2d& pixel) const {
  double uncovered = 1.0;
  for (const Box& bar : bars_) uncovered *= 1.0 - bar.coverage(pixel, blur_px_);
  return 1.0 - uncovered;
}

double PadPicture::inside(const CircularEdge& circle, const Vector2d& pixel) const {
  if (!(pad_.deformation > 0.0)) return circle.coverage(pixel, blur_px_);
  const Vector3d q = plane_from_image_ * pixel.homogeneous();
  const Vector2d p = q.head<2>() / q.z();
  const double r = p.norm();
  if (!(r > 0.0)) return 1.0;
  const std::complex<double> turn(p.x() / r, p.y() / r);
  std::complex<double> power = turn * turn * turn;
  double shift = 0.0;
  double shift_per_rad = 0.0;
  for (std::size_t k = 0; k < kHarmonics; ++k) {
    shift += cosines_[k] * power.real() + sines_[k] * power.imag();
    shift_per_rad += (static_cast<double>(k) + kFirstHarmonic) *
                     (sines_[k] * power.real() - cosines_[k] * power.imag());
    power *= turn;
  }
  const Vector2d gradient = (p - circle.radius() * shift_per_rad / r * Vector2d(-p.y(), p.x())) / r;
  const Matrix2d per_pixel =
      (plane_from_image_.topLeftCorner<2, 2>() - p * plane_from_image_.bottomLeftCorner<1, 2>()) /
      q.z();
  const double slope = (per_pixel.transpose() * gradient).norm();
  return blurred_step((r - circle.radius() * (1.0 + shift)) / (slope * blur_px_));
}

bool PadPicture::is_uniform(const Vector2d& center_px,
                            double half_px,
                            const Vector2d& center,
                            double half) const {
  if (circles_.empty()) return true;
  const double blur_reach_px = kStepReach * blur_px_;
  const double reach_px = half_px + blur_reach_px;
  // The margin allows for a change of scale within the block.
  const double reach = 1.2 * half * reach_px / half_px;
  const double outermost =
      std::max(1.0 + pad_.deformation, pad_.plate_half_width * std::numbers::sqrt2);
  const double r = center.norm();
  if (r > outermost + reach) return true;
  for (const CircularEdge& circle : circles_) {
    if (std::abs(r - circle.radius()) <= reach + pad_.deformation) return false;
  }
  if (pad_.plate_half_width > 0.0 && r > pad_.plate_half_width - kRimWidth - reach) {
    if (!rim_.is_clear_of(center_px, reach_px)) return false;
    if (!plate_.is_clear_of(center_px, reach_px)) return false;
  }
  if (r - reach > 1.0 + pad_.deformation) return true;
  for (const Box& bar : bars_) {
    if (!bar.is_clear_of(center_px, reach_px)) return false;
  }
  for (const Wedge& gap : gaps_) {
    if (std::abs(gap.left.distance_px(center_px)) <= reach_px) return false;
    if (std::abs(gap.right.distance_px(center_px)) <= reach_px) return false;
  }
  return true;
}

}  // namespace ellipse
