// SPDX-License-Identifier: MIT
#include "core/scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene/catalog.hpp"
#include "core/scene/polygon.hpp"
#include "core/scene/random.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

Scene clean_disc() {
  Scene scene = support::plain_ring();
  scene.pad.pattern = Pattern::kDisc;
  scene.sensor.read_noise = 0.0;
  return scene;
}

// Paint's share of each pixel.
double share(const Scene& scene, std::uint8_t level) {
  return (scene.ground.level - level) / (scene.ground.level - scene.pad.paint_level);
}

TEST(Scene, DarkAreaEqualsTheEllipseArea) {
  const Scene scene = clean_disc();
  const Ellipse truth{80.3, 70.6, 50.0, 25.0, 0.7};
  const GrayPicture picture = support::rendered(scene, truth, 160, 140);
  double area = 0.0;
  for (const std::uint8_t level : picture.pixels) area += share(scene, level);
  EXPECT_NEAR(area / (std::numbers::pi * 50.0 * 25.0), 1.0, 2e-3);
}

TEST(Scene, CentroidOfTheDarkAreaIsTheTrueCentre) {
  const Scene scene = clean_disc();
  const Ellipse truth{80.3, 70.6, 40.0, 30.0, -0.4};
  const GrayPicture picture = support::rendered(scene, truth, 160, 140);
  Eigen::Vector2d sum(0.0, 0.0);
  double weight = 0.0;
  for (int y = 0; y < 140; ++y) {
    for (int x = 0; x < 160; ++x) {
      const double paint = share(scene, picture.view().row(y)[x]);
      sum += paint * Eigen::Vector2d(x, y);
      weight += paint;
    }
  }
  EXPECT_NEAR(sum.x() / weight, truth.cx, 0.01);
  EXPECT_NEAR(sum.y() / weight, truth.cy, 0.01);
}

TEST(Scene, ProjectedCircleLiesOnProjectedPoints) {
  const Eigen::Matrix3d view = image_from_pad(scene_by_name("approach"), 3.0, 640, 360);
  const auto e = project_circle(view, 1.0);
  ASSERT_TRUE(e);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d p = view * Eigen::Vector3d(std::cos(0.5 * i), std::sin(0.5 * i), 1.0);
    EXPECT_NEAR(sampson_distance(*e, p.head<2>() / p.z()), 0.0, 1e-9);
  }
}

TEST(Scene, CirclesReachingBehindTheCameraGiveNoEllipse) {
  CameraPose pose;
  pose.position = {0.0, -0.5, 0.1};
  pose.looks_at = {0.0, 1.0, 0.1};
  const Eigen::Matrix3d view = image_from_pad(pose, 1.0, 640, 360);
  EXPECT_FALSE(project_circle(view, 1.0));
  EXPECT_FALSE(truth_of(Pad(), view, 640, 360).outer_edge);
}

TEST(Scene, TruthHasTheEdgesOfThePattern) {
  const Eigen::Matrix3d view = image_from_pad(Ellipse{60.0, 50.0, 40.0, 30.0, 0.0});
  Pad pad;
  EXPECT_NEAR(truth_of(pad, view, 200, 100).inner_edge->semi_major, 40.0 * (1.0 - 0.205), 1e-9);
  pad.pattern = Pattern::kDisc;
  EXPECT_FALSE(truth_of(pad, view, 200, 100).inner_edge);
  EXPECT_EQ(truth_of(pad, view, 200, 100).visible_fraction, 1.0);
  EXPECT_NEAR(truth_of(pad, view, 61, 100).visible_fraction, 0.5, 0.02);
  pad.pattern = Pattern::kNone;
  EXPECT_FALSE(truth_of(pad, view, 200, 100).outer_edge);
}

TEST(Scene, SeedAndFrameDecideTheNoise) {
  const Ellipse e{40.0, 40.0, 20.0, 20.0, 0.0};
  Scene scene;
  const GrayPicture a = support::rendered(scene, e, 80, 80, 3);
  EXPECT_EQ(a.pixels, support::rendered(scene, e, 80, 80, 3).pixels);
  EXPECT_NE(a.pixels, support::rendered(scene, e, 80, 80, 4).pixels);
  scene.seed = 2;
  EXPECT_NE(a.pixels, support::rendered(scene, e, 80, 80, 3).pixels);
}

