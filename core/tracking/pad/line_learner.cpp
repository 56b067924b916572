// SPDX-License-Identifier: MIT
#include "core/tracking/pad/line_learner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kParts = 8;               // of a top view, one per frame
constexpr int kStraightPixels = 8;      // span of linear interpolation in the top view
constexpr double kStraightPx = 1.2;     // max distance of a line from its chord
constexpr double kMinLength = 0.1;      // [radii]
constexpr double kBesideCircle = 0.05;  // lines this close to a circle throughout are part of it
constexpr double kMaxRadius = 0.97;     // of a line's middle
constexpr double kShortened = 0.02;     // cut at both ends, where smoothing displaces the edge
constexpr std::size_t kCapacity = 4 * LineLearner::kMaxLines;  // before the longest are kept
constexpr std::size_t kMaximaOfChain = 10;  // nearly all have more; sizes a buffer

}  // namespace

void LineLearner::reserve(PadModel& model) {
  model.lines.reserve(kMaxLines);
  if (!pixels_.empty()) return;
  pixels_.assign(static_cast<std::size_t>(kSize) * kSize, 0);
  lines_.reserve(kCapacity);
  chains_.reserve(pixels_.size() / 4 / kMaximaOfChain + 8);
  map_.compute({pixels_.data(), kSize, kSize, kSize}, {1.0, 1.0});
  chains_.trace(map_);
}

// Pixels outside the image are 0, all others at least 1. Interpolates positions linearly over
// kStraightPixels.
void LineLearner::take(const ImageView& luma, const PadView& view) {
  static_assert(kSize % kStraightPixels == 0);
  constexpr float kBorder = 1.01F;  // the .01 covers rounding
  const float right = static_cast<float>(luma.width) - kBorder;
  const float bottom = static_cast<float>(luma.height) - kBorder;
  const int end = std::min(kSize, rows_ + kSize / kParts);
  for (; rows_ < end; ++rows_) {
    std::uint8_t* pixel = pixels_.data() + static_cast<std::ptrdiff_t>(rows_) * kSize;
    auto next = view.at(pad_point_of(0, rows_));
    for (int column = 0; column < kSize; column += kStraightPixels) {
      const auto here = next;
      next = view.at(pad_point_of(column + kStraightPixels, rows_));
      Eigen::Vector2f first(-1.0F, -1.0F);  // outside the image
      Eigen::Vector2f step(0.0F, 0.0F);
      if (here && next) {
        first = here->point.cast<float>();
        step = ((next->point - here->point) / kStraightPixels).cast<float>();
      }
      for (int i = 0; i < kStraightPixels; ++i) {
        const Eigen::Vector2f at = first + static_cast<float>(i) * step;
        const bool is_inside =
            at.x() >= 0.0F && at.y() >= 0.0F && at.x() < right && at.y() < bottom;
        *pixel++ = is_inside
                       ? static_cast<std::uint8_t>(std::max(1.0F, luma.at(at.x(), at.y()) + 0.5F))
                       : std::uint8_t{0};
      }
    }
  }
}

// Removes gradient maxima caused by the image border.
void LineLearner::clear_maxima_at_border() {
  const auto is_shown = [&](int x, int y) {
    const int pixel = y * kSize + x;
    return pixels_[static_cast<std::size_t>(pixel)] != 0;
  };
  constexpr int kNear = 3;  // radius of the gradient's kernel plus one pixel
  for (int y = kNear; y < kSize - kNear; ++y) {
    for (int x = kNear; x < kSize - kNear; ++x) {
      std::uint8_t& maximum = map_.maxima()[y * map_.stride() + x];
      if (maximum == 0) continue;
      bool is_inside = true;
      for (const int dy : {-kNear, 0, kNear}) {
        for (const int dx : {-kNear, 0, kNear}) is_inside &= is_shown(x + dx, y + dy);
      }
      if (!is_inside) maximum = 0;
    }
  }
}

Eigen::Vector2d LineLearner::pad_point_of(int column, int row) {
  return kPixel * (Eigen::Array2d(column, row) + 0.5) - 1.0;
}

Eigen::Vector2d LineLearner::pad_point_of(std::int32_t pixel) const {
  return pad_point_of(pixel % map_.stride(), pixel / map_.stride());
}

void LineLearner::learn(PadModel& model) {
  const ImageView above{pixels_.data(), kSize, kSize, kSize};
  const double min_gradient = kMinContrastShare * model.circles.front().contrast * kGradientOfStep;
  map_.compute(above, {min_gradient / kGradientGain, min_gradient / kGradientGain});
  clear_maxima_at_border();
  chains_.trace(map_);
  lines_.clear();
  for (std::size_t i = 0; i < chains_.size(); ++i) split(chains_.chain(i).pixels, model);
  keep_longest();
  model.lines = lines_;
}

