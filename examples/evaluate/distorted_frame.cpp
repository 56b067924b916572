// SPDX-License-Identifier: MIT
#include "examples/evaluate/distorted_frame.hpp"

#include <Eigen/LU>

#include "core/camera/lens_view.hpp"

namespace evaluate {
namespace {

// Fast test whether a point is inside an ellipse.
class Inside {
 public:
  explicit Inside(const ellipse::Ellipse& e)
      : center_(e.center()), inverse_(ellipse::shape_matrix(e).inverse()) {}

  [[nodiscard]] bool operator()(const Eigen::Vector2f& point) const {
    const Eigen::Vector2d p = point.cast<double>() - center_;
    return p.dot(inverse_ * p) <= 1.0;
  }

 private:
  Eigen::Vector2d center_;
  Eigen::Matrix2d inverse_;
};

}  // namespace

DistortedFrame::DistortedFrame(const ellipse::Camera& camera) : lens_(camera) {
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto ideal = lens_.ideal_from_picture({x, y});
      if (ideal) ideal_px_.emplace_back(ideal->cast<float>());
    }
  }
}

double DistortedFrame::iou(const ellipse::Ellipse& a, const ellipse::Ellipse& b) const {
  const Inside is_in_a(a);
  const Inside is_in_b(b);
  int common = 0;
  int either = 0;
  for (const Eigen::Vector2f& point : ideal_px_) {
    const bool in_a = is_in_a(point);
    const bool in_b = is_in_b(point);
    common += in_a && in_b ? 1 : 0;
    either += in_a || in_b ? 1 : 0;
  }
  return either > 0 ? static_cast<double>(common) / either : 0.0;
}

ellipse::Ellipse DistortedFrame::to_ideal(const ellipse::Ellipse& in_picture) const {
  return ellipse::undistorted(lens_, in_picture).value_or(in_picture);
}

std::optional<ellipse::Ellipse> DistortedFrame::to_picture(const ellipse::Ellipse& ideal) const {
  return ellipse::distorted(lens_, ideal);
}

}  // namespace evaluate