// The standard deviation of a uniform grey after the sensor.
double measured_noise(const Sensor& sensor, double light) {
  Scene scene = support::plain_ring();
  scene.ground.level = light;
  scene.sensor = sensor;
  const GrayPicture picture = support::rendered(scene, {-500.0, 0.0, 10.0, 10.0, 0.0}, 200, 200);
  double sum = 0.0;
  double squares = 0.0;
  for (const std::uint8_t level : picture.pixels) {
    sum += level;
    squares += level * level;
  }
  const double mean = sum / 40000.0;
  return std::sqrt(squares / 40000.0 - mean * mean);
}

TEST(Sensor, NoiseHasItsStandardDeviation) {
  Sensor sensor;
  sensor.read_noise = 5.0;
  EXPECT_NEAR(measured_noise(sensor, 128.0), 5.0, 0.1);
}

TEST(Sensor, ShotNoiseGrowsWithTheLight) {
  Sensor sensor;
  sensor.read_noise = 0.0;
  sensor.shot_noise = 0.25;
  EXPECT_NEAR(measured_noise(sensor, 64.0), 4.0, 0.1);
  EXPECT_NEAR(measured_noise(sensor, 196.0), 7.0, 0.15);
}

TEST(Sensor, GainAndBiasScaleAndShift) {
  Scene scene = clean_disc();
  scene.sensor.gain = 0.5;
  scene.sensor.bias = 10.0;
  GrayPicture picture = support::rendered(scene, {50.0, 50.0, 20.0, 20.0, 0.0}, 100, 100);
  EXPECT_EQ(picture.at(2, 2), 110);   // 200 / 2 + 10
  EXPECT_EQ(picture.at(50, 50), 38);  // 55 / 2 + 10, rounded
}

TEST(Sensor, JpegEqualsThatOfLibjpeg) {
  Scene scene;
  scene.sensor.read_noise = 10.0;
  GrayPicture picture = support::rendered(scene, {60.0, 50.0, 40.0, 30.0, 0.3}, 123, 101);
  for (const int quality : {20, 45, 95}) {
    const cv::Mat original(101, 123, CV_8U, picture.pixels.data());
    std::vector<std::uint8_t> file;
    cv::imencode(".jpg", original, file, {cv::IMWRITE_JPEG_QUALITY, quality});
    const cv::Mat expected = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
    GrayPicture compressed = picture;
    compress_jpeg(compressed.writable(), quality);
    const cv::Mat ours(101, 123, CV_8U, compressed.pixels.data());
    EXPECT_GT(cv::norm(ours, original, cv::NORM_INF), 3.0) << quality;
    EXPECT_LE(cv::norm(ours, expected, cv::NORM_L1) / (101.0 * 123.0), 0.5) << quality;
    EXPECT_LE(cv::norm(ours, expected, cv::NORM_INF), 20.0) << quality;
  }
}

// The grey levels across the middle of a disc that moves along the picture's rows.
std::vector<double> moving_profile(double exposure_s) {
  Scene scene = clean_disc();
  scene.flight = {Path::kDash, 1.0, 8.0, 8.0};
  scene.sensor.exposure_s = exposure_s;
  scene.sensor.read_noise = 0.0;
  GrayPicture picture(640, 360);
  const Truth truth = SceneRenderer(scene).render(0.0, 0, picture.writable());
  const auto* row = picture.view().row(static_cast<int>(std::lround(truth.outer_edge->cy)));
  return {row + static_cast<int>(truth.outer_edge->cx), row + 640};
}

TEST(Renderer, MotionBlurIsAnEvenRampWithoutGhosts) {
  // 1200 px/s in 1/60 s: the edge becomes a ramp of 20 px.
  const std::vector<double> profile = moving_profile(1.0 / 60.0);
  int ramp = 0;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const double step = profile[i] - profile[i - 1];
    EXPECT_GE(step, 0.0) << i;
    EXPECT_LE(step, 145.0 / 20.0 + 1.5) << i;
    ramp += step > 4.0 ? 1 : 0;
  }
  EXPECT_NEAR(ramp, 20, 2);
}

