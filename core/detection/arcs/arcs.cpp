// SPDX-License-Identifier: MIT
#include "core/detection/arcs/arcs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/camera/arc_tangent.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr std::size_t kMaxPoints = 32;     // maximum per arc in its moments
constexpr std::size_t kCornerReach = 3;    // [px] on each side of a corner
constexpr double kCornerTurn = 0.9;        // [rad] across both sides
constexpr double kRetreatOverNoise = 5.0;  // reverse turn that ends an arc, in sigma

// Replaces x by atan2(y, x). The strength is |x| + |y|.
void to_angles(float* __restrict x,
               const float* __restrict y,
               float* __restrict strengths,
               std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float ax = std::abs(x[i]);
    const float ay = std::abs(y[i]);
    const float larger = ax > ay ? ax : ay;
    const float smaller = ax > ay ? ay : ax;
    strengths[i] = ax + ay;
    const float low = arc_tangent_of_share(smaller / (larger + 1e-9F));
    const float octant = ay > ax ? 1.57079637F - low : low;
    const float half = x[i] < 0.0F ? 3.14159274F - octant : octant;
    x[i] = y[i] < 0.0F ? -half : half;
  }
}

// The sub-pixel position of a gradient maximum, in the ideal plane.
Eigen::Vector2d maximum_at(const GradientMap& map, std::int32_t pixel) {
  const Eigen::Vector2d offset = subpixel_offset(map.gradients() + pixel, map.stride());
  return map.lens().approximate_ideal(map.pixel_at(pixel).cast<double>() + offset);
}

// Transforms a normal from the picture to the ideal plane, at the point `ideal_px`.
Eigen::Vector2d ideal_normal(const LensView& lens,
                             const Eigen::Vector2d& ideal_px,
                             const Eigen::Vector2d& in_picture) {
  if (!lens.is_distorted()) return in_picture;
  const auto shown = lens.picture_from_ideal(ideal_px);
  return shown ? (shown->slope.transpose() * in_picture).normalized() : in_picture;
}

}  // namespace

double ArcSplitter::Piece::rank() const {
  return static_cast<double>(end - begin) * std::abs(turn_rad);
}

std::span<Arc> ArcSplitter::split(const GradientMap& map,
                                  const ChainTracer& chains,
                                  bool wants_all) {
  pieces_.clear();
  pixels_ = chains.pixels();
  angles_.resize(std::max(angles_.size(), pixels_.size()));
  y_.resize(angles_.size());
  strengths_.resize(angles_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Gradient& g = map.gradients()[pixels_[i]];
    angles_[i] = g.x;
    y_[i] = g.y;
  }
  to_angles(angles_.data(), y_.data(), strengths_.data(), pixels_.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const std::size_t end = begin + chains.chain(i).size();
    split_chain(map, begin, end);
    begin = end;
  }
  keep_best_pieces(wants_all);
  arcs_.clear();
  for (const Piece& piece : pieces_) arcs_.push_back(make_arc(map, piece));
  return arcs_;
}

void ArcSplitter::keep_best_pieces(bool wants_all) {
  const auto ranks_before = [](const Piece& a, const Piece& b) { return a.rank() > b.rank(); };
  const std::size_t count = std::min(pieces_.size(), wants_all ? kMaxArcs : kMaxTried);
  const auto end = pieces_.begin() + std::ptrdiff_t(count);
  std::partial_sort(pieces_.begin(), end, pieces_.end(), ranks_before);
  pieces_.erase(end, pieces_.end());
}

void ArcSplitter::unwrap(std::size_t begin, std::size_t end) {
  float offset = 0.0F;
  float previous = angles_[begin];
  for (std::size_t i = begin + 1; i < end; ++i) {
    const float raw = angles_[i];
    if (raw - previous > std::numbers::pi_v<float>) offset -= static_cast<float>(kTwoPi);
    if (raw - previous < -std::numbers::pi_v<float>) offset += static_cast<float>(kTwoPi);
    angles_[i] = raw + offset;
    previous = raw;
  }
}

Moments ArcSplitter::moments_of(const GradientMap& map, std::size_t begin, std::size_t end) const {
  // One origin for all arcs, so that their moments can be added.
  Moments moments(Eigen::Vector2d(0.5 * map.width(), 0.5 * map.height()));
  // A few points suffice: the guess is refined on the edges later.
  const std::size_t step = (end - begin) / kMaxPoints + 1;
  for (std::size_t i = begin + step / 2; i < end; i += step) {
    const Eigen::Vector2d point = maximum_at(map, pixels_[i]);
    if (point.allFinite()) moments.add(point, static_cast<double>(step));
  }
  return moments;
}

