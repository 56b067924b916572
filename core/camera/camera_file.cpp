// SPDX-License-Identifier: MIT
#include "core/camera/camera_file.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/text_file.hpp"

namespace ellipse {
namespace {

constexpr double kMinFocal = 1.0;  // px: shorter ones are in wrong units

// Alternative keys of different programs for one value.
using Keys = std::initializer_list<const char*>;
constexpr Keys kWidthKeys = {"image_width", "image_Width", "width"};
constexpr Keys kHeightKeys = {"image_height", "image_Height", "height"};
constexpr Keys kMatrixKeys = {"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"};
constexpr Keys kDistortionKeys = {
    "distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D", "d"};
constexpr Keys kModelKeys = {"distortion_model"};
constexpr Keys kFisheyeKeys = {"fisheye_model"};

// A calibration file, with error messages that name file, line and key.
class File {
 public:
  explicit File(const std::string& path) : path_(path), text_(read_text_file(path)) { parse(); }

  // The node of the first key present, else an empty one; `found` is that key, else the first one.
  [[nodiscard]] cv::FileNode find(Keys keys, const char*& found) const {
    for (const char* key : keys) {
      const cv::FileNode node = storage_[key];
      if (node.empty()) continue;
      found = key;
      return node;
    }
    found = *keys.begin();
    return {};
  }

  [[noreturn]] void refuse(const char* key, const std::string& reason) const {
    const int line = line_of(key);
    throw std::invalid_argument(path_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + key +
                                " " + reason);
  }

 private:
  void parse() {
    const std::size_t first = text_.find_first_not_of(" \t\r\n");
    if (is_cut_off(text_[first])) {
      throw std::invalid_argument(path_ + ": is not a calibration: it is truncated");
    }
    // OpenCV requires its own first line in YAML, which ROS files lack.
    const bool is_bare = text_[first] != '<' && text_[first] != '{' && text_[first] != '%';
    const std::string text = is_bare ? "%YAML:1.0\n---\n" + as_opencv_reads() : text_;
    const int added = is_bare ? 2 : 0;
    try {
      storage_.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    } catch (const cv::Exception& error) {
      const std::string& message = error.func;  // OpenCV's parsers put their message here
      throw std::invalid_argument(path_ + line_in(message, added) +
                                  ": is not a calibration: " + reason_in(error));
    } catch (const std::exception&) {  // std::length_error for an empty key
      throw std::invalid_argument(path_ + ": is not a calibration");
    }
    if (!storage_.isOpened()) throw std::invalid_argument(path_ + ": is not a calibration");
    if (!storage_.root().isMap()) {
      throw std::invalid_argument(path_ + ": is not a calibration: it has no keys");
    }
  }

  // OpenCV's XML and JSON parsers may read beyond the end of a truncated file.
  [[nodiscard]] bool is_cut_off(char first) const {
    if (first != '<' && first != '{') return false;
    const std::string_view end = first == '<' ? "</opencv_storage>" : "}";
    const std::string_view text(text_.data(), text_.find_last_not_of(" \t\r\n") + 1);
    return !text.ends_with(end);
  }

  // Adapts YAML to OpenCV's parser: blanks "---" lines, and indents lists whose dashes are in the
  // first column, as `ros2 topic echo` prints them.
  [[nodiscard]] std::string as_opencv_reads() const {
    std::istringstream lines(text_);
    std::string text;
    std::string line;
    while (std::getline(lines, line)) {
      if (line.rfind("---", 0) == 0) line.replace(0, 3, "   ");
      if (line.rfind("- ", 0) == 0) text += "  ";
      text += line;
      text += '\n';
    }
    return text;
  }

  // OpenCV's messages are "name(line): reason".
  [[nodiscard]] static std::string line_in(const std::string& message, int added) {
    const std::size_t open = message.find('(');
    const std::size_t close = message.find("):");
    if (open == std::string::npos || close == std::string::npos || close < open) return {};
    const int line = std::atoi(message.c_str() + open + 1) - added;
    return line > 0 ? ":" + std::to_string(line) : std::string();
  }

  [[nodiscard]] static std::string reason_in(const cv::Exception& error) {
    const std::string& message = error.func;
    const std::size_t close = message.find("): ");
    return close == std::string::npos ? error.err : message.substr(close + 3);
  }

  // Line number of a key: the first word of a line, after blanks, quotes or a bracket. 0 if absent.
  [[nodiscard]] int line_of(std::string_view key) const {
    std::istringstream lines(text_);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      const std::size_t first = line.find_first_not_of(" \t\"<{");
      if (first == std::string::npos || line.compare(first, key.size(), key) != 0) continue;
      const std::size_t end = first + key.size();
      if (end < line.size() && std::string_view(":>\" \t").find(line[end]) != std::string::npos) {
        return number;
      }
    }
    return 0;
  }

