// SPDX-License-Identifier: MIT
//
// Checks the truth against the picture: a photometric fit that is independent of the renderer finds
// the true ellipses.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/random.hpp"
#include "tests/support/photometric_fit.hpp"

namespace ellipse {
namespace {

using support::Edges;
using support::ellipse_of;
using support::expect_same;
using support::GrayPicture;
using support::PhotometricFit;

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
    GrayPicture picture(kWidth, kHeight);
    const Truth truth = SceneRenderer(scene).render(view(), 0, picture.writable());
    const Edges edges = PhotometricFit(scene, picture, truth).run();
    expect_same(ellipse_of(edges.outer), *truth.outer_edge);
    if (truth.inner_edge) expect_same(ellipse_of(edges.inner), *truth.inner_edge);
  }
};

TEST_P(SceneTruth, OfADiscMatchesItsPixels) {
  check(Pattern::kDisc);
}

TEST_P(SceneTruth, OfARingMatchesItsPixels) {
  check(Pattern::kRing);
}

INSTANTIATE_TEST_SUITE_P(Views, SceneTruth, testing::Range(0, 20));

}  // namespace
}  // namespace ellipse
