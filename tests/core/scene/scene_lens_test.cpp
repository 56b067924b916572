// SPDX-License-Identifier: MIT
//
// Scenes with lens distortion.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/camera/lens_view.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/lens_map.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using Eigen::Vector2d;
using support::GrayPicture;
using support::kHeight;
using support::kWidth;

class SceneLens : public testing::TestWithParam<const char*> {
 protected:
  static Scene through_lens(Scene scene) {
    put_on_lens(scene, GetParam());
    return scene;
  }

  static Scene plain_disc() {
    Scene scene = support::plain_ring();
    scene.pad.pattern = Pattern::kDisc;
    scene.sensor.read_noise = 0.0;
    return through_lens(scene);
  }

  static Camera camera() { return camera_of(through_lens({}), kWidth, kHeight); }
};

TEST_P(SceneLens, FieldOfViewSpansThePicture) {
  const Lens lens(camera());
  for (const double x : {-0.5, kWidth - 0.5}) {
    const auto ideal = lens.ideal_from_picture({x, 0.5 * (kHeight - 1)});
    ASSERT_TRUE(ideal);
    const double off_axis = (ideal->x() - lens.camera().cx) / lens.camera().fx;
    EXPECT_NEAR(std::abs(std::atan(off_axis)), 0.5 * through_lens({}).hfov_rad, 1e-9);
  }
}

// The maximum error in the picture of the block homographies against the lens.
TEST_P(SceneLens, BlockHomographiesApproximateTheLens) {
  const LensMap map(camera());
  double farthest_px = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vector2d pixel(x, y);
      const Vector2d ideal =
          (map.ideal_from_picture(x / LensMap::kBlock, y / LensMap::kBlock) * pixel.homogeneous())
              .hnormalized();
      const auto shown = map.lens().picture_from_ideal(ideal);
      ASSERT_TRUE(shown) << x << ' ' << y;
      farthest_px = std::max(farthest_px, (shown->picture_px - pixel).norm());
    }
  }
  EXPECT_LT(farthest_px, 0.01);
  RecordProperty("farthest_px", std::to_string(farthest_px));
}

// The distance from a blurred edge at which it has a given share of its light, in standard
// deviations: the inverse of the normal distribution, by bisection.
double sigmas_of(double share) {
  double low = -4.0;
  double high = 4.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Signed distance in the picture from the outline of an ellipse of the ideal plane.
double distance_px(const Lens& lens, const Ellipse& e, const Vector2d& pixel) {
  const Vector2d ideal = lens.ideal_from_picture(pixel).value();
  const Eigen::Matrix2d slope = lens.picture_from_ideal(ideal)->slope;
  const double distance = sampson_distance(e, ideal);
  constexpr double kStep = 1e-3;
  const Vector2d gradient((sampson_distance(e, ideal + Vector2d(kStep, 0.0)) - distance) / kStep,
                          (sampson_distance(e, ideal + Vector2d(0.0, kStep)) - distance) / kStep);
  return distance / (slope.inverse().transpose() * gradient).norm();
}

struct EdgeErrors {
  std::vector<double> all;
  std::vector<double> at_corners;  // beyond two thirds of the picture's half diagonal
};

// The error of the edge's position, from the grey level of each edge pixel.
EdgeErrors edge_errors(const Scene& scene, const GrayPicture& picture, const Ellipse& truth) {
  const Lens lens(camera_of(scene, picture.width, picture.height));
  const Vector2d middle(0.5 * (picture.width - 1), 0.5 * (picture.height - 1));
  EdgeErrors errors;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double share = (scene.ground.level - picture.view().row(y)[x]) /
                           (scene.ground.level - scene.pad.paint_level);
      if (!(share > 0.2 && share < 0.8)) continue;
      const Vector2d pixel(x, y);
      const double measured_px = scene.sensor.blur_px * sigmas_of(share);
      const double error_px = std::abs(measured_px - distance_px(lens, truth, pixel));
      errors.all.push_back(error_px);
      if ((pixel - middle).norm() > 2.0 / 3.0 * middle.norm()) {
        errors.at_corners.push_back(error_px);
      }
    }
  }
  return errors;
}

