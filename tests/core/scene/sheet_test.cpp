// SPDX-License-Identifier: MIT
#include "core/scene/sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/catalog.hpp"
#include "core/scene/true_ellipses.hpp"
#include "core/scene/wild_shapes.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

// A disc on the ground seen from straight above, 100 px in radius in a picture of 320 x 240.
Scene disc_scene() {
  Scene scene = support::plain_ring();
  scene.pad.pattern = Pattern::kNone;
  scene.sensor.read_noise = 0.0;
  scene.flight.path = Path::kAside;
  scene.flight.reach = 0.0;
  scene.flight.highest = scene.flight.lowest = 160.0 / std::tan(0.5 * scene.hfov_rad) / 100.0;
  Shape& disc = scene.sheets.emplace_back().shapes.emplace_back();
  disc.paint.level = 55.0;
  disc.is_listed = disc.is_target = true;
  return scene;
}

GrayPicture render(const Scene& scene, double time_s = 0.0) {
  GrayPicture picture(320, 240);
  SceneRenderer(scene).render(time_s, 0, picture.writable());
  return picture;
}

TEST(Deformation, DeformedAtInvertsPatternAt) {
  const Deformation deformation(
      {{{2.0, 1.0}, 0.3, {0.05, 0.1}, 0.0}, {{-1.0, 3.0}, 1.0, {0.04, -0.06}, 0.0}});
  for (double angle = 0.0; angle < 6.0; angle += 0.5) {
    const Eigen::Vector2d point(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d deformed = deformation.deformed_at(point);
    EXPECT_LE((deformation.pattern_at(deformed) - point).norm(), 1e-10);
    EXPECT_GT((deformed - point).norm(), 1e-4);
    const Eigen::Vector2d step(1e-5, -2e-5);
    const Eigen::Vector2d moved =
        deformation.pattern_at(deformed + step) - deformation.pattern_at(deformed);
    EXPECT_LE((moved - deformation.slope_at(deformed) * step).norm(), 1e-8);
  }
}

TEST(Sheet, DiscOnTheGroundEqualsThePadsDisc) {
  Scene with_pad = disc_scene();
  with_pad.sheets.clear();
  with_pad.pad.pattern = Pattern::kDisc;
  EXPECT_EQ(render(disc_scene()).pixels, render(with_pad).pixels);
}

TEST(Sheet, OutlineOfABallIsItsTangentCone) {
  const Camera camera = Camera::with_hfov(1.0, 640, 480);
  const Eigen::Vector3d middle(1.5, -0.8, 5.0);
  const auto outline = project_ball(camera, middle, 1.0);
  ASSERT_TRUE(outline);
  for (double t = 0.0; t < 6.28; t += 0.4) {
    const Eigen::Vector3d ray = camera.matrix().inverse() * outline->point_at(t).homogeneous();
    EXPECT_NEAR(middle.cross(ray.normalized()).norm(), 1.0, 1e-9);
  }
  EXPECT_FALSE(project_ball(camera, {0.0, 0.0, 0.5}, 1.0));
  EXPECT_FALSE(project_ball(camera, {0.0, 0.0, -5.0}, 1.0));
}

TEST(Sheet, AnUprightSheetStandsOnTheGround) {
  Scene scene = disc_scene();
  scene.flight.tilt_rad = 1.2;
  scene.flight.azimuth_rad = -0.5 * std::numbers::pi;
  scene.sheets[0].frame = wild::upright_frame({0.0, 0.0, 0.5}, 0.5, scene.flight.azimuth_rad);
  const auto found = true_ellipses(scene, 0.0, 320, 240);
  ASSERT_EQ(found.size(), 1U);
  const Ellipse& e = found[0].ellipse;
  // Its foot is at the origin, which is the centre of the view.
  EXPECT_NEAR(e.cx, 159.5, 0.5);
  EXPECT_NEAR(e.cy + half_extent(e).y(), 119.5, 1.0);
  // From 1.2 rad off the vertical, its image is nearly as high as wide, and above the origin.
  EXPECT_NEAR(half_extent(e).y() / half_extent(e).x(), 1.0, 0.1);
  EXPECT_LT(e.cy, 100.0);
}

TEST(TrueEllipses, HiddenPartsAreNotVisible) {
  Scene scene = disc_scene();
  EXPECT_NEAR(true_ellipses(scene, 0.0, 320, 240)[0].visible_fraction, 1.0, 1e-9);
  Paint paint;
  scene.sheets.emplace_back().shapes = {wild::box({2.0, 0.0}, {2.0, 5.0}, 0.0, paint)};
  EXPECT_NEAR(true_ellipses(scene, 0.0, 320, 240)[0].visible_fraction, 0.5, 0.01);
  scene.sheets.back().shapes[0].paint.opacity = 0.3;
  EXPECT_NEAR(true_ellipses(scene, 0.0, 320, 240)[0].visible_fraction, 1.0, 1e-9);
  scene.sheets.back().shapes = {wild::box({0.0, 0.0}, {5.0, 5.0}, 0.0, paint)};
  EXPECT_TRUE(true_ellipses(scene, 0.0, 320, 240).empty());
}

TEST(TrueEllipses, IncludeAllEdgesOfThePad) {
  const Scene scene = scene_by_name("bullseye");
  const auto found = true_ellipses(scene, 8.0, 640, 360);
  ASSERT_EQ(found.size(), 5U);
  const Truth truth = truth_of(scene.pad, image_from_pad(scene, 8.0, 640, 360), 640, 360);
  EXPECT_TRUE(found[0].is_target);
  EXPECT_FALSE(found[1].is_target);
  EXPECT_LE(max_difference_px(found[0].ellipse, *truth.outer_edge), 1e-9);
  EXPECT_LE(max_difference_px(found[1].ellipse, *truth.inner_edge), 1e-9);
  EXPECT_NEAR(found[0].visible_fraction, truth.visible_fraction, 0.02);
}

TEST(Shape, MeshDarkensByTheShareOfItsWires) {
  Scene scene = disc_scene();
  Paint black;
  black.level = 0.0;
  // Wires of a tenth of their spacing of 20 px, in both directions: 19 % of the light is missing.
  scene.sheets[0].anchor = Anchor::kPicture;
  scene.sheets[0].shapes = {wild::mesh(20.0 / 320.0, 2.0 / 320.0, 0.0, black)};
  for (const double blur_px : {0.6, 12.0}) {
    scene.sensor.blur_px = blur_px;
    const GrayPicture picture = render(scene);
    double sum = 0.0;
    for (int y = 20; y < 220; ++y) {
      for (int x = 20; x < 300; ++x) sum += picture.view().row(y)[x];
    }
    EXPECT_NEAR(sum / (200.0 * 280.0), 200.0 * 0.81, 1.0) << blur_px;
  }
}

TEST(Sensor, GammaMapsTheGreysBetweenBlackAndWhite) {
  Scene scene = disc_scene();
  scene.ground.level = 255.0;
  scene.sheets[0].shapes[0].paint.level = 64.0;
  scene.sensor.gamma = 0.5;
  GrayPicture picture = render(scene);
  EXPECT_EQ(picture.at(2, 2), 255);
  EXPECT_NEAR(picture.at(160, 120), 255.0 * std::sqrt(64.0 / 255.0), 1.0);
}

TEST(Renderer, VignetteDarkensTheCorners) {
  Scene scene = disc_scene();
  scene.sheets.clear();
  scene.light.vignette = 0.4;
  GrayPicture picture = render(scene);
  EXPECT_EQ(picture.at(160, 120), 200);
  EXPECT_EQ(picture.at(0, 0), 120);
  EXPECT_EQ(picture.at(319, 239), 120);
}

TEST(Renderer, FieldsShowTheRowsOfTheirTimes) {
  Scene scene = disc_scene();
  scene.sheets[0].swing.reach = {1.0, 0.0, 0.0};
  GrayPicture even = render(scene, 0.48);
  GrayPicture odd = render(scene, 0.52);
  ASSERT_NE(even.pixels, odd.pixels);
  scene.sensor.field_s = 0.04;
  GrayPicture both = render(scene, 0.5);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) ASSERT_EQ(both.at(x, y), (y % 2 == 0 ? even : odd).at(x, y));
  }
}

TEST(Renderer, RollingShutterSkewsMovingObjects) {
  Scene scene = disc_scene();
  // 100 px a second to the right at time 0, read within .48 s: .2 px a row.
  scene.sheets[0].swing = {{1.0, 0.0, 0.0}, 2.0 * std::numbers::pi, 0.0, 1};
  scene.sheets[0].shapes = {wild::box({0.0, 0.0}, {0.2, 5.0}, 0.0, Paint{55.0})};
  scene.sensor.readout_s = 0.48 * 239.0 / 240.0;
  GrayPicture picture = render(scene);
  const auto left_edge = [&](int y) {
    double x = 0.0;
    while (picture.at(static_cast<int>(x), y) > 127) ++x;
    return x;
  };
  EXPECT_NEAR(left_edge(150) - left_edge(90), 60 * 0.2, 1.1);
}

}  // namespace
}  // namespace ellipse
