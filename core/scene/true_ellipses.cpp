// SPDX-License-Identifier: MIT
#include "core/scene/true_ellipses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// The views of a sheet in a frame: one, or one for each of two fields.
struct ViewedSheet {
  SheetPicture picture;
  std::vector<SheetView> views;
};

// The error of the fitted ellipse is far below .01 px.
constexpr int kSamples = 180;
constexpr int kFitSteps = 4;
constexpr std::size_t kMinVisibleSamples = 2;

std::vector<double> field_times(const Scene& scene, double time_s) {
  const double half_s = 0.5 * scene.sensor.field_s;
  if (half_s == 0.0) return {time_s};
  return {time_s - half_s, time_s + half_s};
}

// The pad's edges. They occlude nothing, since inner ones are on the same paint.
Sheet edges_of(const Pad& pad) {
  Sheet sheet;
  for (const double radius : edge_radii(pad)) {
    Shape& shape = sheet.shapes.emplace_back();
    shape.sheet_from_shape.scale(radius);
    shape.paint.opacity = 0.0;
    shape.is_listed = true;
    shape.is_target = radius == 1.0;
  }
  return sheet;
}

// First the pad, then the scene's sheets.
std::vector<ViewedSheet> look_at_all(const Scene& scene, const Camera& camera, double time_s) {
  std::vector<ViewedSheet> all;
  std::vector<Sheet> sheets{edges_of(scene.pad)};
  sheets.insert(sheets.end(), scene.sheets.begin(), scene.sheets.end());
  for (const Sheet& sheet : sheets) {
    ViewedSheet& viewed =
        all.emplace_back(ViewedSheet{SheetPicture(sheet, scene.sensor.blur_px), {}});
    for (const double at_s : field_times(scene, time_s)) {
      if (const auto view = view_of(sheet, scene, camera, at_s)) viewed.views.push_back(*view);
    }
  }
  return all;
}

// The share of an outline inside the frame that no sheet hides.
class Visibility {
 public:
  Visibility(const Camera& camera, const std::vector<ViewedSheet>& viewed)
      : camera_(camera), lens_(camera), viewed_(viewed) {}

  // Hidden by a sheet's shapes from `shape` on, and by all later sheets.
  [[nodiscard]] double of(const std::vector<Vector2d>& outline,
                          std::size_t sheet,
                          std::size_t shape) const {
    double total = 0.0;
    double visible = 0.0;
    std::size_t samples = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d& next = outline[(i + 1) % outline.size()];
      const double length = (next - outline[i]).norm();
      total += length;
      if (!is_in_frame(outline[i]) || is_hidden(outline[i], sheet, shape)) continue;
      visible += length;
      ++samples;
    }
    return total > 0.0 && samples >= kMinVisibleSamples ? visible / total : 0.0;
  }

 private:
  [[nodiscard]] bool is_in_frame(const Vector2d& ideal) const {
    Vector2d px = ideal;
    if (camera_.is_distorted()) {
      const auto point = lens_.picture_from_ideal(ideal);
      if (!point) return false;
      px = point->picture_px;
    }
    return is_in_picture(px, camera_.width, camera_.height);
  }

  [[nodiscard]] bool is_hidden(const Vector2d& px, std::size_t sheet, std::size_t shape) const {
    for (std::size_t i = sheet; i < viewed_.size(); ++i) {
      if (viewed_[i].views.empty()) continue;
      const std::size_t from = i == sheet ? shape : 0;
      if (viewed_[i].picture.hides(viewed_[i].views.front(), px, from)) return true;
    }
    return false;
  }

  const Camera& camera_;
  Lens lens_;
  const std::vector<ViewedSheet>& viewed_;
};

// Points of a shape's outline in the frame; empty if a part of it is not in front of the camera.
std::vector<Vector2d> outline_of(const ViewedSheet& viewed, std::size_t shape, double factor) {
  std::vector<Vector2d> points;
  for (const SheetView& view : viewed.views) {
    for (int i = 0; i < kSamples; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSamples;
      const auto px = viewed.picture.outline_at(view, shape, factor, angle);
      if (!px) return {};
      points.push_back(*px);
    }
  }
  return points;
}