double quantile(std::vector<double> values, double q) {
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

// Discs with outlines through the picture's middle, sides and corners.
TEST_P(SceneLens, TruthMatchesThePixels) {
  const Scene scene = plain_disc();
  const Lens lens(camera());
  SceneRenderer renderer(scene);
  EdgeErrors errors;
  for (const Vector2d& centre_px : {Vector2d(320, 180),
                                    Vector2d(90, 70),
                                    Vector2d(560, 80),
                                    Vector2d(580, 300),
                                    Vector2d(60, 310),
                                    Vector2d(320, 20)}) {
    const Vector2d ideal = lens.ideal_from_picture(centre_px).value();
    const Ellipse disc{ideal.x(), ideal.y(), 110.0, 85.0, 0.3};
    GrayPicture picture(kWidth, kHeight);
    const Truth truth = renderer.render(image_from_pad(disc), 0, picture.writable());
    ASSERT_LT(max_difference_px(*truth.outer_edge, disc), 1e-9);
    const EdgeErrors found = edge_errors(scene, picture, disc);
    errors.all.insert(errors.all.end(), found.all.begin(), found.all.end());
    errors.at_corners.insert(
        errors.at_corners.end(), found.at_corners.begin(), found.at_corners.end());
  }
  ASSERT_GT(errors.all.size(), 1500U);
  ASSERT_GT(errors.at_corners.size(), 400U);
  EXPECT_LT(quantile(errors.all, 0.5), 0.01);
  EXPECT_LT(quantile(errors.all, 0.99), 0.02);
  EXPECT_LT(quantile(errors.at_corners, 0.5), 0.01);
  RecordProperty("median_px", std::to_string(quantile(errors.all, 0.5)));
  RecordProperty("p99_px", std::to_string(quantile(errors.all, 0.99)));
  RecordProperty("corner_median_px", std::to_string(quantile(errors.at_corners, 0.5)));
}

// The same in the perspective of a flight.
TEST_P(SceneLens, TruthOfAFlightMatchesThePixels) {
  Scene scene = plain_disc();
  scene.flight.highest = 6.0;
  SceneRenderer renderer(scene);
  std::vector<double> errors;
  for (const double time_s : {2.0, 5.0, 8.0, 10.0}) {
    GrayPicture picture(kWidth, kHeight);
    const Truth truth = renderer.render(time_s, 0, picture.writable());
    const EdgeErrors found = edge_errors(scene, picture, *truth.outer_edge);
    errors.insert(errors.end(), found.all.begin(), found.all.end());
  }
  ASSERT_GT(errors.size(), 500U);
  EXPECT_LT(quantile(errors, 0.5), 0.01);
  EXPECT_LT(quantile(errors, 0.99), 0.02);
}

TEST_P(SceneLens, VisibleFractionIsOfTheDistortedOutline) {
  const Scene scene = plain_disc();
  const Lens lens(camera());
  for (const double x : {-40.0, 60.0, 200.0, 320.0}) {
    const Vector2d ideal = lens.ideal_from_picture({x, 100.0}).value();
    const Ellipse disc{ideal.x(), ideal.y(), 150.0, 110.0, 0.4};
    std::vector<Vector2d> outline(40000);
    distorted_outline(lens, disc, outline);
    double inside = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d& p = outline[i];
      const double length = (outline[(i + 1) % outline.size()] - p).norm();
      total += length;
      if (p.x() > -0.5 && p.x() < kWidth - 0.5 && p.y() > -0.5 && p.y() < kHeight - 0.5) {
        inside += length;
      }
    }
    const Truth truth = truth_of(scene.pad, image_from_pad(disc), camera());
    EXPECT_NEAR(truth.visible_fraction, inside / total, 0.003) << x;
  }
}

TEST_P(SceneLens, SameSceneGivesTheSamePictures) {
  const Scene scene = through_lens(scene_by_name("shake", 3));
  SceneRenderer renderer(scene);
  GrayPicture first(160, 90);
  GrayPicture other(100, 70);
  GrayPicture again(160, 90);
  renderer.render(1.0, 4, first.writable());
  renderer.render(1.0, 4, other.writable());
  renderer.render(1.0, 4, again.writable());
  EXPECT_EQ(first.pixels, again.pixels);
  SceneRenderer(scene).render(1.0, 4, again.writable());
  EXPECT_EQ(first.pixels, again.pixels);
}

