// SPDX-License-Identifier: MIT
#include "core/scene/sheet_picture.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/scene/edge.hpp"
#include "core/scene/random.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kBlock = 8;          // pixels
constexpr double kMargin = 1.3;    // largest ratio of scales within a block
constexpr double kOpaque = 0.5;    // smallest opacity at which a shape hides others
constexpr double kAmbient = 0.35;  // light on the shaded side of a ball

// Random in [-1, 1] at the corners of a lattice, smooth between them [Perlin1985].
double lattice_noise(const Vector2d& at, std::uint64_t seed) {
  const double fx = std::floor(at.x());
  const double fy = std::floor(at.y());
  const auto corner = [&](int dx, int dy) {
    const auto x = static_cast<std::uint64_t>(static_cast<std::int64_t>(fx) + dx);
    const auto y = static_cast<std::uint64_t>(static_cast<std::int64_t>(fy) + dy);
    const std::uint64_t bits = hash(seed + x * 0x9e3779b97f4a7c15U + y * 0xc2b2ae3d27d4eb4fU);
    return static_cast<double>(bits >> 11U) / static_cast<double>(1ULL << 52U) - 1.0;
  };
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = smooth(at.x() - fx);
  const double v = smooth(at.y() - fy);
  return std::lerp(
      std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

Patch cut(const Patch& a, int left, int top, int right, int bottom) {
  Patch cut = a;
  cut.left = std::max(a.left, left);
  cut.top = std::max(a.top, top);
  cut.width = std::max(0, std::min(a.left + a.width, right) - cut.left);
  cut.height = std::max(0, std::min(a.top + a.height, bottom) - cut.top);
  return cut;
}

float* row_of(const LightImage& image, int left, int y) {
  return &image.light[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(left)];
}

void mix(float& light, double share, double level) {
  light += static_cast<float>(share * (level - light));
}

// The exact edges of a disc or a ring.
class RoundEdges {
 public:
  RoundEdges(const Matrix3d& shape_from_image, const Shape& shape)
      : outer_(shape_from_image, 1.0), softness_(shape.softness) {
    if (shape.hole > 0.0) inner_.emplace(shape_from_image, shape.hole);
  }

  [[nodiscard]] double coverage(const Vector2d& px,
                                const Matrix2d& at_shape_per_px,
                                double blur_px) const {
    double blur = blur_px;
    if (softness_ > 0.0) {
      const double soft_px = softness_ / std::sqrt(std::abs(at_shape_per_px.determinant()));
      blur = std::sqrt(blur * blur + soft_px * soft_px);
    }
    const double share = outer_.coverage(px, blur);
    return inner_ && share > 0.0 ? share - inner_->coverage(px, blur) : share;
  }

 private:
  CircularEdge outer_;
  std::optional<CircularEdge> inner_;
  double softness_;
};

}  // namespace

struct SheetPicture::Sample {
  Vector2d on_sheet;         // the visible point of the sheet
  Vector2d at_shape;         // in the shape's frame
  Matrix2d at_shape_per_px;  // its derivative by the picture's pixels
  bool is_in_front = false;

  Sample(
      const SheetPicture& picture, std::size_t shape, const SheetView& view, double x, double y) {
    const Vector3d px(x, y, 1.0);
    const Matrix3d m = view.at_row(y);
    const Vector3d q = m * px;
    const Vector3d per_y = m.col(1) + view.per_row * px;
    // Within the blur's reach of the sheet's horizon, distances are not linear in pixels.
    const double horizon = (kStepReach * picture.blur_px_ + 1.0) * std::hypot(m(2, 0), per_y.z());
    is_in_front = q.z() > horizon;
    if (!is_in_front) return;
    on_sheet = q.hnormalized();
    Matrix2d per_px;
    per_px << (m.block<2, 1>(0, 0) - on_sheet * m(2, 0)), (per_y.head<2>() - on_sheet * per_y.z());
    const Eigen::Affine2d& to_shape = picture.shape_from_sheet_[shape];
    if (picture.deformation_.is_flat()) {
      at_shape = to_shape * on_sheet;
      at_shape_per_px = to_shape.linear() * per_px / q.z();
    } else {
      at_shape = to_shape * picture.deformation_.pattern_at(on_sheet);
      at_shape_per_px =
          to_shape.linear() * picture.deformation_.slope_at(on_sheet) * per_px / q.z();
    }
  }
};

SheetPicture::SheetPicture(const Sheet& sheet, double lens_blur_px)
    : sheet_(sheet),
      blur_px_(std::hypot(lens_blur_px, sheet.defocus_px)),
      deformation_(sheet.folds) {
  for (const Shape& shape : sheet_.shapes) {
    edges_.emplace_back(shape);
    shape_from_sheet_.push_back(shape.sheet_from_shape.inverse());
  }
}

Vector2d SheetPicture::to_shape(std::size_t shape, const Vector2d& on_sheet) const {
  return shape_from_sheet_[shape] * deformation_.pattern_at(on_sheet);
}

// Whether CircularEdge renders the shape exactly.
bool SheetPicture::is_exact(std::size_t shape) const {
  return sheet_.shapes[shape].outline == Outline::kEllipse && deformation_.is_flat();
}

void SheetPicture::paint(const SheetView& view, const Patch& patch, const LightImage& image) const {
  for (std::size_t i = 0; i < sheet_.shapes.size(); ++i) {
    const Patch part = bounds(view, i, patch);
    if (part.width > 0 && part.height > 0) paint_shape(i, view, part, image);
  }
}

// The part of a patch that the shape may cover.
Patch SheetPicture::bounds(const SheetView& view, std::size_t shape, const Patch& patch) const {
  const double extent = edges_[shape].extent();
  if (!std::isfinite(extent) || patch.width <= kBlock) return patch;
  const double reach = extent + kStepReach * sheet_.shapes[shape].softness;
  const double shift = deformation_.max_shift();
  Vector2d low = Vector2d::Constant(1e9);
  Vector2d high = -low;
  const int parts = view.is_rolling() ? 2 : 0;
  for (int part = 0; part <= parts; ++part) {
    const Matrix3d image_from_sheet = view.at_row(patch.top + 0.5 * part * patch.height).inverse();
    for (int corner = 0; corner < 4; ++corner) {
      const Vector2d sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0);
      const Vector2d at = sheet_.shapes[shape].sheet_from_shape * Vector2d(reach * sign);
      for (const double sx : {-shift, shift}) {
        for (const double sy : {-shift, shift}) {
          const Vector3d q = image_from_sheet * (at + Vector2d(sx, sy)).homogeneous();
          if (!(q.z() > 1e-6)) return patch;
          low = low.cwiseMin(q.hnormalized());
          high = high.cwiseMax(q.hnormalized());
        }
      }
    }
  }
  const double rim = kStepReach * blur_px_ + 1.0;
  const auto whole = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
  return cut(patch,
             whole(std::floor(low.x() - rim)),
             whole(std::floor(low.y() - rim)),
             whole(std::ceil(high.x() + rim)) + 1,
             whole(std::ceil(high.y() + rim)) + 1);
}

