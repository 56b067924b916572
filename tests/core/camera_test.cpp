// SPDX-License-Identifier: MIT
#include "core/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_file.hpp"
#include "tests/support/cameras.hpp"

namespace ellipse {
namespace {

using Eigen::Vector2d;

Camera wide() {
  Camera camera = Camera::with_hfov(1.012, 640, 360);
  camera.fy = 1.01 * camera.fx;
  camera.distortion = {-0.22, 0.05, 0.001, -0.0007, -0.004, 0.01, 0.002, -0.001};
  return camera;
}

std::vector<cv::Point2d> opencv_picture(const Camera& camera, const std::vector<Vector2d>& ideal) {
  const cv::Matx33d k(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  std::vector<cv::Point3d> rays;
  for (const Vector2d& p : ideal) {
    rays.emplace_back((p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy, 1.0);
  }
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  std::vector<cv::Point2d> picture;
  if (camera.lens == LensModel::kFisheye) {
    const auto& d = camera.distortion;
    cv::fisheye::projectPoints(rays, picture, zero, zero, k, cv::Vec4d(d[0], d[1], d[2], d[3]));
  } else {
    const cv::Mat d(1, 8, CV_64F, const_cast<double*>(camera.distortion.data()));
    cv::projectPoints(rays, zero, zero, k, d, picture);
  }
  return picture;
}

std::vector<Vector2d> grid(double margin_px) {
  std::vector<Vector2d> points;
  for (double y = -margin_px; y <= 360.0 + margin_px; y += 23.7) {
    for (double x = -margin_px; x <= 640.0 + margin_px; x += 31.1) points.emplace_back(x, y);
  }
  return points;
}

class EachLens : public testing::TestWithParam<Camera> {};
INSTANTIATE_TEST_SUITE_P(Lens, EachLens, testing::Values(wide(), support::fisheye()));

TEST_P(EachLens, DistortsAsOpenCvDoes) {
  const Lens lens(GetParam());
  const std::vector<Vector2d> ideal = grid(40.0);
  const std::vector<cv::Point2d> expected = opencv_picture(GetParam(), ideal);
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const auto point = lens.picture_from_ideal(ideal[i]);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->picture_px.x(), expected[i].x, 1e-8);
    EXPECT_NEAR(point->picture_px.y(), expected[i].y, 1e-8);
  }
}

TEST_P(EachLens, IsUndone) {
  const Lens lens(GetParam());
  for (const Vector2d& ideal : grid(100.0)) {
    const auto point = lens.picture_from_ideal(ideal);
    ASSERT_TRUE(point);
    const auto back = lens.ideal_from_picture(point->picture_px);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - ideal).norm(), 1e-6) << ideal.transpose();
  }
}

TEST_P(EachLens, KnowsItsSlope) {
  const Lens lens(GetParam());
  constexpr double kStep = 1e-4;
  for (const Vector2d& ideal : grid(0.0)) {
    const auto here = lens.picture_from_ideal(ideal);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = kStep * Vector2d::Unit(axis);
      const Vector2d change = lens.picture_from_ideal(ideal + step)->picture_px -
                              lens.picture_from_ideal(ideal - step)->picture_px;
      EXPECT_LT((change / (2.0 * kStep) - here->slope.col(axis)).norm(), 1e-6);
    }
  }
}

TEST(Lens, EndsWhereItsPolynomialTurnsBack) {
  Camera camera = Camera::with_hfov(1.012, 640, 360);
  camera.distortion = {-0.3};  // r (1 - .3 r^2) is highest at r = 1.054
  const Lens lens(camera);
  const Vector2d middle(camera.cx, camera.cy);
  EXPECT_TRUE(lens.picture_from_ideal(middle + Vector2d(1.0 * camera.fx, 0.0)));
  EXPECT_FALSE(lens.picture_from_ideal(middle + Vector2d(1.06 * camera.fx, 0.0)));
  EXPECT_FALSE(lens.ideal_from_picture(middle + Vector2d(0.75 * camera.fx, 0.0)));
}

TEST(Lens, WithoutDistortionIsTheIdealPlane) {
  const Camera camera = Camera::with_hfov(1.012, 640, 360);
  EXPECT_FALSE(camera.is_distorted());
  const Lens lens(camera);
  EXPECT_LT((lens.picture_from_ideal({17.0, 300.0})->picture_px - Vector2d(17.0, 300.0)).norm(),
            1e-12);
}

TEST(Camera, ResizedSeesTheSameDirections) {
  const Camera camera = wide();
  const Camera half = camera.resized(320, 180);
  const Vector2d ideal(500.0, 90.0);
  const Vector2d ideal_of_half = 0.5 * (ideal.array() + 0.5).matrix() - Vector2d(0.5, 0.5);
  const Vector2d whole = Lens(camera).picture_from_ideal(ideal)->picture_px;
  const Vector2d small = Lens(half).picture_from_ideal(ideal_of_half)->picture_px;
  EXPECT_LT((2.0 * (small.array() + 0.5) - 0.5 - whole.array()).matrix().norm(), 1e-9);
}

// Files: a temporary one each.

