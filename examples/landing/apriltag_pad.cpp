// SPDX-License-Identifier: MIT
#include "examples/landing/apriltag_pad.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <vector>

#include "core/scene/wild_shapes.hpp"

namespace landing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ellipse::Shape;

constexpr int kTag = 0;
// The library's pixel origin is the corner of the first pixel, not its centre.
constexpr double kPixelOrigin = 0.5;

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* what) const {
    kFree(what);
  }
};
using Family = std::unique_ptr<apriltag_family_t, Free<tag36h11_destroy>>;
using Detector = std::unique_ptr<apriltag_detector_t, Free<apriltag_detector_destroy>>;
using Detections = std::unique_ptr<zarray_t, Free<apriltag_detections_destroy>>;

// Side of a cell; the tag with its border is inscribed in the ring's inner circle.
double cell_size(const apriltag_family_t& family, const ellipse::Pad& pad) {
  const auto inner = ellipse::inner_radius(pad);
  if (!inner) throw std::invalid_argument("apriltag: the pad has no ring around the tag");
  return std::numbers::sqrt2 * *inner / family.total_width;
}

// The cells of the tag on the pad, x forward and y left. Columns and rows start at the tag's black
// frame.
class Cells {
 public:
  Cells(const apriltag_family_t& family, double size)
      : size_(size),
        width_(family.width_at_border),
        is_white_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), false) {
    const std::uint64_t code = family.codes[kTag];
    for (std::uint32_t bit = 0; bit < family.nbits; ++bit) {
      const auto column = static_cast<int>(family.bit_x[bit]);
      const auto row = static_cast<int>(family.bit_y[bit]);
      is_white_[index(column, row)] = (code >> (family.nbits - 1 - bit) & 1U) != 0;
    }
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] bool is_white(int column, int row) const { return is_white_[index(column, row)]; }

  // Columns [left, right), rows [top, bottom).
  [[nodiscard]] Shape box(int left, int top, int right, int bottom, double level) const {
    const double middle = 0.5 * width_;
    const Vector2d center(0.5 * (left + right) - middle, middle - 0.5 * (top + bottom));
    const Vector2d half(0.5 * (right - left), 0.5 * (bottom - top));
    return ellipse::wild::box(size_ * center, size_ * half, 0.0, {.level = level});
  }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * width_ + column);
  }

  double size_;
  int width_;
  std::vector<bool> is_white_;  // row-major
};

// Calls use(line, first, end) for each run of at least `min_length` white cells in a line.
template <class IsWhite, class Use>
void for_each_run(int width, int min_length, const IsWhite& is_white, const Use& use) {
  for (int line = 0; line < width; ++line) {
    for (int first = 0; first < width; ++first) {
      int end = first;
      while (end < width && is_white(line, end)) ++end;
      if (end - first >= min_length) use(line, first, end);
      first = end;
    }
  }
}

class AprilTag : public Peer {
 public:
  AprilTag(const ellipse::Camera& camera, const ellipse::Pad& pad, double radius)
      : camera_(camera), family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    tag_size_ = radius * cell_size(*family_, pad) * family_->width_at_border;
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->quad_decimate = 1.0F;
  }

  std::optional<Sighting> find(const ellipse::ImageView& picture, const Vector3d&) override {
    image_u8_t image{picture.width,
                     picture.height,
                     static_cast<std::int32_t>(picture.stride),
                     const_cast<std::uint8_t*>(picture.data)};  // the library only reads it
    const Detections found(apriltag_detector_detect(detector_.get(), &image));
    apriltag_detection_t* best = nullptr;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* one = nullptr;
      zarray_get(found.get(), i, &one);
      const bool is_better = best == nullptr || one->decision_margin > best->decision_margin;
      if (one->id == kTag && is_better) best = one;
    }
    return best == nullptr ? std::nullopt : std::optional(sighting_of(*best));
  }

 private:
  // Does not use the library's pose estimate: it allocates matrices, and Debian's build exports no
  // function to free them.
  [[nodiscard]] Sighting sighting_of(const apriltag_detection_t& detection) const {
    const double half = 0.5 * tag_size_;
    const std::array<cv::Point3d, 4> corners = {
        {{-half, half, 0.0}, {half, half, 0.0}, {half, -half, 0.0}, {-half, -half, 0.0}}};
    std::array<cv::Point2d, 4> pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double* corner = detection.p[pixels.size() - 1 - i];  // its first one is bottom left
      pixels[i] = {corner[0] - kPixelOrigin, corner[1] - kPixelOrigin};
    }
    const cv::Matx33d matrix(
        camera_.fx, 0.0, camera_.cx, 0.0, camera_.fy, camera_.cy, 0.0, 0.0, 1.0);
    cv::Vec3d rvec;
    cv::Vec3d translation;
    cv::solvePnP(
        corners, pixels, matrix, cv::noArray(), rvec, translation, false, cv::SOLVEPNP_IPPE_SQUARE);
    return {Vector3d(translation[0], translation[1], translation[2]),
            half * camera_.fx / translation[2]};
  }

  ellipse::Camera camera_;
  Family family_;
  Detector detector_;  // destroyed before the family that it borrows
  double tag_size_ = 0.0;
};

}  // namespace

bool has_apriltag() {
  return true;
}

// A black square with white cells. Adjacent white cells are merged into runs, because the black
// would show between the blurred edges of separate cells. Rows merge cells horizontally, columns
// vertically.
ellipse::Sheet tag_sheet(const ellipse::Pad& pad) {
  const Family family(tag36h11_create());
  const Cells cells(*family, cell_size(*family, pad));
  const int width = cells.width();

  ellipse::Sheet sheet;
  sheet.shapes.push_back(cells.box(0, 0, width, width, pad.paint_level));
  for_each_run(
      width,
      1,
      [&](int row, int column) { return cells.is_white(column, row); },
      [&](int row, int first, int end) {
        sheet.shapes.push_back(cells.box(first, row, end, row + 1, pad.plate_level));
      });
  for_each_run(
      width,
      2,
      [&](int column, int row) { return cells.is_white(column, row); },
      [&](int column, int first, int end) {
        sheet.shapes.push_back(cells.box(column, first, column + 1, end, pad.plate_level));
      });
  return sheet;
}

std::unique_ptr<Peer> make_apriltag(const ellipse::Camera& camera,
                                    const ellipse::Pad& pad,
                                    double radius) {
  return std::make_unique<AprilTag>(camera, pad, radius);
}

}  // namespace landing