void SheetPicture::paint_shape(std::size_t shape,
                               const SheetView& view,
                               const Patch& patch,
                               const LightImage& image) const {
  const Paint& paint = sheet_.shapes[shape].paint;
  const bool is_plain = paint.texture == 0.0 && paint.slope.isZero(0.0) &&
                        paint.lit_from.isZero(0.0) && deformation_.is_flat();
  for (int top = patch.top; top < patch.top + patch.height; top += kBlock) {
    for (int left = patch.left; left < patch.left + patch.width; left += kBlock) {
      const Patch block = cut(patch, left, top, left + kBlock, top + kBlock);
      const std::optional<double> share = even_coverage(shape, view, block);
      if (share && *share <= 0.0) continue;
      if (!share || !is_plain) {
        paint_block(shape, view, block, share.has_value(), image);
        continue;
      }
      for (int y = top; y < top + block.height; ++y) {
        float* row = row_of(image, left, y);
        for (int x = 0; x < block.width; ++x) mix(row[x], *share * paint.opacity, paint.level);
      }
    }
  }
}

// nullopt if the coverage may vary within the block.
std::optional<double> SheetPicture::even_coverage(std::size_t shape,
                                                  const SheetView& view,
                                                  const Patch& block) const {
  const double x = block.left + 0.5 * (block.width - 1);
  const double y = block.top + 0.5 * (block.height - 1);
  const Vector3d middle = view.at_row(y) * Vector3d(x, y, 1.0);
  if (!(middle.z() > 0.0)) return std::nullopt;
  const Vector2d at = to_shape(shape, middle.hnormalized());
  double half = 0.0;
  for (const double sx : {-0.5, 0.5}) {
    for (const double sy : {-0.5, 0.5}) {
      const Vector2d corner(x + sx * block.width, y + sy * block.height);
      const Vector3d q = view.at_row(corner.y()) * corner.homogeneous();
      if (!(q.z() > 0.0)) return std::nullopt;
      half = std::max(half, (to_shape(shape, q.hnormalized()) - at).norm());
    }
  }
  half *= kMargin;
  const double half_px = 0.5 * std::hypot(block.width, block.height);
  const double softness = sheet_.shapes[shape].softness;
  // Uses the longest direction of a pixel's footprint, which a cut block may not contain.
  const double per_px = half / std::min(half_px, 0.5 * std::min(block.width, block.height));
  const double reach = half + kStepReach * std::hypot(blur_px_ * per_px, softness);
  const double clearance = edges_[shape].clearance(at);
  if (std::abs(clearance) <= reach) return std::nullopt;
  return clearance < 0.0 ? 1.0 : 0.0;
}

