#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/scene/foreground.hpp"
#include "core/scene/sheet.hpp"

namespace ellipse {

/// A sheet in a view: paints its shapes and locates their outlines.
class SheetPicture {
 public:
  /// @param lens_blur_px  Standard deviation of the lens's blur.
  SheetPicture(const Sheet& sheet, double lens_blur_px);

  [[nodiscard]] const Sheet& sheet() const { return sheet_; }

  /// Paints the visible part of the sheet in a rectangle of the picture; ignores the patch's
  /// homography.
  void paint(const SheetView& view, const Patch& patch, const LightImage& image) const;

  /// Whether any shape from index `from` on hides the scene behind a point of the picture.
  [[nodiscard]] bool hides(const SheetView& view,
                           const Eigen::Vector2d& px,
                           std::size_t from) const;

  /// The outline of a shape, or of its hole, in the picture.
  /// @param factor  1, or Shape::hole.
  /// nullopt if its front side is not visible.
  [[nodiscard]] std::optional<Eigen::Vector2d> outline_at(const SheetView& view,
                                                          std::size_t shape,
                                                          double factor,
                                                          double angle_rad) const;

 private:
  struct Sample;  // a pixel's position on the sheet and the shape

  [[nodiscard]] Patch bounds(const SheetView& view, std::size_t shape, const Patch& patch) const;
  void paint_shape(std::size_t shape,
                   const SheetView& view,
                   const Patch& patch,
                   const LightImage& image) const;
  void paint_block(std::size_t shape,
                   const SheetView& view,
                   const Patch& block,
                   bool is_covered,
                   const LightImage& image) const;
  [[nodiscard]] std::optional<double> even_coverage(std::size_t shape,
                                                    const SheetView& view,
                                                    const Patch& block) const;
  [[nodiscard]] double paint_at(std::size_t shape, const Sample& sample) const;
  [[nodiscard]] Eigen::Vector2d to_shape(std::size_t shape, const Eigen::Vector2d& on_sheet) const;
  [[nodiscard]] bool is_exact(std::size_t shape) const;

  Sheet sheet_;
  double blur_px_;
  Deformation deformation_;
  std::vector<ShapeEdge> edges_;
  std::vector<Eigen::Affine2d> shape_from_sheet_;
};

}  // namespace ellipse