class CameraFile : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("camera-" + std::string(test->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) { return (folder_ / name).string(); }
  std::string file(const char* name, const std::string& text) {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  // What read_camera() says of a file that it refuses, without its folder.
  std::string refusal(const char* name, const std::string& text) {
    try {
      (void)read_camera(file(name, text));
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(folder_.string() + "/", 0), 0U) << message;
      return message.substr(folder_.string().size() + 1);
    }
    return "accepted";
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(CameraFile, ReadsWhatOpenCvWrites) {
  const Camera expected = wide();
  for (const char* name : {"camera.yml", "camera.xml", "camera.json"}) {
    cv::FileStorage storage(path(name), cv::FileStorage::WRITE);
    storage << "image_width" << 640 << "image_height" << 360;
    storage << "camera_matrix"
            << cv::Mat(cv::Matx33d(
                   expected.fx, 0.0, expected.cx, 0.0, expected.fy, expected.cy, 0.0, 0.0, 1.0));
    const cv::Mat d(1, 8, CV_64F, const_cast<double*>(expected.distortion.data()));
    storage << "distortion_coefficients" << d;
    storage.release();
    EXPECT_EQ(read_camera(path(name)), expected) << name;
  }
}

constexpr const char* kCameraInfo = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
# what camera_calibration writes
camera_matrix:
  rows: 3
  cols: 3
  data: [ 430.5, 0., 319.25, 0., 431.25, 240.75, 0., 0., 1. ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.337586, 0.111344, -0.00069, -0.0003, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
projection_matrix:
  rows: 3
  cols: 4
  data: [ 350., 0., 320., 0., 0., 390., 240., 0., 0., 0., 1., 0. ]
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kCameraInfo;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(CameraFile, ReadsRosCameraInfo) {
  for (const std::string& begin : {std::string(), std::string("---\n")}) {
    const Camera camera = read_camera(file("ros.yaml", begin + kCameraInfo));
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    EXPECT_EQ(camera.lens, LensModel::kBrownConrady);
    EXPECT_DOUBLE_EQ(camera.fx, 430.5);
    EXPECT_DOUBLE_EQ(camera.cy, 240.75);
    EXPECT_DOUBLE_EQ(camera.distortion[0], -0.337586);
    EXPECT_DOUBLE_EQ(camera.distortion[3], -0.0003);
  }
}

TEST_F(CameraFile, ReadsAFisheyeOfRos) {
  std::string text = with("plumb_bob", "equidistant");
  const std::string five = "cols: 5\n  data: [-0.337586, 0.111344, -0.00069, -0.0003, 0.0]";
  text.replace(text.find(five), five.size(), "cols: 4\n  data: [-0.02, 0.004, -0.002, 0.0003]");
  const Camera camera = read_camera(file("ros.yaml", text));
  EXPECT_EQ(camera.lens, LensModel::kFisheye);
  EXPECT_DOUBLE_EQ(camera.distortion[2], -0.002);
}

TEST_F(CameraFile, NamesFileLineAndKeyOfWhatIsWrong) {
  EXPECT_EQ(refusal("a.yaml", with("image_width: 640\n", "")), "a.yaml: image_width is missing");
  EXPECT_EQ(refusal("b.yaml", with("image_height: 480", "image_height: -3")),
            "b.yaml:2: image_height is not a whole number from 1 to 65536");
  EXPECT_EQ(refusal("c.yaml", with("0., 0., 1. ]\ndist", "0., 1. ]\ndist")),
            "c.yaml:5: camera_matrix has not rows x cols numbers");
  EXPECT_EQ(refusal("d.yaml", with("430.5, 0.,", "430.5, 2.,")),
            "d.yaml:5: camera_matrix has a skew");
  EXPECT_EQ(refusal("e.yaml", with("430.5", "-430.5")),
            "e.yaml:5: camera_matrix has a focal length that is not above 0");
  EXPECT_EQ(refusal("f.yaml", with("plumb_bob", "spherical")),
            "f.yaml:9: distortion_model is none of: plumb_bob, rational_polynomial, equidistant, "
            "fisheye, none");
  EXPECT_EQ(refusal("g.yaml", with("plumb_bob", "equidistant")),
            "g.yaml:10: distortion_coefficients of a fisheye has not 4 numbers");
  EXPECT_EQ(refusal("h.yaml", with("0.111344", "many")),
            "h.yaml:10: distortion_coefficients is not a number");
}

TEST_F(CameraFile, RefusesWhatIsNoCalibration) {
  EXPECT_EQ(refusal("empty.yaml", ""), "empty.yaml: is empty");
  EXPECT_EQ(refusal("zeros.yaml", std::string(64, '\0')), "zeros.yaml: is no text");
  EXPECT_NE(refusal("prose.txt", "Call me Ishmael.\nSome years ago\n"), "accepted");
  EXPECT_NE(refusal("half.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera"), "accepted");
  EXPECT_NE(refusal("half.json", "{\"camera_matrix\": [1, 2"), "accepted");
  EXPECT_NE(refusal("tabs.yaml", "image_width:\t640\n\t- [ {"), "accepted");
  EXPECT_THROW((void)read_camera(path("absent.yaml")), std::invalid_argument);
}

// A broken line of YAML is told by its number.
TEST_F(CameraFile, NamesTheLineOfBrokenYaml) {
  const std::string message = refusal("broken.yaml", with("data: [ 430.5", "data: [ 430.5 }"));
  EXPECT_EQ(message.rfind("broken.yaml:8: is no calibration", 0), 0U) << message;
}

}  // namespace
}  // namespace ellipse
