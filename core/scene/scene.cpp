// SPDX-License-Identifier: MIT
#include "core/scene/scene.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ellipse {
namespace {

using Eigen::Vector2d;

// Distance of the picture's border from the middle at focal length 1.
double border_x(const Distortion& distortion, double hfov_rad) {
  Camera unit{.width = 1, .height = 1, .fx = 1.0, .fy = 1.0};
  unit.lens = distortion.model;
  unit.distortion = distortion.coefficients;
  const Lens lens(unit);
  const double ideal = std::tan(0.5 * hfov_rad);
  const auto left = lens.picture_from_ideal({-ideal, 0.0});
  const auto right = lens.picture_from_ideal({ideal, 0.0});
  if (!(hfov_rad > 0.0) || !left || !right) {
    throw std::invalid_argument("hfov_rad: the lens does not cover this field of view");
  }
  return 0.5 * (right->picture_px.x() - left->picture_px.x());
}

// An outline distorted by the lens.
class DistortedOutline {
 public:
  DistortedOutline(const Camera& camera, const Ellipse& ideal)
      : lens_(camera), ideal_(ideal), middle_(camera.cx, camera.cy) {}

  [[nodiscard]] double share_in_frame() {
    constexpr int kPieces = 64;
    Sample begin = at(0.0);
    for (int i = 1; i <= kPieces; ++i) {
      const Sample end = at(2.0 * std::numbers::pi * i / kPieces);
      add(begin, end, kMaxHalvings);
      begin = end;
    }
    return total_ > 0.0 ? inside_ / total_ : 0.0;
  }

 private:
  static constexpr int kMaxHalvings = 16;

  struct Sample {
    double anomaly_rad;
    Vector2d picture_px;
    bool is_shown;
  };

  [[nodiscard]] Sample at(double anomaly_rad) const {
    const Vector2d ideal = ideal_.point_at(anomaly_rad);
    if (const auto point = lens_.picture_from_ideal(ideal)) {
      return {anomaly_rad, point->picture_px, true};
    }
    return {anomaly_rad, end_towards(ideal), false};
  }

  // Image of the last point inside the lens's range, on the line from the middle to this point.
  [[nodiscard]] Vector2d end_towards(const Vector2d& ideal) const {
    constexpr int kHalvings = 30;
    double shown = 0.0;
    double hidden = 1.0;
    Vector2d picture_px = middle_;
    for (int i = 0; i < kHalvings; ++i) {
      const double share = 0.5 * (shown + hidden);
      const auto point = lens_.picture_from_ideal(middle_ + share * (ideal - middle_));
      if (point) picture_px = point->picture_px;
      (point ? shown : hidden) = share;
    }
    return picture_px;
  }

  // Bisects, since evenly spaced anomalies are unevenly spaced in the picture of a wide lens.
  void add(const Sample& begin, const Sample& end, int halvings) {
    const double length = (end.picture_px - begin.picture_px).norm();
    if (length > 1.0 && halvings > 0) {
      const Sample middle = at(0.5 * (begin.anomaly_rad + end.anomaly_rad));
      add(begin, middle, halvings - 1);
      add(middle, end, halvings - 1);
      return;
    }
    total_ += length;
    if (begin.is_shown && end.is_shown && is_in_frame(end.picture_px)) inside_ += length;
  }

  [[nodiscard]] bool is_in_frame(const Vector2d& p) const {
    const Camera& camera = lens_.camera();
    return is_in_picture(p, camera.width, camera.height);
  }

  Lens lens_;
  Ellipse ideal_;
  Vector2d middle_;
  double inside_ = 0.0;
  double total_ = 0.0;
};

}  // namespace

Camera camera_of(const Scene& scene, int width, int height) {
  Camera camera = Camera::with_hfov(scene.hfov_rad, width, height);
  if (!scene.lens) return camera;
  camera.lens = scene.lens->model;
  camera.distortion = scene.lens->coefficients;
  camera.fx = camera.fy = 0.5 * width / border_x(*scene.lens, scene.hfov_rad);
  return camera;
}

Truth truth_of(const Pad& pad, const Eigen::Matrix3d& image_from_pad, int width, int height) {
  Camera pinhole;
  pinhole.width = width;
  pinhole.height = height;
  return truth_of(pad, image_from_pad, pinhole);
}

Truth truth_of(const Pad& pad, const Eigen::Matrix3d& image_from_pad, const Camera& camera) {
  Truth truth;
  if (pad.pattern == Pattern::kNone) return truth;
  truth.outer_edge = project_circle(image_from_pad, 1.0);
  if (!truth.outer_edge) return truth;
  truth.visible_fraction = share_in_frame(*truth.outer_edge, camera);
  if (const auto radius = inner_radius(pad)) {
    truth.inner_edge = project_circle(image_from_pad, *radius);
  }
  return truth;
}

double share_in_frame(const Ellipse& ideal, const Camera& camera) {
  return camera.is_distorted() ? DistortedOutline(camera, ideal).share_in_frame()
                               : visible_fraction(ideal, camera.width, camera.height);
}

std::optional<SheetView> view_of(const Sheet& sheet,
                                 const Scene& scene,
                                 const Camera& camera,
                                 double time_s) {
  const auto sheet_from_image = [&](double at_s) -> std::optional<Eigen::Matrix3d> {
    const Eigen::Matrix3d pad = image_from_pad(pose_at(scene.flight, at_s), camera);
    const auto image = image_from_sheet(sheet, pad, camera, at_s);
    return image ? std::optional<Eigen::Matrix3d>(image->inverse()) : std::nullopt;
  };
  const double half_s = 0.5 * scene.sensor.readout_s;
  const auto first = sheet_from_image(time_s - half_s);
  if (!first || half_s == 0.0 || camera.height < 2) {
    return first ? std::optional(SheetView{*first}) : std::nullopt;
  }
  const auto last = sheet_from_image(time_s + half_s);
  if (!last) return std::nullopt;
  return SheetView{*first, (*last - *first) / (camera.height - 1)};
}

Eigen::Matrix3d image_from_pad(const Scene& scene, double time_s, int width, int height) {
  return image_from_pad(pose_at(scene.flight, time_s), camera_of(scene, width, height));
}

}  // namespace ellipse