TEST(Renderer, ZeroExposureIsSharp) {
  const std::vector<double> profile = moving_profile(0.0);
  int ramp = 0;
  for (std::size_t i = 1; i < profile.size(); ++i) ramp += profile[i] - profile[i - 1] > 4.0;
  EXPECT_LE(ramp, 4);
}

TEST(Renderer, ShadowReducesTheLightByItsShare) {
  Scene scene = clean_disc();
  scene.light.shadows = {{0.0, 10.0, 5.0, 0.4, 0.0}};  // x from 5 to 15 radii
  GrayPicture picture = support::rendered(scene, {20.0, 20.0, 4.0, 4.0, 0.0}, 100, 40);
  EXPECT_EQ(picture.at(30, 20), 200);
  EXPECT_EQ(picture.at(50, 20), 120);
  EXPECT_EQ(picture.at(90, 20), 200);
}

TEST(Renderer, GlareSaturatesAndFadesAway) {
  Scene scene = clean_disc();
  scene.flight = {Path::kHover, 10.0, 8.0, 8.0};
  scene.light.glare = {{0.0, 0.0}, 0.05, 300.0};
  GrayPicture picture(640, 360);
  SceneRenderer(scene).render(0.0, 0, picture.writable());
  EXPECT_GT(std::count(picture.pixels.begin(), picture.pixels.end(), 255), 500);
  EXPECT_EQ(picture.at(2, 2), 200);
}

// Compares the ground beneath a moved pad with the same ground under a moved camera.
TEST(Renderer, MovedPadLiesOnOtherGround) {
  Scene scene = scene_by_name("approach");
  scene.pad.pattern = Pattern::kNone;
  scene.sensor.read_noise = 0.0;
  const CameraPose pose{{0.0, 0.0, 8.0}, {0.0, 0.0, 0.0}, 0.0};
  View over_pad{.image_from_pad = image_from_pad(pose, 1.0, 160, 120)};
  GrayPicture still(160, 120);
  GrayPicture moved(160, 120);
  GrayPicture elsewhere(160, 120);
  SceneRenderer renderer(scene);
  renderer.render(over_pad, 0, still.writable());
  over_pad.ground_from_pad = Eigen::Translation2d(1.5, -0.5) * Eigen::Rotation2Dd(0.0);
  renderer.render(over_pad, 0, moved.writable());
  const CameraPose there{{1.5, -0.5, 8.0}, {1.5, -0.5, 0.0}, 0.0};
  renderer.render(image_from_pad(there, 1.0, 160, 120), 0, elsewhere.writable());
  EXPECT_NE(moved.pixels, still.pixels);
  for (std::size_t i = 0; i < moved.pixels.size(); ++i) {
    ASSERT_NEAR(moved.pixels[i], elsewhere.pixels[i], 1) << i;
  }
}

TEST(Renderer, GlareRequiresTheCameraPosition) {
  Scene scene = clean_disc();
  scene.light.glare = {{0.0, 0.0}, 0.05, 300.0};
  const CameraPose pose{{0.0, 0.0, 8.0}, {0.0, 0.0, 0.0}, 0.0};
  View view{.image_from_pad = image_from_pad(pose, 1.0, 160, 120)};
  GrayPicture picture(160, 120);
  SceneRenderer renderer(scene);
  renderer.render(view, 0, picture.writable());
  EXPECT_EQ(std::count(picture.pixels.begin(), picture.pixels.end(), 255), 0);
  view.camera = pose.position;
  renderer.render(view, 0, picture.writable());
  EXPECT_GT(std::count(picture.pixels.begin(), picture.pixels.end(), 255), 30);
}

TEST(Renderer, GradientBrightensOneSide) {
  Scene scene = clean_disc();
  scene.light.gradient = {0.4, 0.0};
  GrayPicture picture = support::rendered(scene, {50.0, 50.0, 10.0, 10.0, 0.0}, 101, 101);
  EXPECT_NEAR(picture.at(0, 5), 200.0 * 0.8, 1.0);
  EXPECT_NEAR(picture.at(100, 95), 200.0 * 1.2, 1.0);
}