void SheetPicture::paint_block(std::size_t shape,
                               const SheetView& view,
                               const Patch& block,
                               bool is_covered,
                               const LightImage& image) const {
  const double opacity = sheet_.shapes[shape].paint.opacity;
  std::optional<RoundEdges> edges;
  for (int y = block.top; y < block.top + block.height; ++y) {
    const bool is_new_view = y == block.top || view.is_rolling();
    if (!is_covered && is_exact(shape) && is_new_view) {
      const Matrix3d shape_from_image = shape_from_sheet_[shape].matrix() * view.at_row(y);
      edges.emplace(shape_from_image, sheet_.shapes[shape]);
    }
    float* row = row_of(image, block.left, y);
    for (int x = 0; x < block.width; ++x) {
      const Sample sample(*this, shape, view, block.left + x, y);
      if (!sample.is_in_front) continue;
      double share = 1.0;
      if (edges) {
        share = edges->coverage(Vector2d(block.left + x, y), sample.at_shape_per_px, blur_px_);
      } else if (!is_covered) {
        share = edges_[shape].coverage(sample.at_shape, sample.at_shape_per_px, blur_px_);
      }
      if (share > 0.0) mix(row[x], share * opacity, paint_at(shape, sample));
    }
  }
}

double SheetPicture::paint_at(std::size_t shape, const Sample& sample) const {
  const Shape& what = sheet_.shapes[shape];
  double level = what.paint.level;
  level *= std::max(0.0, 1.0 + what.paint.slope.dot(sample.at_shape));
  if (!what.paint.lit_from.isZero(0.0)) {
    const double z = std::sqrt(std::max(0.0, 1.0 - sample.at_shape.squaredNorm()));
    const Vector3d normal(sample.at_shape.x(), sample.at_shape.y(), z);
    level *= kAmbient + (1.0 - kAmbient) * std::max(0.0, normal.dot(what.paint.lit_from));
  }
  if (what.paint.texture > 0.0) {
    const Vector2d pattern = what.sheet_from_shape * sample.at_shape;
    level += what.paint.texture * lattice_noise(what.paint.grain * pattern, what.seed);
  }
  return deformation_.is_flat() ? level : level * deformation_.light_at(sample.on_sheet);
}

bool SheetPicture::hides(const SheetView& view, const Vector2d& px, std::size_t from) const {
  const Vector3d q = view.at_row(px.y()) * px.homogeneous();
  if (!(q.z() > 0.0)) return false;
  for (std::size_t i = from; i < edges_.size(); ++i) {
    const Shape& shape = sheet_.shapes[i];
    if (shape.paint.opacity < kOpaque) continue;
    const Vector2d at = to_shape(i, q.hnormalized());
    if (edges_[i].at(at).distance >= 0.0) continue;
    if (!(shape.hole > 0.0) || edges_[i].at(at / shape.hole).distance > 0.0) return true;
  }
  return false;
}

std::optional<Vector2d> SheetPicture::outline_at(const SheetView& view,
                                                 std::size_t shape,
                                                 double factor,
                                                 double angle_rad) const {
  const Vector2d pattern = sheet_.shapes[shape].sheet_from_shape *
                           Vector2d(factor * edges_[shape].outline_at(angle_rad));
  const Vector3d on_sheet = deformation_.deformed_at(pattern).homogeneous();
  // With a rolling shutter the row depends on the result; iterates, as views of rows differ little.
  const int steps = view.is_rolling() ? 8 : 1;
  Vector2d px(0.0, 0.0);
  for (int i = 0; i < steps; ++i) {
    const Vector3d q = view.at_row(px.y()).inverse() * on_sheet;
    if (!(q.z() > 0.0)) return std::nullopt;
    px = q.hnormalized();
  }
  return px;
}

}  // namespace ellipse
