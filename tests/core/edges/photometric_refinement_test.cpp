// SPDX-License-Identifier: MIT
#include "core/edges/photometric_refinement.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::bar_px;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;

constexpr double kContrast = 145.0;  // of plain_ring()

Scene disc(double blur_px, double noise) {
  Scene scene = plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  scene.sensor.blur_px = blur_px;
  scene.sensor.read_noise = noise;
  return scene;
}

Ellipse nudged(Ellipse e, Random& random, double max_px) {
  e.cx += random.between(-max_px, max_px);
  e.cy += random.between(-max_px, max_px);
  e.semi_major += random.between(0.0, max_px);
  e.semi_minor += random.between(-max_px, 0.0);
  return e;
}

// The Cramer-Rao bound of a coordinate of the centre [px] with unknown ellipse, levels and blur:
// from the Fisher information of all pixels along the edge [Kay1993] 3.7, integrated around the
// perimeter and across it.
double bound_px(const Ellipse& e, double blur_px, double noise) {
  using Vector8d = Eigen::Matrix<double, 8, 1>;
  Eigen::Matrix<double, 8, 8> information = Eigen::Matrix<double, 8, 8>::Zero();
  const int steps = 360;
  const double across_px = 0.1;
  const Eigen::Vector2d axis(std::cos(e.angle_rad), std::sin(e.angle_rad));
  const Eigen::Vector2d other(-axis.y(), axis.x());
  for (int i = 0; i < steps; ++i) {
    const double t = 2.0 * std::numbers::pi * (i + 0.5) / steps;
    const double u = std::cos(t);
    const double v = std::sin(t);
    const Eigen::Vector2d across = e.semi_minor * u * axis + e.semi_major * v * other;
    const double length_px = across.norm() * 2.0 * std::numbers::pi / steps;
    const Eigen::Vector2d normal = across.normalized();
    const double px = 1.0 / std::hypot(u / e.semi_major, v / e.semi_minor);
    for (double d = -4.0 * blur_px; d <= 4.0 * blur_px; d += across_px) {
      const double z = d / blur_px;
      const double slope = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi) / blur_px;
      const double step = 0.5 * std::erfc(-z / std::numbers::sqrt2);
      const double k = kContrast * slope;
      Vector8d row;
      row << k * normal.x(), k * normal.y(), k * px, k * px * (u * u - v * v), k * px * 2.0 * u * v,
          1.0, step, k * z;
      const double variance = noise * noise + 1.0 / 12.0;  // rounding to grey levels
      information += row * row.transpose() * (length_px * across_px / variance);
    }
  }
  const Eigen::Matrix<double, 8, 8> covariance = information.inverse();
  return std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
}

struct CentreErrors {
  double rms_px = 0.0;     // of a coordinate of the centre
  double radius_px = 0.0;  // mean
  double bound_px = 0.0;
};

CentreErrors errors_of(double radius, double blur_px, double noise) {
  const Scene scene = disc(blur_px, noise);
  Random random(static_cast<std::uint64_t>(100.0 * radius + noise));
  const int pictures = 48;
  CentreErrors errors;
  for (int i = 0; i < pictures; ++i) {
    const Ellipse truth = support::random_ellipse(random, 130, 130, radius);
    const GrayPicture picture = rendered(scene, truth, 260, 260, static_cast<std::uint64_t>(i));
    const auto refined = refined_photometrically(
        picture.view(), nudged(truth, random, 0.2), Polarity::kDarkInside, 9.0, 20.0);
    EXPECT_TRUE(refined) << radius << " " << noise << " " << i;
    if (!refined) continue;
    const Ellipse& found = refined->ellipse;
    errors.rms_px += 0.5 * (found.center() - truth.center()).squaredNorm() / pictures;
    errors.radius_px += (mean_radius_px(found) - radius) / pictures;
    errors.bound_px += bound_px(truth, blur_px, noise) / pictures;
  }
  errors.rms_px = std::sqrt(errors.rms_px);
  return errors;
}

TEST(PhotometricRefinement, ApproachesTheCramerRaoBound) {
  for (const double radius : {12.0, 20.0, 40.0, 70.0}) {
    for (const double noise : {4.0, 8.0}) {
      const CentreErrors errors = errors_of(radius, 0.7, noise);
      EXPECT_LE(errors.rms_px, 1.6 * errors.bound_px) << radius << " noise " << noise;
      EXPECT_GE(errors.rms_px, 0.7 * errors.bound_px) << "the bound is wrong";
      EXPECT_LE(std::abs(errors.radius_px), 0.02) << radius << " noise " << noise;
    }
  }
}

