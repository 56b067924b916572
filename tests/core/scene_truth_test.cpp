// SPDX-License-Identifier: MIT
//
// The truth is what the picture shows: an estimate that shares nothing with the renderer, fitted to
// the grey levels around the edges, finds the ellipses that the truth gives.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "core/scene/random.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::Picture;

// The unit circle under p -> c + M u, M symmetric.
using Shape = Eigen::Matrix<double, 5, 1>;

Shape shape_of(const Ellipse& e) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(e.angle_rad).toRotationMatrix();
  const Eigen::Matrix2d m =
      turn * Eigen::Vector2d(e.semi_major, e.semi_minor).asDiagonal() * turn.transpose();
  return (Shape() << e.cx, e.cy, m(0, 0), m(0, 1), m(1, 1)).finished();
}

Ellipse ellipse_of(const Shape& s) {
  Eigen::Matrix2d m;
  m << s(2), s(3), s(3), s(4);
  return from_shape(s.head<2>(), m * m).value();
}

// Light inside an ellipse as a pixel sees it through a Gaussian, by brute force: the mean over a
// fine grid of points, each a small square that the edge may cut.
class BruteForce {
 public:
  BruteForce(const Shape& s, double blur_px) : center_(s.head<2>()), blur_px_(blur_px) {
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
  Shape outer;
  Shape inner;  // unused for a disc
};

// Fits all edges at once by Gauss-Newton with numeric derivatives.
class PhotometricFit {
 public:
  PhotometricFit(const Scene& scene, const Picture& picture, const Truth& truth)
      : scene_(scene), picture_(picture), has_inner_(truth.inner_edge.has_value()) {
    edges_.outer = shape_of(*truth.outer_edge);
    if (has_inner_) edges_.inner = shape_of(*truth.inner_edge);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const Eigen::Vector2d p(x, y);
        const bool is_near = std::abs(sampson_distance(*truth.outer_edge, p)) < 2.5 ||
                             (has_inner_ && std::abs(sampson_distance(*truth.inner_edge, p)) < 2.5);
        if (is_near) pixels_.push_back(p);
      }
    }
    // The start is off, so that staying there is no success.
    edges_.outer += (Shape() << 0.4, -0.3, 0.3, 0.05, -0.2).finished();
    if (has_inner_) edges_.inner += (Shape() << -0.2, 0.2, -0.1, 0.05, 0.2).finished();
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

  const Scene& scene_;
  const Picture& picture_;
  bool has_inner_;
  std::vector<Eigen::Vector2d> pixels_;
  Edges edges_;
};

void expect_same(const Ellipse& fitted, const Ellipse& truth) {
  EXPECT_LE((fitted.center() - truth.center()).norm(), 0.02) << truth.semi_major << " px";
  EXPECT_NEAR(fitted.semi_major, truth.semi_major, 0.05) << truth.aspect_ratio();
  EXPECT_NEAR(fitted.semi_minor, truth.semi_minor, 0.05) << truth.aspect_ratio();
}

// One of 20 views through a pinhole camera: radii from 15 to 150 px, aspect ratios from 1 to 4.
class SceneTruth : public testing::TestWithParam<int> {
 protected:
  static constexpr int kWidth = 400;
  static constexpr int kHeight = 360;

  [[nodiscard]] static Eigen::Matrix3d view() {
    Random random(static_cast<std::uint64_t>(GetParam()));
    const double radius_px = 15.0 * std::pow(10.0, GetParam() / 19.0);
    const double tilt_rad = std::acos(1.0 / random.between(1.0, 4.0));
    const double azimuth_rad = random.between(-2.5, -0.6);
    const double distance = 0.5 * kWidth / std::tan(0.5) / radius_px;
    CameraPose pose;
    pose.position = distance * Eigen::Vector3d(std::sin(tilt_rad) * std::cos(azimuth_rad),
                                               std::sin(tilt_rad) * std::sin(azimuth_rad),
                                               std::cos(tilt_rad));
    pose.looks_at = {0.1 * random.unit(), 0.1 * random.unit(), 0.0};
    pose.roll_rad = random.between(-1.5, 1.5);
    return image_from_pad(pose, 1.0, kWidth, kHeight);
  }

  static void check(Pattern pattern) {
    Scene scene = support::plain_ring();
    scene.pad.pattern = pattern;
    scene.sensor.read_noise = 0.0;
    Picture picture(kWidth, kHeight);
    const Truth truth = SceneRenderer(scene).render(view(), 0, picture.writable());
    const Edges edges = PhotometricFit(scene, picture, truth).run();
    expect_same(ellipse_of(edges.outer), *truth.outer_edge);
    if (truth.inner_edge) expect_same(ellipse_of(edges.inner), *truth.inner_edge);
  }
};

TEST_P(SceneTruth, OfADiscIsWhatItsPixelsShow) {
  check(Pattern::kDisc);
}

TEST_P(SceneTruth, OfARingIsWhatItsPixelsShow) {
  check(Pattern::kRing);
}

INSTANTIATE_TEST_SUITE_P(Views, SceneTruth, testing::Range(0, 20));

}  // namespace
}  // namespace ellipse