// The least-squares ellipse and its largest distance.
std::optional<TrueEllipse> best_fit(const std::vector<Vector2d>& outline) {
  std::optional<Ellipse> ellipse = fit_ellipse(outline);
  for (int i = 0; i < kFitSteps && ellipse; ++i) {
    GeometricFit fit(*ellipse);
    for (const Vector2d& point : outline) fit.add(point);
    ellipse = fit.solve();
  }
  if (!ellipse) return std::nullopt;
  TrueEllipse result{*ellipse};
  for (const Vector2d& point : outline) {
    result.deviation_px =
        std::max(result.deviation_px, std::abs(sampson_distance(*ellipse, point)));
  }
  return result;
}

bool is_exact(const ViewedSheet& viewed, const Shape& shape) {
  return shape.outline == Outline::kEllipse && viewed.picture.sheet().folds.empty() &&
         viewed.views.size() == 1 && !viewed.views.front().is_rolling();
}

std::optional<TrueEllipse> true_ellipse(const ViewedSheet& viewed,
                                        const Shape& shape,
                                        double factor,
                                        const std::vector<Vector2d>& outline) {
  if (!is_exact(viewed, shape)) return best_fit(outline);
  const Matrix3d image_from_shape =
      viewed.views.front().sheet_from_image.inverse() * shape.sheet_from_shape.matrix();
  const auto ellipse = project_circle(image_from_shape, factor);
  return ellipse ? std::optional(TrueEllipse{*ellipse}) : std::nullopt;
}

void add_sheet(const std::vector<ViewedSheet>& all,
               std::size_t sheet,
               const Visibility& visibility,
               std::vector<TrueEllipse>& found) {
  const std::vector<Shape>& shapes = all[sheet].picture.sheet().shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].is_listed) continue;
    for (const double factor : {1.0, shapes[i].hole}) {
      if (!(factor > 0.0)) continue;
      const std::vector<Vector2d> outline = outline_of(all[sheet], i, factor);
      if (outline.empty()) continue;
      auto ellipse = true_ellipse(all[sheet], shapes[i], factor, outline);
      if (!ellipse) continue;
      ellipse->visible_fraction = visibility.of(outline, sheet, i + 1);
      ellipse->is_target = shapes[i].is_target && factor == 1.0;
      found.push_back(*ellipse);
    }
  }
}

}  // namespace

std::vector<TrueEllipse> true_ellipses(
    const Scene& scene, double time_s, int width, int height, double min_semi_minor_px) {
  const Camera camera = camera_of(scene, width, height);
  const std::vector<ViewedSheet> viewed = look_at_all(scene, camera, time_s);
  const Visibility visibility(camera, viewed);
  std::vector<TrueEllipse> found;
  add_sheet(viewed, 0, visibility, found);
  for (TrueEllipse& edge : found)
    edge.deviation_px += scene.pad.deformation * edge.ellipse.semi_major;
  for (std::size_t i = 1; i < viewed.size(); ++i) add_sheet(viewed, i, visibility, found);
  std::erase_if(found, [&](const TrueEllipse& e) {
    return !(e.visible_fraction > 0.0) || !(e.ellipse.semi_minor >= min_semi_minor_px);
  });
  std::stable_sort(found.begin(), found.end(), [](const TrueEllipse& a, const TrueEllipse& b) {
    if (a.is_target != b.is_target) return a.is_target;
    return a.ellipse.semi_major > b.ellipse.semi_major;
  });
  return found;
}

Truth target_of(std::span<const TrueEllipse> ellipses) {
  if (ellipses.empty() || !ellipses.front().is_target) return {};
  Truth truth;
  truth.outer_edge = ellipses.front().ellipse;
  truth.visible_fraction = ellipses.front().visible_fraction;
  return truth;
}

}  // namespace ellipse