void LineLearner::keep_longest() {
  std::sort(lines_.begin(), lines_.end(), [](const PadLine& a, const PadLine& b) {
    return (a.to - a.from).squaredNorm() > (b.to - b.from).squaredNorm();
  });
  lines_.resize(std::min(lines_.size(), kMaxLines));
}

// Splits at the pixel farthest from the chord until all are near it [DouglasPeucker1973].
void LineLearner::split(std::span<const std::int32_t> pixels, const PadModel& model) {
  const auto shortest = static_cast<std::size_t>(0.7 * kMinLength / kPixel);
  if (pixels.size() < shortest) return;
  const Eigen::Vector2d from = pad_point_of(pixels.front());
  const Eigen::Vector2d chord = pad_point_of(pixels.back()) - from;
  const Eigen::Vector2d across = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
  double farthest = kStraightPx * kPixel;
  std::size_t corner = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d beside = pad_point_of(pixels[i]) - from;
    const double distance = chord.norm() > kPixel ? std::abs(across.dot(beside)) : beside.norm();
    if (distance <= farthest) continue;
    farthest = distance;
    corner = i;
  }
  if (corner == 0) {
    add(pixels, model);
    return;
  }
  split(pixels.first(corner), model);
  split(pixels.subspan(corner), model);
}

void LineLearner::add(std::span<const std::int32_t> pixels, const PadModel& model) {
  const Eigen::Vector2d from = pad_point_of(pixels.front());
  const Eigen::Vector2d to = pad_point_of(pixels.back());
  const double length = (to - from).norm();
  if (length < kMinLength) return;
  const Eigen::Vector2d middle = 0.5 * (from + to);
  for (const PadCircle& circle : model.circles) {
    const auto is_beside = [&](const Eigen::Vector2d& point) {
      return std::abs(point.norm() - circle.radius) < kBesideCircle;
    };
    if (is_beside(from) && is_beside(middle) && is_beside(to)) return;
  }
  if (middle.norm() > kMaxRadius) return;

  const auto corner = std::min(pixels.size() / 4, static_cast<std::size_t>(kShortened / kPixel));
  const PadLine line = line_through(pixels.subspan(corner, pixels.size() - 2 * corner), from, to);
  if (line.contrast < kMinContrastShare * model.circles.front().contrast) return;
  if (lines_.size() == kCapacity) keep_longest();
  lines_.push_back(line);
}

// Fits the subpixel gradient maxima by total least squares; the contrast is that of the mean
// gradient.
PadLine LineLearner::line_through(std::span<const std::int32_t> pixels,
                                  const Eigen::Vector2d& from,
                                  const Eigen::Vector2d& to) const {
  const Eigen::Vector2d middle = 0.5 * (from + to);
  Eigen::Vector2d sum(0.0, 0.0);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient(0.0, 0.0);
  for (const std::int32_t pixel : pixels) {
    const Gradient* here = map_.gradients() + pixel;
    const bool is_flat = std::abs(here->x) > std::abs(here->y);
    const SubpixelMaximum vertex = subpixel_maximum(here, is_flat ? 1 : map_.stride());
    Eigen::Vector2d from_middle = pad_point_of(pixel) - middle;
    from_middle[is_flat ? 0 : 1] += kPixel * vertex.offset_px;
    sum += from_middle;
    squares += from_middle * from_middle.transpose();
    gradient += Eigen::Vector2d(here->x, here->y);
  }
  const auto count = static_cast<double>(pixels.size());
  const Eigen::Vector2d mean = sum / count;
  squares -= sum * mean.transpose();
  const double turn = 0.5 * std::atan2(2.0 * squares(0, 1), squares(0, 0) - squares(1, 1));
  Eigen::Vector2d along(std::cos(turn), std::sin(turn));
  if (along.dot(to - from) < 0.0) along = -along;
  PadLine line;
  line.to_bright = Eigen::Vector2d(along.y(), -along.x());
  double contrast = line.to_bright.dot(gradient);
  if (contrast < 0.0) {
    line.to_bright = -line.to_bright;
    contrast = -contrast;
  }
  const double reach = 0.5 * (to - from).norm() - kShortened;
  line.from = middle + mean - (reach + along.dot(mean)) * along;
  line.to = middle + mean + (reach - along.dot(mean)) * along;
  line.contrast = contrast / count / kGradientOfStep;
  return line;
}

}  // namespace ellipse
