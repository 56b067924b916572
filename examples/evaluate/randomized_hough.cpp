// SPDX-License-Identifier: MIT
#include "examples/evaluate/randomized_hough.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "examples/evaluate/peer_detection.hpp"

namespace evaluate {
namespace {

// Tuned on 640 x 360 pictures for a time of about 10 ms.
constexpr int kTrials = 200'000;
constexpr int kMaxVotings = 3000;
constexpr std::size_t kMaxVoters = 1500;

// Maximum deviation of an edge normal from the axis that ends there: sine of 6 degrees.
constexpr float kMaxSine = 0.1F;

// Minimum number of votes, as a fraction of the perimeter in pixels.
constexpr double kMinShare = 0.55;

// Ellipses closer than this are duplicates.
constexpr double kSamePx = 3.0;
constexpr double kSameRelative = 0.05;
constexpr std::size_t kMaxFound = 64;

template <class Random>
std::size_t index_below(std::size_t n, Random& random) {
  return static_cast<std::size_t>(((random() >> 32U) * n) >> 32U);
}

// Whether two pixels can be the ends of an axis: the length is within limits, both edges are
// perpendicular to the connecting line, and both are dark inside or both light.
bool can_be_axis(const EdgePixel& p, const EdgePixel& q, float min_sq, float max_sq) {
  const float dx = q.x - p.x;
  const float dy = q.y - p.y;
  const float length_sq = dx * dx + dy * dy;
  if (!(length_sq >= min_sq && length_sq <= max_sq)) return false;
  const float along_p = p.normal_x * dx + p.normal_y * dy;
  const float along_q = q.normal_x * dx + q.normal_y * dy;
  if (along_p * along_q >= 0.0F) return false;
  const float across_p = p.normal_x * dy - p.normal_y * dx;
  const float across_q = q.normal_x * dy - q.normal_y * dx;
  const float max_across_sq = kMaxSine * kMaxSine * length_sq;
  return across_p * across_p <= max_across_sq && across_q * across_q <= max_across_sq;
}

bool are_same(const ellipse::Ellipse& a, const ellipse::Ellipse& b) {
  return ellipse::max_difference_px(a, b) <= kSamePx + kSameRelative * a.semi_major;
}

}  // namespace

std::span<const ellipse::Detection> RandomizedHough::find(std::span<const EdgePixel> edges,
                                                          const ellipse::Thresholds& limits) {
  found_.clear();
  if (edges.size() < 5) return found_;
  Random random;
  choose_voters(edges, random);
  sort_by_direction(edges);
  const auto min_sq = static_cast<float>(limits.min_axis_px * limits.min_axis_px);
  const auto max_sq = static_cast<float>(limits.max_axis_px * limits.max_axis_px);
  int votings = 0;
  for (int trial = 0; trial < kTrials && votings < kMaxVotings; ++trial) {
    const EdgePixel& p = edges[index_below(edges.size(), random)];
    const auto facing = facing_pixels(p);
    if (facing.empty()) continue;
    const EdgePixel& q = facing[index_below(facing.size(), random)];
    if (!can_be_axis(p, q, min_sq, max_sq)) continue;
    ++votings;
    const auto candidate = vote(p, q);
    if (candidate && limits.accepts_axes(candidate->ellipse)) keep(*candidate);
  }
  return found_;
}

// The first elements of a shuffle are an unbiased sample.
void RandomizedHough::choose_voters(std::span<const EdgePixel> edges, Random& random) {
  shuffled_.assign(edges.begin(), edges.end());
  const std::size_t voters = std::min(kMaxVoters, edges.size());
  pixels_per_voter_ = static_cast<double>(edges.size()) / static_cast<double>(voters);
  voter_x_.resize(voters);
  voter_y_.resize(voters);
  semi_minor_.resize(voters);
  for (std::size_t i = 0; i < voters; ++i) {
    std::swap(shuffled_[i], shuffled_[i + index_below(edges.size() - i, random)]);
    voter_x_[i] = shuffled_[i].x;
    voter_y_[i] = shuffled_[i].y;
  }
}

// Quantized direction of a pixel's normal, 0 to kDirections - 1.
std::size_t RandomizedHough::direction(const EdgePixel& pixel) {
  const float turns =
      std::atan2(pixel.normal_y, pixel.normal_x) / (2.0F * std::numbers::pi_v<float>);
  const auto k = static_cast<std::size_t>((turns + 0.5F) * kDirections);
  return std::min<std::size_t>(k, kDirections - 1);
}

// Counting sort: sorted_[starts_[k]] is the first pixel with normal direction k.
void RandomizedHough::sort_by_direction(std::span<const EdgePixel> edges) {
  starts_.fill(0);
  for (const EdgePixel& pixel : edges) ++starts_[direction(pixel) + 1];
  for (std::size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
  sorted_.resize(edges.size());
  auto next = starts_;
  for (const EdgePixel& pixel : edges) sorted_[next[direction(pixel)]++] = pixel;
}

// The normals at the two ends of an axis are opposite.
std::span<const EdgePixel> RandomizedHough::facing_pixels(const EdgePixel& p) const {
  const std::size_t k = (direction(p) + kDirections / 2) % kDirections;
  return std::span(sorted_).subspan(starts_[k], starts_[k + 1] - starts_[k]);
}

std::optional<ellipse::Detection> RandomizedHough::vote(const EdgePixel& p, const EdgePixel& q) {
  const float cx = 0.5F * (p.x + q.x);
  const float cy = 0.5F * (p.y + q.y);
  const float a = 0.5F * std::hypot(q.x - p.x, q.y - p.y);
  const float axis_x = (q.x - cx) / a;
  const float axis_y = (q.y - cy) / a;
  const float a_sq = a * a;
  for (std::size_t i = 0; i < voter_x_.size(); ++i) {
    const float dx = voter_x_[i] - cx;
    const float dy = voter_y_[i] - cy;
    const float u = dx * axis_x + dy * axis_y;  // [XieJi2002]: d cos(tau)
    const float v = dx * axis_y - dy * axis_x;  // d sin(tau)
    // [XieJi2002]: b^2 = a^2 d^2 sin^2(tau) / (a^2 - d^2 cos^2(tau))
    const float b_sq = a_sq * v * v / std::max(a_sq - u * u, 1e-3F);
    semi_minor_[i] = std::sqrt(std::min(b_sq, 4.0F * a_sq));
  }
  // The pixels of a circle scatter to both sides of it, so votes can exceed the semi-major axis by
  // up to a pixel.
  const auto bins = static_cast<std::size_t>(a) + 2;
  votes_.assign(bins + 1, 0);
  for (const float b : semi_minor_) ++votes_[std::min(static_cast<std::size_t>(b), bins)];

  // A peak can spread over two bins.
  std::size_t peak = 0;
  for (std::size_t i = 0; i + 1 < bins; ++i) {
    if (votes_[i] + votes_[i + 1] > votes_[peak] + votes_[peak + 1]) peak = i;
  }
  const int here = votes_[peak] + votes_[peak + 1];
  if (here == 0) return std::nullopt;
  const double b = static_cast<double>(peak) + 0.5 + static_cast<double>(votes_[peak + 1]) / here;
  const auto e = ellipse_of_axes(cx, cy, a, b, std::atan2(axis_y, axis_x));
  const double score = pixels_per_voter_ * here;
  if (!e || score < kMinShare * ellipse::perimeter_px(*e)) return std::nullopt;
  return ellipse::Detection{.ellipse = *e, .score = score};
}

// Of duplicates, keeps the one with the most votes.
void RandomizedHough::keep(const ellipse::Detection& found) {
  const auto known =
      std::find_if(found_.begin(), found_.end(), [&](const ellipse::Detection& other) {
        return are_same(found.ellipse, other.ellipse);
      });
  if (known == found_.end()) {
    if (found_.size() < kMaxFound) found_.push_back(found);
  } else if (found.score > known->score) {
    *known = found;
  }
}

}  // namespace evaluate