// Adds a chain that turns by more than half a turn as a whole: an outline too rough for arcs may
// still be an ellipse.
void ArcSplitter::add_whole(std::size_t begin, std::size_t end) {
  const double turn = angles_[end - 1] - angles_[begin];
  if (std::abs(turn) > std::numbers::pi) pieces_.push_back({begin, end, turn});
}

void ArcSplitter::split_chain(const GradientMap& map, std::size_t begin, std::size_t end) {
  unwrap(begin, end);
  add_whole(begin, end);
  // In a run of sharply turning pixels, the sharpest one is the corner.
  std::size_t part = begin;
  std::size_t corner = end;
  float sharpest = 0.0F;
  const auto cut = [&] {
    if (corner == end) return;
    split_smooth_part(map.noise(), part, corner > part ? corner - 1 : part);
    part = corner + 2;
    corner = end;
    sharpest = 0.0F;
  };
  for (std::size_t i = begin + kCornerReach; i + kCornerReach < end; ++i) {
    const float turn = std::abs(angles_[i + kCornerReach] - angles_[i - kCornerReach]);
    if (turn > kCornerTurn) {
      if (turn > sharpest) corner = i;
      sharpest = std::max(sharpest, turn);
    } else {
      cut();
    }
  }
  cut();
  if (part < end) split_smooth_part(map.noise(), part, end);
}

// Smallest reverse turn of the direction that is not noise [rad].
double ArcSplitter::min_reverse_turn(double noise, std::size_t begin, std::size_t end) const {
  float strength = 0.0F;
  for (std::size_t i = begin; i < end; ++i) strength += strengths_[i];
  const double length = static_cast<double>(end - begin);
  // The mean of |x| + |y| is 1.27 times that of the norm.
  return kRetreatOverNoise * 1.27 * noise * length / strength;
}

// Cuts at extremes of the direction, where the reverse turn exceeds the noise.
void ArcSplitter::split_smooth_part(double noise, std::size_t begin, std::size_t end) {
  if (end < begin + ChainTracer::kMinLength) return;
  const auto retreat = static_cast<float>(min_reverse_turn(noise, begin, end));
  std::size_t lowest_at = begin;
  std::size_t highest_at = begin;
  float lowest = angles_[begin];
  float highest = lowest;
  int direction = 0;
  std::size_t part = begin;
  const auto turn_back_at = [&](std::size_t furthest) {
    if (direction == 0) return;
    add_piece(part, furthest + 1);
    part = furthest;
  };
  for (std::size_t i = begin + 1; i < end; ++i) {
    const float angle = angles_[i];
    if (angle > highest) {
      highest = angle;
      highest_at = i;
    }
    if (angle < lowest) {
      lowest = angle;
      lowest_at = i;
    }
    if (direction >= 0 && highest - angle > retreat) {
      turn_back_at(highest_at);
      direction = -1;
      lowest = angle;
      lowest_at = i;
    } else if (direction <= 0 && angle - lowest > retreat) {
      turn_back_at(lowest_at);
      direction = 1;
      highest = angle;
      highest_at = i;
    }
  }
  add_piece(part, end);
}

double ArcSplitter::mean_angle(std::size_t at, std::size_t begin, std::size_t end) const {
  const std::size_t first = at >= begin + 2 ? at - 2 : begin;
  const std::size_t last = std::min(end, at + 3);
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += angles_[i];
  return sum / static_cast<double>(last - first);
}

void ArcSplitter::add_piece(std::size_t begin, std::size_t end) {
  if (end < begin + ChainTracer::kMinLength) return;
  const double turn = mean_angle(end - 3, begin, end) - mean_angle(begin + 2, begin, end);
  if (std::abs(turn) >= kMinTurn) pieces_.push_back({begin, end, turn});
}

Arc ArcSplitter::make_arc(const GradientMap& map, const Piece& piece) const {
  Arc arc;
  arc.begin = piece.begin;
  arc.end = piece.end;
  // The chain runs with the bright side on its left, so that a right turn encloses the dark side.
  arc.polarity = piece.turn_rad > 0.0 ? Polarity::kDarkInside : Polarity::kBrightInside;
  const std::array<std::size_t, 3> at = {arc.begin + 2, (arc.begin + arc.end) / 2, arc.end - 3};
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = mean_angle(at[k], arc.begin, arc.end);
    arc.points[k] = map.point_of(pixels_[at[k]]);
    arc.inwards[k] = -static_cast<int>(arc.polarity) *
                     ideal_normal(map.lens(), arc.points[k], {std::cos(angle), std::sin(angle)});
  }
  arc.moments = moments_of(map, arc.begin, arc.end);
  return arc;
}

}  // namespace ellipse