TEST(PhotometricRefinement, AdaptsToTheBlurOfTheEdge) {
  for (const double blur_px : {0.5, 1.0, 1.5}) {
    const CentreErrors errors = errors_of(50.0, blur_px, 4.0);
    EXPECT_LE(errors.rms_px, 2.5 * errors.bound_px) << blur_px;
  }
}

TEST(PhotometricRefinement, ConvergesFromOverHalfAPixelAway) {
  const Ellipse truth{130.3, 129.6, 60.0, 40.0, 0.4};
  const GrayPicture picture = rendered(disc(0.7, 0.0), truth, 260, 260);
  Ellipse start = truth;
  start.cx += 0.5;
  start.cy -= 0.4;
  const auto refined =
      refined_photometrically(picture.view(), start, Polarity::kDarkInside, 9.0, 20.0);
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 0.03);
}

TEST(PhotometricRefinement, IsUnaffectedByOccludersAndShadows) {
  const Ellipse truth{130.3, 129.6, 70.0, 50.0, 0.4};
  Scene scene = disc(0.7, 2.0);
  scene.bars = {bar_px({60.0, 0.0}, {110.0, 259.0}, 14.0, 30.0, 260, 260),
                bar_px({140.0, 200.0}, {259.0, 120.0}, 9.0, 240.0, 260, 260)};
  scene.light.shadows = {{0.5, 0.4, 0.35, 0.45, 0.02}};
  const GrayPicture picture = rendered(scene, truth, 260, 260);
  Random random(7);
  const auto refined = refined_photometrically(
      picture.view(), nudged(truth, random, 0.2), Polarity::kDarkInside, 9.0, 20.0);
  ASSERT_TRUE(refined);
  EXPECT_LT(max_difference_px(refined->ellipse, truth), 0.05);
}

TEST(PhotometricRefinement, UsesThePartInsideThePicture) {
  const Ellipse truth{20.3, 129.6, 60.0, 50.0, 0.4};
  const GrayPicture picture = rendered(disc(0.7, 2.0), truth, 260, 260);
  const auto refined =
      refined_photometrically(picture.view(), truth, Polarity::kDarkInside, 9.0, 20.0);
  ASSERT_TRUE(refined);
  EXPECT_LT((refined->ellipse.center() - truth.center()).norm(), 0.1);
}

TEST(PhotometricRefinement, FailsWithoutAMatchingEdge) {
  const Ellipse truth{130.3, 129.6, 60.0, 40.0, 0.4};
  const GrayPicture picture = rendered(disc(0.7, 2.0), truth, 260, 260);
  const auto refined =
      [&](const ImageView& luma, Polarity polarity, double inside, double min_contrast) {
        return refined_photometrically(luma, truth, polarity, inside, min_contrast).has_value();
      };
  EXPECT_TRUE(refined(picture.view(), Polarity::kDarkInside, 9.0, 20.0));
  EXPECT_FALSE(refined(picture.view(), Polarity::kBrightInside, 9.0, 20.0));
  EXPECT_FALSE(refined(picture.view(), Polarity::kDarkInside, 9.0, 200.0));
  EXPECT_FALSE(refined(picture.view(), Polarity::kDarkInside, 2.0, 20.0)) << "no room";
  EXPECT_FALSE(refined(picture.view(), Polarity::kDarkInside, std::nan(""), 20.0));
  EXPECT_FALSE(refined(GrayPicture(260, 260, 90).view(), Polarity::kDarkInside, 9.0, 20.0));
  EXPECT_FALSE(refined(GrayPicture(1, 1, 90).view(), Polarity::kDarkInside, 9.0, 20.0));
  EXPECT_FALSE(refined(ImageView{}, Polarity::kDarkInside, 9.0, 20.0));
}

TEST(PhotometricRefinement, AcceptsEllipsesOfAnySize) {
  const GrayPicture picture = rendered(disc(0.7, 2.0), {130.3, 129.6, 60.0, 40.0, 0.4}, 260, 260);
  for (const Ellipse& e : {Ellipse{130.0, 130.0, 0.01, 0.001, 0.0},
                           Ellipse{130.0, 130.0, 5000.0, 0.01, 1.0},
                           Ellipse{130.0, 130.0, 1e6, 1e6, 0.0},
                           Ellipse{-1e12, 1e12, 100.0, 50.0, 0.0},
                           Ellipse{0.0, 0.0, 1e13, 1e12, 0.3}}) {
    EXPECT_FALSE(refined_photometrically(picture.view(), e, Polarity::kDarkInside, 9.0, 20.0))
        << e.semi_major;
  }
}

}  // namespace
}  // namespace ellipse
