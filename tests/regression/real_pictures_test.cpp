// SPDX-License-Identifier: MIT
//
// Detectors on the pictures of Debian's package opencv-doc; README.md says how they were labelled.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/tracking/tracker.hpp"

namespace ellipse {
namespace {

namespace fs = std::filesystem;

const fs::path kPackage = "/usr/share/doc/opencv-doc";
constexpr double kSameEllipseIou = 0.8;

/// The values measured when the row was last written. An improved detector moves them.
struct Limits {
  const char* detector;  ///< Its nick.
  int min_right;         ///< Labelled ellipses that are found.
  int max_false;         ///< Pictures without an ellipse that show a target.
};

constexpr Limits kLimits[] = {
    {"contours", 38, 24},
    {"arcs", 58, 0},
};

void PrintTo(const Limits& limits, std::ostream* out) {
  *out << limits.detector;
}

/// A line of the table: one ellipse of a picture, or a picture that shows none.
struct Label {
  std::string picture;
  std::optional<Ellipse> ellipse;
};

Label read_label(const std::string& line) {
  std::istringstream fields(line);
  Label label;
  std::getline(fields, label.picture, ',');
  if (line.ends_with(",,,,,")) return label;
  Ellipse e;
  for (double* number : {&e.cx, &e.cy, &e.semi_major, &e.semi_minor, &e.angle_rad}) {
    if (!(fields >> *number)) throw std::runtime_error("real_pictures.csv: " + line);
    fields.ignore(1, ',');
  }
  label.ellipse = e;
  return label;
}

std::vector<Label> read_labels() {
  std::ifstream file(ELLIPSE_REAL_PICTURES);
  std::vector<Label> labels;
  std::string line;
  std::getline(file, line);  // the names of the columns
  while (std::getline(file, line)) labels.push_back(read_label(line));
  return labels;
}

cv::Mat read_picture(const std::string& name) {
  cv::Mat luma = cv::imread(kPackage / name, cv::IMREAD_GRAYSCALE);
  if (luma.empty()) throw std::runtime_error("cannot read " + (kPackage / name).string());
  return luma;
}

ImageView view(const cv::Mat& luma) {
  return {luma.data, luma.cols, luma.rows, static_cast<std::ptrdiff_t>(luma.step)};
}

class RealPictures : public testing::TestWithParam<Limits> {
 protected:
  void SetUp() override {
    // Small containers install packages without their documentation, which contains the pictures.
    if (!fs::is_directory(kPackage / "examples/data"))
      GTEST_SKIP() << "package opencv-doc is not installed";
    labels_ = read_labels();
    ASSERT_FALSE(labels_.empty()) << ELLIPSE_REAL_PICTURES;
    set_by_name(settings_, "detector", GetParam().detector);
    set_by_name(settings_, "tracking", "none");
  }

  /// Whether the detector finds the labelled ellipse in its picture.
  [[nodiscard]] bool is_found(const Label& label) const {
    const cv::Mat luma = read_picture(label.picture);
    const std::unique_ptr<Detector> detector = make_detector(settings_.detector);
    Thresholds thresholds = settings_.limits;
    thresholds.wants_all = true;
    thresholds.contour_overlap = detector->detecting_overlaps().contour;
    thresholds.ellipse_overlap = detector->detecting_overlaps().ellipse;
    return std::ranges::any_of(detector->detect(view(luma), thresholds), [&](const Detection& d) {
      return iou_inside(d.ellipse, *label.ellipse, luma.cols, luma.rows) >= kSameEllipseIou;
    });
  }

  std::vector<Label> labels_;
  TrackerSettings settings_;
};

TEST_P(RealPictures, EnoughEllipsesAreFound) {
  int right = 0;
  std::ostringstream missed;
  for (const Label& label : labels_) {
    if (!label.ellipse) continue;
    if (is_found(label)) {
      ++right;
    } else {
      missed << label.picture << " at " << label.ellipse->center().transpose() << '\n';
    }
  }
  RecordProperty("right", right);
  EXPECT_GE(right, GetParam().min_right) << "missed:\n" << missed.str();
}

TEST_P(RealPictures, PicturesWithoutEllipsesGiveFewTargets) {
  int wrong = 0;
  std::ostringstream found;
  for (const Label& label : labels_) {
    if (label.ellipse) continue;
    const cv::Mat luma = read_picture(label.picture);
    const auto target = Tracker(settings_).process(view(luma), 0);
    if (!target) continue;
    ++wrong;
    found << label.picture << " at " << target->ellipse.center().transpose() << ", semi-axes "
          << target->ellipse.semi_major << " and " << target->ellipse.semi_minor << '\n';
  }
  RecordProperty("false", wrong);
  EXPECT_LE(wrong, GetParam().max_false) << "found:\n" << found.str();
}

INSTANTIATE_TEST_SUITE_P(Detectors, RealPictures, testing::ValuesIn(kLimits), [](const auto& info) {
  return std::string(info.param.detector);
});

}  // namespace
}  // namespace ellipse
