// SPDX-License-Identifier: MIT
#include "core/tracking/pad/visible_part.hpp"

#include <algorithm>
#include <cmath>

#include "core/edges/gradient_map.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kSteps = 8;  // per side of the undistorted border; bisections of a line

// A rectangle of the ideal plane.
struct IdealRect {
  double left;
  double top;
  double right;
  double bottom;
};

// An upright rectangle that is entirely visible: bounded by the innermost point of each undistorted
// image side.
IdealRect inner_rect(const LensView& lens, double right, double bottom) {
  if (!lens.is_distorted()) return {GradientMap::kBorder, GradientMap::kBorder, right, bottom};
  IdealRect rect{-kFarPx, -kFarPx, kFarPx, kFarPx};
  for (int i = 0; i <= kSteps; ++i) {
    const double at = static_cast<double>(i) / kSteps;
    const double x = std::lerp(GradientMap::kBorder, right, at);
    const double y = std::lerp(GradientMap::kBorder, bottom, at);
    // Points without an inverse are NaN, which std::max and std::min ignore as second argument.
    rect.left = std::max(rect.left, lens.approximate_ideal({GradientMap::kBorder, y}).x());
    rect.right = std::min(rect.right, lens.approximate_ideal({right, y}).x());
    rect.top = std::max(rect.top, lens.approximate_ideal({x, GradientMap::kBorder}).y());
    rect.bottom = std::min(rect.bottom, lens.approximate_ideal({x, bottom}).y());
  }
  return rect;
}

}  // namespace

VisiblePart::VisiblePart(const PadView& view, const ImageView& luma)
    : view_(view),
      right_px_(luma.width - 1 - GradientMap::kBorder),
      bottom_px_(luma.height - 1 - GradientMap::kBorder) {
  const IdealRect rect = inner_rect(view.lens, right_px_, bottom_px_);
  const Eigen::Matrix3d& h = view.ideal_from_pad;
  borders_.row(0) = h.row(0) - rect.left * h.row(2);
  borders_.row(1) = rect.right * h.row(2) - h.row(0);
  borders_.row(2) = h.row(1) - rect.top * h.row(2);
  borders_.row(3) = rect.bottom * h.row(2) - h.row(1);
}

bool VisiblePart::is_visible_distorted(const Eigen::Vector2d& pad_point) const {
  const auto projected = view_.at(pad_point);
  return projected && projected->point.x() >= GradientMap::kBorder &&
         projected->point.y() >= GradientMap::kBorder && projected->point.x() <= right_px_ &&
         projected->point.y() <= bottom_px_;
}

Interval VisiblePart::clip(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  Interval part{0.0, 1.0};
  for (int i = 0; i < 4; ++i) {
    const double begin = borders_.row(i).head<2>().dot(from) + borders_(i, 2);
    const double end = borders_.row(i).head<2>().dot(to) + borders_(i, 2);
    if (begin < 0.0 && end < 0.0) return {0.0, 0.0};
    if (begin < 0.0) part.begin = std::max(part.begin, begin / (begin - end));
    if (end < 0.0) part.end = std::min(part.end, begin / (begin - end));
  }
  if (!view_.lens.is_distorted() || !(part.begin < part.end)) return part;
  return {farthest(from, to, part.begin, 0.0), farthest(from, to, part.end, 1.0)};
}

// The last visible point from a visible point of a line towards one of its ends, by bisection.
double VisiblePart::farthest(const Eigen::Vector2d& from,
                             const Eigen::Vector2d& to,
                             double inside,
                             double end) const {
  if (inside == end || has(from + end * (to - from))) return end;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (inside + end);
    (has(from + middle * (to - from)) ? inside : end) = middle;
  }
  return inside;
}

}  // namespace ellipse