INSTANTIATE_TEST_SUITE_P(Lenses,
                         SceneLens,
                         testing::Values("barrel", "fisheye"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(LensOfAScene, EqualsAPinholeWithoutDistortion) {
  Scene scene = scene_by_name("glare");
  GrayPicture pinhole(161, 91);
  SceneRenderer(scene).render(4.0, 2, pinhole.writable());
  scene.lens = Distortion{};
  GrayPicture lens(161, 91);
  SceneRenderer(scene).render(4.0, 2, lens.writable());
  EXPECT_EQ(lens.pixels, pinhole.pixels);
}

// All scene content, drawn block by block: textures, shadows, glare, bars, motion blur. Only the
// mipmap level of the ground near the horizon, which is constant within a block, may differ.
TEST(LensOfAScene, EqualsAPinholeWithLittleDistortion) {
  for (const NamedScene& named : scene_catalog()) {
    Scene scene = named.make(1);
    GrayPicture pinhole(322, 182);
    const Truth expected = SceneRenderer(scene).render(4.0, 2, pinhole.writable());
    scene.lens = Distortion{LensModel::kBrownConrady, {1e-9}};
    GrayPicture lens(322, 182);
    const Truth truth = SceneRenderer(scene).render(4.0, 2, lens.writable());
    int different = 0;
    for (std::size_t i = 0; i < lens.pixels.size(); ++i) {
      different += std::abs(lens.pixels[i] - pinhole.pixels[i]) > 2 ? 1 : 0;
    }
    EXPECT_LT(different, 322 * 182 / 200) << named.name;
    EXPECT_NEAR(truth.visible_fraction, expected.visible_fraction, 0.005) << named.name;
  }
}

TEST(LensOfAScene, IsBlackOutsideItsFieldOfView) {
  Scene scene = scene_by_name("hover");
  scene.lens = Distortion{LensModel::kFisheye, {}};
  scene.hfov_rad = 170.0 * std::numbers::pi / 180.0;
  scene.sensor.read_noise = 0.0;
  GrayPicture picture(101, 101);
  SceneRenderer(scene).render(0.0, 0, picture.writable());
  EXPECT_EQ(picture.at(0, 0), 0);
  EXPECT_EQ(picture.at(100, 100), 0);
  EXPECT_GT(picture.at(50, 50), 0);
  EXPECT_GT(picture.at(2, 50), 0);
}

TEST(LensOfAScene, IsFoundByName) {
  for (const NamedLens& lens : lens_catalog()) {
    Scene scene;
    put_on_lens(scene, lens.name);
    EXPECT_TRUE(camera_of(scene, 640, 360).is_distorted()) << lens.name;
  }
  Scene scene;
  try {
    put_on_lens(scene, "moon");
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("fisheye"), std::string::npos);
  }
}

TEST(LensOfAScene, RejectsAFieldOfViewBeyondItsRange) {
  Scene scene;
  scene.lens = Distortion{LensModel::kBrownConrady, {-0.22}};
  scene.hfov_rad = 110.0 * std::numbers::pi / 180.0;  // beyond the turning point of its polynomial
  EXPECT_THROW((void)camera_of(scene, 640, 360), std::invalid_argument);
  EXPECT_THROW(SceneRenderer{scene}, std::invalid_argument);
}

TEST(LensOfAScene, OutlinesBeyondItsRangeAreNotVisible) {
  Scene scene;
  scene.lens = Distortion{LensModel::kBrownConrady, {-0.22}};
  const Camera camera = camera_of(scene, 640, 360);
  // Two thirds of this circle are beyond the lens's range.
  const Ellipse circle{320.0 + 1000.0, 180.0, 900.0, 900.0, 0.0};
  const Truth truth = truth_of(scene.pad, image_from_pad(circle), camera);
  EXPECT_GT(truth.visible_fraction, 0.05);
  EXPECT_LT(truth.visible_fraction, 0.5);
}

}  // namespace
}  // namespace ellipse