TEST(Renderer, CrumpledEdgeDeviatesByItsAmplitude) {
  Scene scene = clean_disc();
  scene.pad.deformation = 0.03;
  const double radius = 200.0;
  GrayPicture picture = support::rendered(scene, {256.0, 256.0, radius, radius, 0.0}, 513, 513);
  double largest = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * std::numbers::pi / 180.0;
    double r = radius * 0.9;
    const auto level = [&] {
      return picture.at(static_cast<int>(std::lround(256.0 + r * std::cos(angle))),
                        static_cast<int>(std::lround(256.0 + r * std::sin(angle))));
    };
    while (level() < 127) r += 0.25;
    largest = std::max(largest, std::abs(r / radius - 1.0));
    sum += r / radius - 1.0;
  }
  EXPECT_NEAR(largest, 0.03, 0.004);
  EXPECT_NEAR(sum / 360.0, 0.0, 0.002);
}

TEST(Renderer, HonoursStridesAndAnySize) {
  SceneRenderer renderer(scene_by_name("glare"));
  for (const int width : {1, 7, 33}) {
    for (const int height : {1, 9}) {
      const int stride = width + 5;
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(stride * height), 99);
      renderer.render(4.0, 0, {pixels.data(), width, height, stride});
      for (int y = 0; y < height; ++y) {
        for (int x = width; x < stride; ++x) {
          EXPECT_EQ(pixels[static_cast<std::size_t>(y * stride + x)], 99);
        }
      }
    }
  }
}

TEST(Renderer, RendersAHorizon) {
  Scene scene = scene_by_name("oblique");
  CameraPose pose;
  pose.position = {0.0, -6.0, 0.5};
  pose.looks_at = {0.0, 0.0, 0.4};
  GrayPicture picture(320, 240);
  const Truth truth =
      SceneRenderer(scene).render(image_from_pad(pose, 1.0, 320, 240), 0, picture.writable());
  EXPECT_TRUE(truth.outer_edge);
  EXPECT_NEAR(picture.at(160, 10), 200, 10);  // sky
}

TEST(GroundTexture, UsesTheGivenPicture) {
  Ground ground;
  ground.kind = GroundKind::kPicture;
  EXPECT_THROW(GroundTexture(ground, 1), std::invalid_argument);
  ground.picture = cv::Mat(64, 64, CV_8U, cv::Scalar(128));
  ground.picture.colRange(0, 32) = 28;
  const GroundTexture texture(ground, 1);
  EXPECT_NEAR(texture.at(2.0F, 3.0F, 0.5F), 20.0, 3.0);  // 100 below the mean of 120
  EXPECT_NEAR(texture.at(9.0F, 3.0F, 0.5F), 120.0, 3.0);
  EXPECT_NEAR(texture.at(21.0F, 3.0F, 0.5F), 120.0, 3.0);  // repeats
  EXPECT_NEAR(texture.at(21.0F, 3.0F, 99.0F), 70.0, 3.0);  // from far away
}

TEST(GroundTexture, KindsDiffer) {
  std::set<std::vector<float>> distinct;
  for (std::size_t kind = 0; kind < ground_nicks().size(); ++kind) {
    Ground ground;
    ground.kind = static_cast<GroundKind>(kind);
    const GroundTexture texture(ground, 1);
    std::vector<float> lights;
    for (int i = 0; i < 400 && !texture.is_plain(); ++i) {
      lights.push_back(texture.at(0.03F * static_cast<float>(i), 5.0F, -1.0F));
    }
    EXPECT_TRUE(distinct.insert(lights).second) << ground_nicks()[kind];
  }
}

