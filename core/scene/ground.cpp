// SPDX-License-Identifier: MIT
#include "core/scene/ground.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/scene/ground_painting.hpp"

namespace ellipse {
namespace {

constexpr int kSize = kGroundTileSize;
constexpr double kExtent = 12.0;     // of the tile [radii of the pad]
constexpr float kGrainScale = 4.0F;  // ratio of the tile's texels to the grain's

cv::Mat as_tile(const cv::Mat& picture) {
  if (picture.empty() || picture.type() != CV_8UC1) {
    throw std::invalid_argument("ground.picture: must be an 8-bit grey picture");
  }
  cv::Mat tile;
  cv::resize(picture, tile, {kSize, kSize}, 0.0, 0.0, cv::INTER_AREA);
  return tile;
}

float bilinear(const cv::Mat& tile, float u, float v) {
  const int mask = tile.cols - 1;
  const float fu = std::floor(u);
  const float fv = std::floor(v);
  const int iu = static_cast<int>(fu);
  const int iv = static_cast<int>(fv);
  const auto* upper = tile.data + static_cast<std::size_t>(iv & mask) * tile.step;
  const auto* lower = tile.data + static_cast<std::size_t>((iv + 1) & mask) * tile.step;
  const int left = iu & mask;
  const int right = (iu + 1) & mask;
  const float du = u - fu;
  const float top = static_cast<float>(upper[left]) + du * (upper[right] - upper[left]);
  const float bottom = static_cast<float>(lower[left]) + du * (lower[right] - lower[left]);
  return top + (v - fv) * (bottom - top);
}

}  // namespace

GroundTexture::GroundTexture(const Ground& ground, std::uint64_t seed)
    : mean_(ground.level), contrast_(static_cast<float>(ground.contrast)) {
  offset_ = static_cast<float>(ground.level) - 128.0F * contrast_;
  const bool has_picture = ground.kind == GroundKind::kPicture;
  if (ground.kind == GroundKind::kPlain || !(ground.contrast > 0.0)) return;
  cv::Mat tile;
  if (has_picture) {
    tile = as_tile(ground.picture);
  } else {
    draw_ground(ground.kind, seed).convertTo(tile, CV_8U, 1.0, 128.0);
    cv::GaussianBlur(tile, tile, {3, 3}, 0.6, 0.6, cv::BORDER_REPLICATE);
  }
  draw_ground_grain(seed).convertTo(grain_, CV_8U, 1.0, 128.0);
  while (true) {
    levels_.push_back(tile);
    if (tile.cols == 1) break;
    cv::Mat half;
    cv::resize(tile, half, tile.size() / 2, 0.0, 0.0, cv::INTER_AREA);
    tile = half;
  }
}

float GroundTexture::coarseness(double extent) {
  return std::log2(static_cast<float>(extent * kSize / kExtent));
}

float GroundTexture::at(float x, float y, float coarseness) const {
  constexpr float kTexels = static_cast<float>(kSize / kExtent);
  const float u = x * kTexels;
  const float v = y * kTexels;
  const auto coarsest = static_cast<float>(levels_.size() - 1);
  if (coarseness >= coarsest) return offset_ + contrast_ * levels_.back().at<std::uint8_t>(0, 0);
  const float clamped = std::max(coarseness, 0.0F);
  const auto level = static_cast<std::size_t>(clamped);
  const float shrink = 1.0F / static_cast<float>(1U << level);
  float value = bilinear(levels_[level], u * shrink - 0.5F, v * shrink - 0.5F);
  const float share = clamped - static_cast<float>(level);
  if (share > 0.0F) {
    const float half = 0.5F * shrink;
    value += share * (bilinear(levels_[level + 1], u * half - 0.5F, v * half - 0.5F) - value);
  } else if (coarseness < 0.0F) {
    // At close range the texels are large: adds a finer grain.
    const float grain = bilinear(grain_, u * kGrainScale, v * kGrainScale) - 128.0F;
    value += std::min(1.0F, -coarseness) * grain;
  }
  return offset_ + contrast_ * value;
}

}  // namespace ellipse
