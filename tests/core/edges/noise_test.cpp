// SPDX-License-Identifier: MIT
#include "core/edges/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/edges/gradient_map.hpp"
#include "core/scene/random.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

GrayPicture noise_of(int width, int height) {
  GrayPicture picture(width, height);
  Random random(7);
  for (std::uint8_t& level : picture.pixels) level = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

// The definition, pixel by pixel.
double expected_noise(const ImageView& luma) {
  const auto difference = [&](int x, int y) {
    const std::uint8_t* row = luma.row(y);
    return row[x - 1] - 2 * row[x] + row[x + 1];
  };
  double sum = 0.0;
  int samples = 0;
  int all = 0;
  const int border = GradientMap::kBorder;
  for (int y = border; y < luma.height - border; y += std::max(1, luma.height / kNoiseRows)) {
    for (int x = border - 1; x < luma.width - border + 1; x += 2) {
      ++all;
      if (is_saturated(luma.row(y)[x])) continue;
      sum += std::abs(difference(x, y - 1) - 2 * difference(x, y) + difference(x, y + 1));
      ++samples;
    }
  }
  const int counted = std::max({1, samples, static_cast<int>(0.3 * all)});
  const double sigma = std::sqrt(0.5 * std::numbers::pi) / 6.0 * sum / counted;
  return std::max(sigma, 1.0 / std::sqrt(12.0));
}

TEST(PixelNoise, SamplesEveryOtherPixelThatIsNotSaturatedAtAnySize) {
  for (const int width : {1, 5, 6, 7, 8, 9, 64, 101, 640, 641}) {
    for (const int height : {1, 6, 7, 30, 121}) {
      const GrayPicture picture = noise_of(width, height);
      EXPECT_DOUBLE_EQ(pixel_noise(picture.view()), expected_noise(picture.view()))
          << width << " x " << height;
    }
  }
}

TEST(PixelNoise, ReadsPartsOfAPicture) {
  const GrayPicture picture = noise_of(64, 40);
  const ImageView part = picture.view().region({3, 5, 33, 21});
  EXPECT_DOUBLE_EQ(pixel_noise(part), expected_noise(part));
}

// Only a bright diagonal stripe is not saturated: its edges are not noise.
TEST(PixelNoise, IsLowInAPictureOfBlackAndWhite) {
  GrayPicture picture(200, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = y; x < y + 3; ++x) picture.at(x, y) = 250;
  }
  EXPECT_LT(pixel_noise(picture.view()), 10.0);
}

TEST(PixelNoise, IsThatOfRoundingWithoutSamples) {
  GrayPicture white(64, 40);
  std::fill(white.pixels.begin(), white.pixels.end(), std::uint8_t{255});
  EXPECT_DOUBLE_EQ(pixel_noise(white.view()), 1.0 / std::sqrt(12.0));
  EXPECT_DOUBLE_EQ(pixel_noise({}), 1.0 / std::sqrt(12.0));
}

}  // namespace
}  // namespace ellipse
