// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace ellipse {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::optional<ProjectedPoint> PadView::at(const Vector2d& pad_point) const {
  const auto ideal = project_point(ideal_from_pad, pad_point);
  if (!ideal || !lens.is_distorted()) return ideal;
  const auto shown = lens.picture_from_ideal(ideal->point);
  if (!shown) return std::nullopt;
  return ProjectedPoint{shown->picture_px, shown->slope * ideal->slope};
}

double PadView::radius_px() const {
  const double ideal_px = std::sqrt(std::abs(ideal_from_pad.topLeftCorner<2, 2>().determinant()));
  if (!lens.is_distorted()) return ideal_px;
  const auto middle = lens.picture_from_ideal(ideal_from_pad.col(2).hnormalized());
  return middle ? ideal_px * std::sqrt(std::abs(middle->slope.determinant())) : ideal_px;
}

}  // namespace ellipse