  std::string path_;
  std::string text_;
  cv::FileStorage storage_;
};

double number(const File& file, const char* key, const cv::FileNode& node) {
  if (!node.isInt() && !node.isReal()) file.refuse(key, "is not a number");
  const double value = node.real();
  if (!std::isfinite(value)) file.refuse(key, "is not finite");
  return value;
}

int size(const File& file, Keys keys) {
  const char* key = nullptr;
  const cv::FileNode node = file.find(keys, key);
  if (node.empty()) file.refuse(key, "is missing");
  const double value = number(file, key, node);
  if (!(value >= 1.0 && value <= 65536.0) || value != std::floor(value)) {
    file.refuse(key, "is not a whole number from 1 to 65536");
  }
  return static_cast<int>(value);
}

// Reads a plain list, or rows, cols and data as in OpenCV and ROS.
std::vector<double> numbers(const File& file, const char* key, const cv::FileNode& node) {
  const cv::FileNode data = node.isMap() ? node["data"] : node;
  if (data.empty() || !data.isSeq()) file.refuse(key, "has no data");
  std::vector<double> values;
  for (const cv::FileNode& each : data) values.push_back(number(file, key, each));
  if (node.isMap()) {
    const double rows = number(file, key, node["rows"]);
    const double cols = number(file, key, node["cols"]);
    if (rows * cols != static_cast<double>(values.size())) {
      file.refuse(key, "does not have rows x cols numbers");
    }
  }
  return values;
}

void read_matrix(const File& file, Camera& camera) {
  const char* key = nullptr;
  const cv::FileNode node = file.find(kMatrixKeys, key);
  if (node.empty()) file.refuse(key, "is missing");
  const std::vector<double> k = numbers(file, key, node);
  if (k.size() != 9) file.refuse(key, "is not a 3 x 3 matrix");
  if (k[1] != 0.0) file.refuse(key, "has a skew");
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    file.refuse(key, "is not of the form [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  if (!(k[0] >= kMinFocal && k[4] >= kMinFocal)) {
    file.refuse(key, "has a focal length below 1 px");
  }
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    file.refuse(key, std::string("is out of range: ").append(error.what()));
  }
}

LensModel model_of(const File& file) {
  const char* key = nullptr;
  const cv::FileNode fisheye = file.find(kFisheyeKeys, key);
  if (!fisheye.empty() && number(file, key, fisheye) != 0.0) return LensModel::kFisheye;
  const cv::FileNode node = file.find(kModelKeys, key);
  if (node.empty()) return LensModel::kBrownConrady;
  const std::string name = node.isString() ? node.string() : std::string();
  if (name == "plumb_bob" || name == "rational_polynomial" || name == "none") {
    return LensModel::kBrownConrady;
  }
  if (name == "equidistant" || name == "fisheye") return LensModel::kFisheye;
  file.refuse(key, "is none of: plumb_bob, rational_polynomial, equidistant, fisheye, none");
}

// Whether the lens maps the middle half of the picture one to one. Farther out many a calibration's
// polynomial extrapolates and is not monotonic.
bool is_one_to_one(const Camera& camera) {
  constexpr int kDirections = 16;
  const Lens lens(camera);
  const Eigen::Vector2d middle(camera.width / 2.0, camera.height / 2.0);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = kTwoPi * i / kDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const auto ideal = lens.ideal_from_picture(middle + 0.5 * middle.norm() * direction);
    const auto there = ideal ? lens.picture_from_ideal(*ideal) : std::nullopt;
    if (!there || !(there->slope.determinant() > 0.0)) return false;
  }
  return true;
}

void read_distortion(const File& file, Camera& camera) {
  camera.lens = model_of(file);
  const char* key = nullptr;
  const cv::FileNode node = file.find(kDistortionKeys, key);
  if (node.empty()) {
    if (camera.lens == LensModel::kFisheye) file.refuse(key, "is missing");
    return;
  }
  const std::vector<double> k = numbers(file, key, node);
  const bool is_fisheye = camera.lens == LensModel::kFisheye;
  if (is_fisheye && k.size() != 4) file.refuse(key, "does not have the 4 numbers of a fisheye");
  if (!is_fisheye && k.size() != 0 && k.size() != 4 && k.size() != 5 && k.size() != 8 &&
      k.size() != 12 && k.size() != 14) {
    file.refuse(key, "does not have 4, 5 or 8 numbers");
  }
  const std::size_t known = camera.distortion.size();
  if (std::any_of(k.begin() + static_cast<std::ptrdiff_t>(std::min(known, k.size())),
                  k.end(),
                  [](double v) { return v != 0.0; })) {
    file.refuse(key, "has a thin prism or a tilted sensor, which are not supported");
  }
  std::copy_n(k.begin(), std::min(known, k.size()), camera.distortion.begin());
  if (camera.is_distorted() && !is_one_to_one(camera)) {
    file.refuse(key,
                "is not invertible over the middle half of the picture: check its units and order");
  }
}

}  // namespace

Camera read_camera(const std::string& path) {
  const File file(path);
  Camera camera;
  camera.width = size(file, kWidthKeys);
  camera.height = size(file, kHeightKeys);
  read_matrix(file, camera);
  read_distortion(file, camera);
  return camera;
}

}  // namespace ellipse
