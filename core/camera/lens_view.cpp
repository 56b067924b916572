// SPDX-License-Identifier: MIT
#include "core/camera/lens_view.hpp"

#include <Eigen/Geometry>
#include <array>
#include <limits>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kOutlinePoints = 96;  // samples of a distorted outline

bool is_shown(const Vector2d& point) {
  return point.allFinite();
}

// Calls use(i, point) for points at even anomalies around an ellipse.
template <class Use>
void for_each_point(const Ellipse& e, std::size_t count, const Use& use) {
  const double step = kTwoPi / static_cast<double>(count);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(step).toRotationMatrix();
  Eigen::Matrix2d axes = Eigen::Rotation2Dd(e.angle_rad).toRotationMatrix();
  axes.col(0) *= e.semi_major;
  axes.col(1) *= e.semi_minor;
  Vector2d anomaly(1.0, 0.0);
  for (std::size_t i = 0; i < count; ++i, anomaly = turn * anomaly) {
    use(i, e.center() + axes * anomaly);
  }
}

// Fits an ellipse to the mapped points of another; `map` returns nullopt for points out of range.
template <class Map>
std::optional<Ellipse> mapped(const Ellipse& e, std::size_t min_points, const Map& map) {
  std::optional<Moments> moments;
  std::size_t count = 0;
  for_each_point(e, kOutlinePoints, [&](std::size_t, const Vector2d& from) {
    const std::optional<Vector2d> point = map(from);
    if (!point) return;
    if (!moments) moments.emplace(*point);
    moments->add(*point);
    ++count;
  });
  return moments && count >= min_points ? fit_ellipse(*moments) : std::nullopt;
}

}  // namespace

LensView::LensView(const Lens& lens) : lens_(lens.camera().is_distorted() ? &lens : nullptr) {}

LensView LensView::part(const Vector2d& origin_px) const {
  LensView view = *this;
  view.origin_px_ = in_frame(origin_px);
  return view;
}

LensView LensView::reduced(int scale) const {
  LensView view = *this;
  view.origin_px_ = in_frame(Vector2d::Constant(0.5 * (scale - 1)));
  view.scale_ = scale_ * scale;
  return view;
}

std::optional<LensPoint> LensView::picture_from_ideal(const Vector2d& ideal_px) const {
  if (!is_distorted()) return LensPoint{ideal_px, Eigen::Matrix2d::Identity()};
  auto point = lens_->picture_from_ideal(in_frame(ideal_px));
  if (point) point->picture_px = in_picture(point->picture_px);
  return point;
}

std::optional<Vector2d> LensView::ideal_from_picture(const Vector2d& picture_px) const {
  if (!is_distorted()) return picture_px;
  const auto point = lens_->ideal_from_picture(in_frame(picture_px));
  return point ? std::optional(in_picture(*point)) : std::nullopt;
}

void LensView::distort(const Vector2d& origin_px, const CurveSamples& samples) const {
  if (is_distorted()) lens_->distort(in_frame(origin_px), scale_, samples);
}

Vector2d LensView::approximate_ideal(const Vector2d& picture_px) const {
  return is_distorted() ? in_picture(lens_->approximate_ideal(in_frame(picture_px))) : picture_px;
}

// Outside the lens's range a segment counts with the length of the last one inside.
double visible_fraction(const LensView& lens, const Ellipse& ideal, int width, int height) {
  if (!lens.is_distorted()) return visible_fraction(ideal, width, height);
  std::array<Vector2d, kOutlinePoints> points;
  distorted_outline(lens, ideal, points);
  double inside = 0.0;
  double total = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& from = points[i];
    const Vector2d& to = points[(i + 1) % points.size()];
    const Vector2d middle = 0.5 * (from + to);
    if (is_shown(middle)) length = (to - from).norm();
    total += length;
    if (is_in_picture(middle, width, height)) inside += length;
  }
  return total > 0.0 ? inside / total : 0.0;
}

void distorted_outline(const LensView& lens, const Ellipse& ideal, std::span<Vector2d> points_px) {
  for_each_point(ideal, points_px.size(), [&](std::size_t i, const Vector2d& ideal_px) {
    const auto point = lens.picture_from_ideal(ideal_px);
    points_px[i] =
        point ? point->picture_px : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  });
}

std::optional<Ellipse> distorted(const LensView& lens, const Ellipse& ideal) {
  if (!lens.is_distorted()) return ideal;
  return mapped(ideal, kOutlinePoints, [&](const Vector2d& point) {
    const auto shown = lens.picture_from_ideal(point);
    return shown ? std::optional(shown->picture_px) : std::nullopt;
  });
}

std::optional<Ellipse> undistorted(const LensView& lens, const Ellipse& in_picture) {
  if (!lens.is_distorted()) return in_picture;
  return mapped(in_picture, kOutlinePoints / 4, [&](const Vector2d& point) {
    return lens.ideal_from_picture(point);
  });
}

}  // namespace ellipse
