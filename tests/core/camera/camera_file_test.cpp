// SPDX-License-Identifier: MIT
#include "core/camera/camera_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <stdexcept>
#include <string>

#include "tests/support/cameras.hpp"

namespace ellipse {
namespace {

// Creates a temporary folder for each test.
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
  // The error of read_camera() for a rejected file, without its folder.
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

TEST_F(CameraFile, ReadsOpenCvFiles) {
  const Camera expected = support::wide();
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

TEST_F(CameraFile, ReadsRosFisheye) {
  std::string text = with("plumb_bob", "equidistant");
  const std::string five = "cols: 5\n  data: [-0.337586, 0.111344, -0.00069, -0.0003, 0.0]";
  text.replace(text.find(five), five.size(), "cols: 4\n  data: [-0.02, 0.004, -0.002, 0.0003]");
  const Camera camera = read_camera(file("ros.yaml", text));
  EXPECT_EQ(camera.lens, LensModel::kFisheye);
  EXPECT_DOUBLE_EQ(camera.distortion[2], -0.002);
}

TEST_F(CameraFile, ErrorNamesFileLineAndKey) {
  EXPECT_EQ(refusal("a.yaml", with("image_width: 640\n", "")), "a.yaml: image_width is missing");
  EXPECT_EQ(refusal("b.yaml", with("image_height: 480", "image_height: -3")),
            "b.yaml:2: image_height is not a whole number from 1 to 65536");
  EXPECT_EQ(refusal("c.yaml", with("0., 0., 1. ]\ndist", "0., 1. ]\ndist")),
            "c.yaml:5: camera_matrix does not have rows x cols numbers");
  EXPECT_EQ(refusal("d.yaml", with("430.5, 0.,", "430.5, 2.,")),
            "d.yaml:5: camera_matrix has a skew");
  EXPECT_EQ(refusal("e.yaml", with("430.5", "-430.5")),
            "e.yaml:5: camera_matrix has a focal length below 1 px");
  EXPECT_EQ(refusal("f.yaml", with("plumb_bob", "spherical")),
            "f.yaml:9: distortion_model is none of: plumb_bob, rational_polynomial, equidistant, "
            "fisheye, none");
  EXPECT_EQ(refusal("g.yaml", with("plumb_bob", "equidistant")),
            "g.yaml:10: distortion_coefficients does not have the 4 numbers of a fisheye");
  EXPECT_EQ(refusal("h.yaml", with("0.111344", "many")),
            "h.yaml:10: distortion_coefficients is not a number");
}

TEST_F(CameraFile, RejectsOtherFiles) {
  EXPECT_EQ(refusal("empty.yaml", ""), "empty.yaml: is empty");
  EXPECT_EQ(refusal("zeros.yaml", std::string(64, '\0')), "zeros.yaml: is not a text file");
  EXPECT_NE(refusal("prose.txt", "Call me Ishmael.\nSome years ago\n"), "accepted");
  EXPECT_NE(refusal("half.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera"), "accepted");
  EXPECT_NE(refusal("half.json", "{\"camera_matrix\": [1, 2"), "accepted");
  EXPECT_NE(refusal("tabs.yaml", "image_width:\t640\n\t- [ {"), "accepted");
  EXPECT_THROW((void)read_camera(path("absent.yaml")), std::invalid_argument);
}

// Output of "ros2 topic echo" for a camera_info: other names, and unindented list dashes.
constexpr const char* kMessage = R"(header:
  stamp:
    sec: 1700000000
    nanosec: 5
  frame_id: camera
height: 480
width: 640
distortion_model: plumb_bob
d:
- -0.337586
- 0.111344
- -0.00069
- -0.0003
- 0.0
k:
- 430.5
- 0.0
- 319.25
- 0.0
- 431.25
- 240.75
- 0.0
- 0.0
- 1.0
binning_x: 0
roi:
  x_offset: 0
  height: 0
  width: 0
  do_rectify: false
---
)";

TEST_F(CameraFile, ReadsRosMessages) {
  EXPECT_EQ(read_camera(file("message.yaml", kMessage)), read_camera(file("a.yaml", kCameraInfo)));
  std::string text = kMessage;
  EXPECT_EQ(refusal("b.yaml", text.replace(text.find("430.5"), 5, "lots ")),
            "b.yaml:15: k is not a number");
}

TEST_F(CameraFile, SkipsAByteOrderMark) {
  const Camera expected = read_camera(file("a.yaml", kCameraInfo));
  EXPECT_EQ(read_camera(file("b.yaml", std::string("\xEF\xBB\xBF").append(kCameraInfo))), expected);
}

TEST_F(CameraFile, ErrorNamesFileLineAndKeyOfValuesOutOfRange) {
  EXPECT_EQ(refusal("a.yaml", with("319.25", "1.0e7")),
            "a.yaml:5: camera_matrix is out of range: cx is not between -1e6 and 1e6 px");
  EXPECT_EQ(refusal("b.yaml", with("431.25", "1.0e7")),
            "b.yaml:5: camera_matrix is out of range: fy is not in (0, 1e6] px");
  EXPECT_EQ(refusal("c.yaml", with("430.5", "1.0e-300")),
            "c.yaml:5: camera_matrix has a focal length below 1 px");
}

TEST_F(CameraFile, RejectsALensThatIsNotOneToOne) {
  const std::string expected =
      "distortion_coefficients is not invertible over the middle half of the picture: check its "
      "units and order";
  for (const char* each : {"1e300, 1e300, 0., 0., 0.",
                           "-50., 0., 0., 0., 0.",
                           "0., 0., 50., 50., 0.",
                           "0., 0., 0., 1e300, 0."}) {
    EXPECT_EQ(refusal("a.yaml", with("-0.337586, 0.111344, -0.00069, -0.0003, 0.0", each)),
              "a.yaml:10: " + expected)
        << each;
  }
}

// A lens may be non-monotonic beyond the middle half; this one is, beyond 1.5 times that radius.
TEST_F(CameraFile, AcceptsALensThatTurnsBackFartherOut) {
  const std::string text =
      with("-0.337586, 0.111344, -0.00069, -0.0003, 0.0", "-0.3, 0., 0., 0., 0.");
  EXPECT_EQ(read_camera(file("a.yaml", text)).distortion[0], -0.3);
}

TEST_F(CameraFile, AcceptsRegularFilesOnly) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  for (const char* name : {"fifo", "."}) {
    try {
      (void)read_camera(path(name));
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()), path(name) + ": is not a regular file");
    }
  }
}

TEST_F(CameraFile, RejectsFilesWithoutKeys) {
  EXPECT_EQ(refusal("a.yaml", "[1, 2]\n"), "a.yaml: is not a calibration: it has no keys");
  EXPECT_EQ(refusal("b.yaml", "- 1\n- 2\n"), "b.yaml: is not a calibration: it has no keys");
}

TEST_F(CameraFile, RejectsEmptyKeys) {
  EXPECT_EQ(refusal("a.yaml", "header:\n  sec: 17\n  :\n"), "a.yaml: is not a calibration");
}

// OpenCV's parser would read past the end.
TEST_F(CameraFile, RejectsTruncatedFiles) {
  for (const char* text : {"<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera_matrix type_id=",
                           "{\"camera_matrix\": [1, 2"}) {
    EXPECT_EQ(refusal("a", text), "a: is not a calibration: it is truncated");
  }
}

// The error names the line number of broken YAML.
TEST_F(CameraFile, ErrorNamesTheLineOfInvalidYaml) {
  const std::string message = refusal("broken.yaml", with("data: [ 430.5", "data: [ 430.5 }"));
  EXPECT_EQ(message.rfind("broken.yaml:8: is not a calibration", 0), 0U) << message;
}

}  // namespace
}  // namespace ellipse
