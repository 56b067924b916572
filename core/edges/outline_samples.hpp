#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/camera/lens_view.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Min share that counts as most of an outline, of its samples, or of an expected contrast.
inline constexpr double kMajority = 0.5;

/// Unit vectors at evenly spaced angles.
/// @param count  32, 48, 64, 96, 128 or 256.
[[nodiscard]] std::span<const Eigen::Vector2f> circle_directions(std::size_t count);

/// Samples an ellipse of the ideal plane at evenly spaced eccentric anomalies, distorted by a lens.
///
/// Coordinates are relative to the pixel nearest to the ellipse's centre, so that single precision
/// suffices: 6e-8 of its axes. Allocates nothing.
class OutlineSamples {
 public:
  static constexpr std::size_t kMaxSamples = 256;

  /// @param samples  32, 48, 64, 96, 128 or 256.
  OutlineSamples(const Ellipse& e, std::size_t samples, const LensView& lens);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Eigen::Vector2i& origin() const { return origin_; }
  /// Relative to the origin [px of the picture].
  [[nodiscard]] Eigen::Vector2f point(std::size_t k) const { return {x_[k], y_[k]}; }
  /// Outward unit normal.
  [[nodiscard]] Eigen::Vector2f normal(std::size_t k) const { return {nx_[k], ny_[k]}; }
  /// The pixel nearest to the sample, relative to the origin.
  [[nodiscard]] Eigen::Vector2i nearest(std::size_t k) const {
    return {static_cast<int>(std::lrint(x_[k])), static_cast<int>(std::lrint(y_[k]))};
  }
  /// Whether the normal is closer to the row than to the column.
  [[nodiscard]] bool is_along_row(std::size_t k) const {
    return std::abs(nx_[k]) > std::abs(ny_[k]);
  }
  /// Cosine and sine of the eccentric anomaly.
  [[nodiscard]] Eigen::Vector2d anomaly(std::size_t k) const { return around_[k].cast<double>(); }
  /// Length of the outline that the sample represents.
  [[nodiscard]] float length_px(std::size_t k) const { return step_rad_ * speed_[k]; }
  /// Pixels of the picture per pixel of the ideal plane, across the outline.
  [[nodiscard]] float px_per_ideal(std::size_t k) const {
    return is_distorted_ ? px_per_ideal_[k] : 1.0F;
  }
  /// Shift of the outline in the picture per relative growth of the axes [px].
  [[nodiscard]] float px_per_unit(std::size_t k) const {
    return axes_product_ / ideal_speed(k) * px_per_ideal(k);
  }
  /// In the picture [1/px]; neglects the much smaller curvature added by the lens.
  [[nodiscard]] float curvature(std::size_t k) const {
    return px_per_unit(k) / (speed_[k] * speed_[k]);
  }
  /// Turn of the normal in the ideal plane that the sample represents, up to a factor common to all
  /// samples.
  [[nodiscard]] float turn(std::size_t k) const { return 1.0F / (ideal_speed(k) * ideal_speed(k)); }

 private:
  using PerSample = std::array<float, kMaxSamples>;

  // Length per eccentric anomaly, in the ideal plane.
  [[nodiscard]] float ideal_speed(std::size_t k) const {
    return is_distorted_ ? ideal_speed_[k] : speed_[k];
  }
  void distort(const LensView& lens);

  std::size_t size_;
  std::span<const Eigen::Vector2f> around_;  // by the eccentric anomaly
  float step_rad_;
  float axes_product_;
  Eigen::Vector2i origin_;
  bool is_distorted_;
  PerSample x_;
  PerSample y_;
  PerSample nx_;
  PerSample ny_;
  PerSample speed_;  // length per eccentric anomaly, in the picture
  PerSample ideal_speed_;
  PerSample px_per_ideal_;
};

}  // namespace ellipse
