#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/image/image_view.hpp"
#include "core/scene/random.hpp"
#include "core/scene/renderer.hpp"

namespace support {

/// Size of a frame of a rendered scene [px].
inline constexpr int kWidth = 640;
inline constexpr int kHeight = 360;

/// An 8-bit picture that owns its pixels.
struct GrayPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  GrayPicture(int width_px, int height_px, std::uint8_t level = 0)
      : width(width_px),
        height(height_px),
        pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), level) {}

  [[nodiscard]] std::uint8_t& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  [[nodiscard]] ellipse::MutableImage writable() { return {pixels.data(), width, height, width}; }
  [[nodiscard]] ellipse::ImageView view() const { return {pixels.data(), width, height, width}; }
};

/// Renders a scene with the pad's outer edge at exactly this ellipse.
inline GrayPicture rendered(const ellipse::Scene& scene,
                            const ellipse::Ellipse& outer_edge,
                            int width = 320,
                            int height = 240,
                            std::uint64_t frame = 0) {
  GrayPicture picture(width, height);
  ellipse::SceneRenderer(scene).render(
      ellipse::image_from_pad(outer_edge), frame, picture.writable());
  return picture;
}

/// The mean of pictures of an outline that moves by a length [px] along x, centred on the truth.
/// @param render  Renders the outline at the instant k, from 0: picture = render(ellipse, k).
template <class Render>
GrayPicture blurred_by_motion(const ellipse::Ellipse& truth, int length_px, const Render& render) {
  GrayPicture mean = render(truth, 0);
  std::vector<int> sums(mean.pixels.size());
  for (int k = 0; k <= length_px; ++k) {
    const GrayPicture picture = render(ellipse::translated(truth, k - 0.5 * length_px, 0.0), k);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += picture.pixels[i];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    mean.pixels[i] = static_cast<std::uint8_t>(sums[i] / (length_px + 1));
  }
  return mean;
}

/// A ball lit from above: brighter than its ground above the centre and darker below. `outline` is
/// a circle.
inline GrayPicture lit_ball(const ellipse::Ellipse& outline, int width, int height) {
  constexpr double kGround = 120.0;
  constexpr double kShade = 40.0;  // largest difference from the ground
  GrayPicture picture(width, height);
  ellipse::Random noise(1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double inside_px = outline.semi_major - std::hypot(x - outline.cx, y - outline.cy);
      const double covered = std::clamp(0.5 + inside_px, 0.0, 1.0);
      const double shade = kShade * (outline.cy - y) / outline.semi_major;
      picture.at(x, y) = static_cast<std::uint8_t>(kGround + covered * shade + 2.0 * noise.unit());
    }
  }
  return picture;
}

/// A random ellipse with this mean radius, an axis ratio up to 2, any orientation, and a random
/// centre inside this pixel.
inline ellipse::Ellipse random_ellipse(ellipse::Random& random, int x, int y, double radius) {
  const double flat = std::sqrt(random.between(1.0, 2.0));
  const double cx = x + random.unit();
  const double cy = y + random.unit();
  return {cx, cy, radius * flat, radius / flat, random.between(-1.5, 1.5)};
}

/// A bar between two points in pixels of a picture of this size.
inline ellipse::Bar bar_px(const Eigen::Vector2d& from_px,
                           const Eigen::Vector2d& to_px,
                           double width_px,
                           double level,
                           int width = 320,
                           int height = 240) {
  const Eigen::Vector2d middle(0.5 * (width - 1), 0.5 * (height - 1));
  return {(from_px - middle) / width, (to_px - middle) / width, width_px / width, level};
}

/// A ring on a uniform, bright plate that fills the picture.
inline ellipse::Scene plain_ring() {
  ellipse::Scene scene;
  scene.pad.pattern = ellipse::Pattern::kRing;
  scene.pad.plate_half_width = 0.0;
  scene.ground.level = 200.0;
  scene.ground.contrast = 0.0;
  return scene;
}

/// A disc on such a plate.
inline ellipse::Scene plain_disc() {
  ellipse::Scene scene = plain_ring();
  scene.pad.pattern = ellipse::Pattern::kDisc;
  return scene;
}

}  // namespace support
