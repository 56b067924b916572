// SPDX-License-Identifier: MIT
#include "core/tracking/pad/coarse_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/ellipse.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kCells = 64;       // side of the patch
constexpr double kExtent = 2.4;  // half width of the patch [radii]
constexpr double kCell = 2.0 * kExtent / kCells;
constexpr double kRadius = 1.0 / kCell;  // of the outer circle [cells]
constexpr int kMaxShift = static_cast<int>((kExtent - 1.0) * kRadius);
constexpr int kAngles = 32;  // points of a circle
constexpr std::array<double, 3> kSizes = {0.88, 1.0, 1.14};
constexpr double kSaturation = 0.6;   // of gradients, share of the outer circle's contrast
constexpr std::size_t kFewer = 6;     // point stride of the preliminary test
constexpr double kWorthwhile = 0.4;   // min share of the best score in that test
constexpr double kFarPenalty = 0.15;  // share of the score lost at a shift of kMaxShift
constexpr double kMinScore = 0.3;     // agreement, 0 to 1
constexpr int kMinVisible = 6;        // points of a circle

struct CellGradient {
  float x = 0.0F;
  float y = 0.0F;
};

// A point on a circle relative to its centre, and the unit normal towards its bright side.
struct TemplatePoint {
  int x;
  int y;
  float nx;
  float ny;
};
using Template = std::array<TemplatePoint, kAngles>;

Template circle_template(double radius_cells, bool is_bright_outside) {
  Template points;
  for (int k = 0; k < kAngles; ++k) {
    const double angle = kTwoPi * k / kAngles;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double sign = is_bright_outside ? 1.0 : -1.0;
    points[static_cast<std::size_t>(k)] = {static_cast<int>(std::lround(radius_cells * c)),
                                           static_cast<int>(std::lround(radius_cells * s)),
                                           static_cast<float>(sign * c),
                                           static_cast<float>(sign * s)};
  }
  return points;
}

class Patch {
 public:
  Patch(const ImageView& luma, const ProjectedPoint& middle, double contrast) {
    const Eigen::Vector2d right = kCell * middle.slope.col(0);
    const Eigen::Vector2d down = kCell * middle.slope.col(1);
    const Eigen::Vector2d first = middle.point - 0.5 * (kCells - 1) * (right + down);
    std::array<float, std::size_t(kCells) * kCells> levels;
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const Eigen::Vector2d at = first + i * right + j * down;
        const bool is_inside =
            at.x() >= 0.0 && at.y() >= 0.0 && at.x() < luma.width - 1 && at.y() < luma.height - 1;
        levels[index(i, j)] =
            is_inside ? luma.at(static_cast<float>(at.x()), static_cast<float>(at.y())) : kOutside;
      }
    }
    const auto saturation = static_cast<float>(kSaturation * contrast);
    for (int j = 1; j + 1 < kCells; ++j) {
      for (int i = 1; i + 1 < kCells; ++i) {
        const float left = levels[index(i - 1, j)];
        const float beyond = levels[index(i + 1, j)];
        const float above = levels[index(i, j - 1)];
        const float below = levels[index(i, j + 1)];
        is_known_[index(i, j)] = left >= 0.0F && beyond >= 0.0F && above >= 0.0F && below >= 0.0F;
        if (!is_known_[index(i, j)]) continue;
        const float x = beyond - left;
        const float y = below - above;
        const float scale = 1.0F / std::max(saturation, std::sqrt(x * x + y * y));
        gradients_[index(i, j)] = {x * scale, y * scale};
      }
    }
  }

  // Mean agreement of a circle around a cell, 0 to 1, less if few of its points are visible; 0 if
  // too few are.
  // @param step  Stride over its points.
  [[nodiscard]] double agreement(const Template& circle, int x, int y, std::size_t step = 1) const {
    float sum = 0.0F;
    int visible = 0;
    const int min_visible = std::max(1, kMinVisible / static_cast<int>(step));
    for (std::size_t k = 0; k < circle.size(); k += step) {
      const TemplatePoint& point = circle[k];
      const int i = x + point.x;
      const int j = y + point.y;
      if (i < 1 || j < 1 || i + 1 >= kCells || j + 1 >= kCells || !is_known_[index(i, j)]) continue;
      ++visible;
      const CellGradient& g = gradients_[index(i, j)];
      sum += std::max(0.0F, g.x * point.nx + g.y * point.ny);
    }
    return visible >= min_visible ? static_cast<double>(sum) / (visible + min_visible) : 0.0;
  }

 private:
  static constexpr float kOutside = -1.0F;
  static std::size_t index(int i, int j) {
    const int cell = j * kCells + i;
    return static_cast<std::size_t>(cell);
  }

  std::array<CellGradient, std::size_t(kCells) * kCells> gradients_{};
  std::array<bool, std::size_t(kCells) * kCells> is_known_{};
};

}  // namespace

std::optional<Eigen::Matrix3d> coarse_search(const ImageView& luma,
                                             const PadModel& model,
                                             const PadView& view) {
  const auto middle = view.at({0.0, 0.0});
  if (!middle) return std::nullopt;
  const Patch patch(luma, *middle, model.circles.front().contrast);
  const bool has_ring =
      model.circles.size() > 1 && (1.0 - model.circles[1].radius) * kRadius >= 1.5;
  double best = kMinScore;
  std::optional<Eigen::Matrix3d> found;
  for (const double size : kSizes) {
    const Template outer = circle_template(size * kRadius, model.circles.front().is_bright_outside);
    const Template inner = has_ring ? circle_template(size * kRadius * model.circles[1].radius,
                                                      model.circles[1].is_bright_outside)
                                    : outer;
    for (int dy = -kMaxShift; dy <= kMaxShift; ++dy) {
      for (int dx = -kMaxShift; dx <= kMaxShift; ++dx) {
        const int x = kCells / 2 + dx;
        const int y = kCells / 2 + dy;
        if (patch.agreement(outer, x, y, kFewer) <= kWorthwhile * best) continue;
        double score = patch.agreement(outer, x, y);
        if (score <= 0.5 * best) continue;
        if (has_ring) score = 0.5 * (score + std::min(score, patch.agreement(inner, x, y)));
        score *= 1.0 - kFarPenalty * std::hypot(dx, dy) / kMaxShift;
        if (score <= best) continue;
        best = score;
        Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
        change.topLeftCorner<2, 2>() *= size;
        change(0, 2) = kCell * (dx + 0.5);
        change(1, 2) = kCell * (dy + 0.5);
        found = view.ideal_from_pad * change;
      }
    }
  }
  return found;
}

}  // namespace ellipse
