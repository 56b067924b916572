// SPDX-License-Identifier: MIT
#include "core/edges/blurred_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/edges/subpixel.hpp"

namespace ellipse {
namespace {

// Standard deviation of the blur by lens and kernels, doubled by each unit of defocus.
double blur_px(double defocus) {
  return std::sqrt(1.0 + kLensVariance * std::pow(4.0, defocus));
}

TEST(BlurredBars, LeavesWideOnesInPlace) {
  for (const double defocus : {0.0, 0.5, 1.3, 3.0}) {
    const BlurredBars bars(defocus);
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      for (const double factor : {0.99, 1.0, 1.5}) {
        const double width_px = factor * bars.widest_px();
        const BarMaxima maxima = bars.maxima(width_px, i);
        EXPECT_NEAR(maxima.distance_px, width_px, 1e-3 * width_px) << defocus << ' ' << i;
        // That of a Gaussian edge, by differences of pixels.
        const double squared_cosine = std::pow(bar_normals()[i].lpNorm<Eigen::Infinity>(), 2);
        const double variance = 1.0 / maxima.sharpness - squared_cosine / 3.0;
        EXPECT_NEAR(variance, std::pow(blur_px(defocus), 2), 0.03 * variance)
            << defocus << ' ' << i;
      }
    }
  }
}

// The maxima of a line's gradient are at one standard deviation to its sides, and twice as sharp as
// those of an edge.
TEST(BlurredBars, SeparatesTheEdgesOfALine) {
  for (const double defocus : {1.0, 2.0, 3.0}) {
    const BlurredBars bars(defocus);
    const double sharp = bars.maxima(bars.widest_px(), 0).sharpness;
    for (std::size_t i = 0; i < kBarDirections; ++i) {
      const BarMaxima line = bars.maxima(0.0, i);
      EXPECT_NEAR(line.distance_px, 2.0 * blur_px(defocus), 0.06 * line.distance_px);
      EXPECT_NEAR(line.sharpness, 2.0 * sharp, 0.1 * line.sharpness);
    }
  }
}

TEST(BlurredBars, HasDistancesThatGrowWithTheWidth) {
  for (const double defocus : {0.0, 0.7, BlurredBars::max_defocus()}) {
    const BlurredBars bars(defocus);
    double last_px = 0.0;
    for (double width_px = 0.0; width_px < 1.2 * bars.widest_px(); width_px += 0.1) {
      const double distance_px = bars.maxima(width_px, 3).distance_px;
      EXPECT_GT(distance_px, last_px) << defocus << ' ' << width_px;
      last_px = distance_px;
    }
  }
}

}  // namespace
}  // namespace ellipse