// Which pixels of a tile of 64 x 64 an upright square covers, given by its first and last pixel.
cv::Rect covered_by_square(int first_px, int last_px) {
  cv::Mat tile(64, 64, CV_32F, cv::Scalar(0.0));
  const int low = first_px * kPolygonUnitsPerPx;
  const int high = last_px * kPolygonUnitsPerPx;
  const std::vector<cv::Point> corners{{low, low}, {high, low}, {high, high}, {low, high}};
  fill_polygon(tile, corners, 3.0F);
  std::vector<cv::Point> covered;
  for (int y = 0; y < tile.rows; ++y) {
    for (int x = 0; x < tile.cols; ++x) {
      if (tile.at<float>(y, x) == 3.0F) covered.emplace_back(x, y);
    }
  }
  const auto [leftmost, rightmost] = std::minmax_element(
      covered.begin(), covered.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const cv::Rect box(covered.front(), cv::Point(rightmost->x + 1, covered.back().y + 1));
  EXPECT_EQ(box.x, leftmost->x);
  EXPECT_EQ(box.area(), static_cast<int>(covered.size()));
  return box;
}

TEST(Polygon, FillsItsInsideAndBorderClippedToTheTile) {
  EXPECT_EQ(covered_by_square(10, 30), cv::Rect(10, 10, 21, 21));
  EXPECT_EQ(covered_by_square(-7, 5), cv::Rect(0, 0, 6, 6));
  EXPECT_EQ(covered_by_square(60, 90), cv::Rect(60, 60, 4, 4));
}

TEST(Polygon, IsHollowAtSelfIntersections) {
  cv::Mat tile(64, 64, CV_32F, cv::Scalar(0.0));
  std::vector<cv::Point> star;  // with five points, drawn in one go
  for (int i = 0; i < 5; ++i) {
    const double angle = 4.0 * std::numbers::pi * i / 5.0;
    star.emplace_back(static_cast<int>(kPolygonUnitsPerPx * (32.0 + 28.0 * std::sin(angle))),
                      static_cast<int>(kPolygonUnitsPerPx * (32.0 - 28.0 * std::cos(angle))));
  }
  fill_polygon(tile, star, 3.0F);
  EXPECT_EQ(tile.at<float>(32, 32), 0.0F);
  EXPECT_EQ(tile.at<float>(10, 32), 3.0F);
}

// FNV-1a.
std::uint64_t fingerprint(const GrayPicture& picture) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::uint8_t level : picture.pixels) hash = (hash ^ level) * 0x100000001b3U;
  return hash;
}

struct Fingerprint {
  const char* scene;
  std::uint64_t value;
};

// Equal on Debian 12 and 13, with OpenCV 4.6 and 4.10, for any instruction set that OpenCV and the
// C library select. Changing a scene changes every figure measured with it: note it in
// CHANGELOG.md.
constexpr Fingerprint kFingerprints[] = {
    {"approach", 0xf2d325fb58e82ca3U},
    {"oblique", 0xae3bf7adc26f972aU},
    {"dusk", 0xd81441abc3a435aaU},
    {"glare", 0xfc3966c6b014873fU},
    {"occluded", 0x160751ec4464e983U},
    {"dash", 0x22705a707d88d3d8U},
    {"touchdown", 0xb5de65e1b769413cU},
    {"reenter", 0xfbb0c0ee85b0b22cU},
    {"thin", 0x0a219675ae916b8bU},
    {"disc", 0x39306c0ad3981fa7U},
    {"bullseye", 0x74000117ecb3b4dcU},
    {"crumpled", 0x1bf6e0758422445dU},
    {"noise", 0x6a91361e1c5037fbU},
    {"negative", 0xf5a43594cb69ea17U},
    {"orbit", 0x55e218e98d015aecU},
    {"shake", 0xe8e0eabec5c6925dU},
    {"hover", 0xe61ef2fc8b84c0d6U},
    {"distractors", 0x401ddade063df8d4U},
};

TEST(Catalog, PicturesAreTheSameOnEveryMachine) {
  ASSERT_EQ(std::size(kFingerprints), scene_catalog().size());
  for (const Fingerprint& expected : kFingerprints) {
    GrayPicture picture(160, 90);
    SceneRenderer(scene_by_name(expected.scene)).render(3.0, 5, picture.writable());
    EXPECT_EQ(fingerprint(picture), expected.value) << expected.scene;
  }
}

TEST(Catalog, NamesAreUniqueAndFound) {
  std::set<std::string> names;
  for (const NamedScene& scene : scene_catalog()) {
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
    EXPECT_EQ(scene_by_name(scene.name, 7).seed, 7U);
  }
  try {
    (void)scene_by_name("moon");
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"moon\""), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("touchdown"), std::string::npos);
  }
}

}  // namespace
}  // namespace ellipse
