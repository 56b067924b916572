// SPDX-License-Identifier: MIT
#include "core/edges/motion_blur.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/edges/edge_measurement.hpp"
#include "core/edges/noise.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

double squared_across(const Eigen::Vector2f& motion_px, const Eigen::Vector2f& normal) {
  return std::pow(static_cast<double>(normal.dot(motion_px)), 2);
}

// The sharpness s / (1 + loss x squared motion across) of an outline's edges, linearized at a loss
// with the best s for it.
class LinearFit {
 public:
  LinearFit(double loss, std::span<const EdgeMeasurement> edges, const Eigen::Vector2f& motion_px)
      : loss_(loss), edges_(edges), motion_px_(motion_px) {
    double sharpness = 0.0;
    double squares = 0.0;
    double slopes = 0.0;
    for (const EdgeMeasurement& edge : edges_) {
      const double across = squared_across(motion_px_, edge.normal);
      const double share = 1.0 / (1.0 + loss_ * across);
      sharpness += edge.sharpness * share;
      squares += share * share;
      slopes += across * share * share * share;
    }
    sharpest_ = sharpness / squares;
    mean_slope_ = slopes / squares;
  }

  // s.
  [[nodiscard]] double sharpest() const { return sharpest_; }

  // Change of the loss towards the least squares.
  [[nodiscard]] double change() const {
    double products = 0.0;
    double squares = 0.0;
    for (const EdgeMeasurement& edge : edges_) {
      const Row row = row_of(edge);
      products += row.slope * row.residual;
      squares += row.slope * row.slope;
    }
    return squares > 0.0 ? products / squares : 0.0;
  }

  // Standard deviation of the loss; infinite if the edges do not determine it.
  [[nodiscard]] double sigma() const {
    double squares = 0.0;
    ResidualSums residuals;
    for (const EdgeMeasurement& edge : edges_) {
      const Row row = row_of(edge);
      squares += row.slope * row.slope;
      residuals.add(edge.sample, row.residual, std::numeric_limits<double>::infinity(), 1.0);
    }
    return 1.0 / std::sqrt(squares * residuals.information_factor(2, 0.0));
  }

 private:
  struct Row {
    double slope = 0.0;  // by the loss alone: without the part that a change of s explains
    double residual = 0.0;
  };

  [[nodiscard]] Row row_of(const EdgeMeasurement& edge) const {
    const double across = squared_across(motion_px_, edge.normal);
    const double share = 1.0 / (1.0 + loss_ * across);
    return {-sharpest_ * share * (across * share - mean_slope_),
            edge.sharpness - sharpest_ * share};
  }

  double loss_;
  std::span<const EdgeMeasurement> edges_;
  Eigen::Vector2f motion_px_;
  double sharpest_ = 0.0;
  double mean_slope_ = 0.0;
};

// Squared length of the blur in any direction, or 0 without significance. To first order, a length
// l reduces the sharpness s of edges with normals at an angle a to it by s^2 l^2 / 12 cos^2 a: with
// an amplitude of s^2 l^2 / 24.
double squared_length(std::span<const EdgeMeasurement> edges) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  double sum = 0.0;
  for (const EdgeMeasurement& edge : edges) {
    const Eigen::Vector2d n = edge.normal.cast<double>();
    const Eigen::Vector3d row(1.0, n.x() * n.x() - n.y() * n.y(), 2.0 * n.x() * n.y());
    squares += row * row.transpose();
    products += edge.sharpness * row;
    sum += edge.sharpness * edge.sharpness;
  }
  const Eigen::Matrix3d covariance = squares.inverse();
  const Eigen::Vector3d fit = covariance * products;
  const double variance = (sum - fit.dot(products)) / static_cast<double>(edges.size() - 3);
  const double amplitude = fit.tail<2>().norm();
  const double sigma = std::sqrt(variance * covariance.diagonal().tail<2>().maxCoeff());
  return amplitude > kAllSigmas * sigma ? 24.0 * amplitude / (fit[0] * fit[0]) : 0.0;
}

}  // namespace

// The sharpness of a Gaussian edge is the inverse of its variance, to which blur adds. The
// residuals of neighbours are correlated if the sharpness differs for another reason than motion,
// such as a lid over a pupil.
MotionBlur motion_blur(std::span<const EdgeMeasurement> edges, const Eigen::Vector2f& motion_px) {
  if (edges.size() < kMinEdgesOfEllipse || motion_px.isZero()) return {};
  double loss = 0.0;
  LinearFit fit(loss, edges, motion_px);
  for (int step = 0; step < 3; ++step) {
    const double max_loss = uniform_variance(std::max(0.0, fit.sharpest()));
    loss = std::clamp(loss + fit.change(), 0.0, max_loss);
    if (loss == 0.0) break;
    fit = LinearFit(loss, edges, motion_px);
  }
  const Eigen::Vector2f none(0.0F, 0.0F);
  if (!(loss > kAllSigmas * fit.sigma())) {
    const double squared_motion = motion_px.squaredNorm();
    return {none, std::min(squared_motion, squared_length(edges))};
  }
  const double share = std::sqrt(loss / uniform_variance(fit.sharpest()));
  const Eigen::Vector2f px = static_cast<float>(share) * motion_px;
  // Blur that leaves the edges more than half of their sharpness does not hide their maxima.
  return {loss * motion_px.squaredNorm() > 1.0 ? px : none, px.squaredNorm()};
}

}  // namespace ellipse
