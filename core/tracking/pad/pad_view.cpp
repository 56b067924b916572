// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace ellipse {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::optional<ProjectedPoint> PadView::at(const Vector2d& pad_point) const {
  const Eigen::Matrix3d& h = ideal_from_pad;
  const Vector3d projected = h * pad_point.homogeneous();
  if (!is_in_front(projected)) return std::nullopt;
  ProjectedPoint result;
  result.point = projected.hnormalized();
  result.slope =
      (h.topLeftCorner<2, 2>() - result.point * h.bottomLeftCorner<1, 2>()) / projected.z();
  if (!lens.is_distorted()) return result;
  const auto shown = lens.picture_from_ideal(result.point);
  if (!shown) return std::nullopt;
  return ProjectedPoint{shown->picture_px, shown->slope * result.slope};
}

double PadView::radius_px() const {
  const double ideal_px = std::sqrt(std::abs(ideal_from_pad.topLeftCorner<2, 2>().determinant()));
  if (!lens.is_distorted()) return ideal_px;
  const auto middle = lens.picture_from_ideal(ideal_from_pad.col(2).hnormalized());
  return middle ? ideal_px * std::sqrt(std::abs(middle->slope.determinant())) : ideal_px;
}

}  // namespace ellipse
