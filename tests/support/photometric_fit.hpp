#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/scene.hpp"
#include "tests/support/picture.hpp"

// Estimates the ellipses in a picture, independently of the renderer.
namespace support {

/// The unit circle under p -> c + M u, M symmetric.
using ParameterVector = Eigen::Matrix<double, 5, 1>;

inline ParameterVector parameters_of(const ellipse::Ellipse& e) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(e.angle_rad).toRotationMatrix();
  const Eigen::Matrix2d m =
      turn * Eigen::Vector2d(e.semi_major, e.semi_minor).asDiagonal() * turn.transpose();
  return (ParameterVector() << e.cx, e.cy, m(0, 0), m(0, 1), m(1, 1)).finished();
}

inline ellipse::Ellipse ellipse_of(const ParameterVector& s) {
  Eigen::Matrix2d m;
  m << s(2), s(3), s(3), s(4);
  return ellipse::from_shape(s.head<2>(), m * m).value();
}

/// Light that a pixel receives from inside an ellipse through a Gaussian, by brute force: the mean
/// over a fine grid of points, each a small square that the edge may cut.
class BruteForce {
 public:
  BruteForce(const ParameterVector& s, double blur_px) : center_(s.head<2>()), blur_px_(blur_px) {
    Eigen::Matrix2d m;
    m << s(2), s(3), s(3), s(4);
    whitened_ = m.inverse();
  }

  [[nodiscard]] double at(const Eigen::Vector2d& pixel) const {
    constexpr int kHalf = 4;
    const double step = 3.6 * blur_px_ / kHalf;
    double sum = 0.0;
    double weights = 0.0;
    for (int j = -kHalf; j <= kHalf; ++j) {
      for (int i = -kHalf; i <= kHalf; ++i) {
        const Eigen::Vector2d offset(i * step, j * step);
        const double weight = std::exp(-0.5 * offset.squaredNorm() / (blur_px_ * blur_px_));
        sum += weight * cut_square(pixel + offset, step);
        weights += weight;
      }
    }
    return sum / weights;
  }

 private:
  [[nodiscard]] double cut_square(const Eigen::Vector2d& p, double size) const {
    const Eigen::Vector2d u = whitened_ * (p - center_);
    const double r = u.norm();
    const double slope = (whitened_ * u / r).norm();
    return std::clamp(0.5 - (r - 1.0) / slope / size, 0.0, 1.0);
  }

  Eigen::Vector2d center_;
  double blur_px_;
  Eigen::Matrix2d whitened_;
};

struct Edges {
  ParameterVector outer;
  ParameterVector inner;  // unused for a disc
};

/// Fits all edges at once by Gauss-Newton with numeric derivatives.
class PhotometricFit {
 public:
  PhotometricFit(const ellipse::Scene& scene,
                 const GrayPicture& picture,
                 const ellipse::Truth& truth)
      : scene_(scene), picture_(picture), has_inner_(truth.inner_edge.has_value()) {
    edges_.outer = parameters_of(*truth.outer_edge);
    if (has_inner_) edges_.inner = parameters_of(*truth.inner_edge);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const Eigen::Vector2d p(x, y);
        const bool is_near =
            std::abs(ellipse::sampson_distance(*truth.outer_edge, p)) < 2.5 ||
            (has_inner_ && std::abs(ellipse::sampson_distance(*truth.inner_edge, p)) < 2.5);
        if (is_near) pixels_.push_back(p);
      }
    }
    // Starts off the truth, so that staying at the start fails the test.
    edges_.outer += (ParameterVector() << 0.4, -0.3, 0.3, 0.05, -0.2).finished();
    if (has_inner_) edges_.inner += (ParameterVector() << -0.2, 0.2, -0.1, 0.05, 0.2).finished();
  }

  Edges run() {
    for (int i = 0; i < 4; ++i) step();
    return edges_;
  }

 private:
  [[nodiscard]] Eigen::VectorXd residuals(const Edges& edges) const {
    const BruteForce outer(edges.outer, scene_.sensor.blur_px);
    const BruteForce inner(has_inner_ ? edges.inner : edges.outer, scene_.sensor.blur_px);
    const double contrast = scene_.pad.paint_level - scene_.ground.level;
    Eigen::VectorXd result(static_cast<Eigen::Index>(pixels_.size()));
    Eigen::Index i = 0;
    for (const Eigen::Vector2d& p : pixels_) {
      const double share = outer.at(p) - (has_inner_ ? inner.at(p) : 0.0);
      const auto* row = picture_.view().row(static_cast<int>(p.y()));
      result(i++) = row[static_cast<int>(p.x())] - scene_.ground.level - contrast * share;
    }
    return result;
  }

  void step() {
    constexpr double kDelta = 0.02;
    const int parameters = has_inner_ ? 10 : 5;
    const Eigen::VectorXd now = residuals(edges_);
    Eigen::MatrixXd jacobian(now.size(), parameters);
    for (int k = 0; k < parameters; ++k) {
      Edges moved = edges_;
      (k < 5 ? moved.outer(k) : moved.inner(k - 5)) += kDelta;
      jacobian.col(k) = (residuals(moved) - now) / kDelta;
    }
    const Eigen::VectorXd delta =
        (jacobian.transpose() * jacobian).ldlt().solve(-jacobian.transpose() * now);
    edges_.outer += delta.head<5>();
    if (has_inner_) edges_.inner += delta.tail<5>();
  }

  const ellipse::Scene& scene_;
  const GrayPicture& picture_;
  bool has_inner_;
  std::vector<Eigen::Vector2d> pixels_;
  Edges edges_;
};

/// Checks that the pixels show the ellipse that the truth states.
inline void expect_same(const ellipse::Ellipse& fitted, const ellipse::Ellipse& truth) {
  EXPECT_LE((fitted.center() - truth.center()).norm(), 0.02) << truth.semi_major << " px";
  EXPECT_NEAR(fitted.semi_major, truth.semi_major, 0.05) << truth.aspect_ratio();
  EXPECT_NEAR(fitted.semi_minor, truth.semi_minor, 0.05) << truth.aspect_ratio();
}

}  // namespace support
