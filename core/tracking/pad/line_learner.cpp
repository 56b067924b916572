// SPDX-License-Identifier: MIT
#include "core/tracking/pad/line_learner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr int kParts = 8;            // of a top view, one per frame
constexpr double kStraightPx = 1.2;  // max distance of a line from its chord

}  // namespace

void LineLearner::reserve(PadModel& model) {
  model.lines.reserve(kMaxLines);
  if (!pixels_.empty()) return;
  pixels_.assign(static_cast<std::size_t>(kSize) * kSize, 0);
  lines_.reserve(kMaxLines + 1);
  chains_.reserve(pixels_.size() / ChainTracer::kMinLength);
  map_.compute({pixels_.data(), kSize, kSize, kSize}, {1.0, 1.0});
  chains_.trace(map_);
}

// Pixels outside the image are 0, all others at least 1.
void LineLearner::take(const ImageView& luma, const PadView& view) {
  const int end = std::min(kSize, rows_ + kSize / kParts);
  const Eigen::Vector3d per_column = kPixel * view.ideal_from_pad.col(0);
  for (; rows_ < end; ++rows_) {
    std::uint8_t* pixel = pixels_.data() + static_cast<std::ptrdiff_t>(rows_) * kSize;
    const Eigen::Vector3d first = view.ideal_from_pad * pad_point_of(0, rows_).homogeneous();
    for (int column = 0; column < kSize; ++column) {
      const float level = view.level_at(luma, first + column * per_column);
      *pixel++ = std::isnan(level) ? std::uint8_t{0}
                                   : static_cast<std::uint8_t>(std::max(1.0F, level + 0.5F));
    }
  }
}

// Removes gradient maxima caused by the image border.
void LineLearner::clear_maxima_at_border() {
  const auto is_shown = [&](int x, int y) {
    const int pixel = y * kSize + x;
    return pixels_[static_cast<std::size_t>(pixel)] != 0;
  };
  const int reach = GradientMap::kBorder;
  for (int y = reach; y < kSize - reach; ++y) {
    for (int x = reach; x < kSize - reach; ++x) {
      std::uint8_t& maximum = map_.maxima()[y * map_.stride() + x];
      if (maximum == 0) continue;
      bool is_inside = true;
      for (const int dy : {-reach, 0, reach}) {
        for (const int dx : {-reach, 0, reach}) is_inside &= is_shown(x + dx, y + dy);
      }
      if (!is_inside) maximum = 0;
    }
  }
}

Eigen::Vector2d LineLearner::pad_point_of(int column, int row) {
  return kPixel * (Eigen::Array2d(column, row) + 0.5) - 1.0;
}

Eigen::Vector2d LineLearner::pad_point_of(std::int32_t pixel) const {
  const Eigen::Vector2i at = map_.pixel_at(pixel);
  return pad_point_of(at.x(), at.y());
}

double LineLearner::min_contrast(const PadModel& model) {
  return kMinContrastShare * model.circles.front().contrast;
}

void LineLearner::learn(PadModel& model, double gain) {
  gain_ = gain;
  const ImageView above{pixels_.data(), kSize, kSize, kSize};
  const double min_gradient = gain * min_contrast(model) * kGradientOfStep;
  map_.compute(above, {min_gradient / kGradientGain, min_gradient / kGradientGain});
  clear_maxima_at_border();
  chains_.trace(map_);
  lines_.clear();
  for (std::size_t i = 0; i < chains_.size(); ++i) split(chains_.chain(i), model);
  model.lines = lines_;
}

// Splits at the pixel farthest from the chord until all are near it [DouglasPeucker1973].
void LineLearner::split(std::span<const std::int32_t> pixels, const PadModel& model) {
  if (pixels.size() < 2) return;
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
  const double min_length = kPixel * ChainTracer::kMinLength;
  if (length < min_length) return;
  const Eigen::Vector2d middle = 0.5 * (from + to);
  for (const PadCircle& circle : model.circles) {
    const auto is_beside = [&](const Eigen::Vector2d& point) {
      return std::abs(point.norm() - circle.radius) < 0.5 * min_length;
    };
    if (is_beside(from) && is_beside(middle) && is_beside(to)) return;
  }
  if (middle.norm() > 1.0) return;

  const auto corner = std::min<std::size_t>(pixels.size() / 4, GradientMap::kBorder - 1);
  const PadLine line = line_through(pixels.subspan(corner, pixels.size() - 2 * corner), from, to);
  if (line.contrast < min_contrast(model)) return;
  lines_.push_back(line);
  if (lines_.size() <= kMaxLines) return;
  const auto length_of = [](const PadLine& l) { return (l.to - l.from).squaredNorm(); };
  *std::min_element(lines_.begin(), lines_.end(), [&](const PadLine& a, const PadLine& b) {
    return length_of(a) < length_of(b);
  }) = lines_.back();
  lines_.pop_back();
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
    const Eigen::Vector2d from_middle =
        pad_point_of(pixel) + kPixel * subpixel_offset(here, map_.stride()) - middle;
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
  // Smoothing displaces the edge at both ends.
  const double reach = 0.5 * (to - from).norm() - (GradientMap::kBorder - 1) * kPixel;
  line.from = middle + mean - (reach + along.dot(mean)) * along;
  line.to = middle + mean + (reach - along.dot(mean)) * along;
  line.contrast = contrast / count / kGradientOfStep / gain_;
  return line;
}

}  // namespace ellipse
