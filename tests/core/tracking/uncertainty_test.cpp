// SPDX-License-Identifier: MIT
//
// How often the truth lies within the tracker's stated uncertainty.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "core/geometry/homography.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

struct Shares {
  int frames = 0;
  int inside = 0;
};

// The normalised squared error of an ellipse whose outline is that of `truth`.
double squared_error(const Target& target, const Ellipse& truth) {
  const auto view = with_circle(target.uncertainty.view, truth);
  if (!view) return 1e9;
  Eigen::Matrix3d change = target.uncertainty.view.inverse() * *view;
  change = change / change(2, 2) - Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 5, 1> error{change(0, 2),
                                          change(1, 2),
                                          0.5 * (change(0, 0) + change(1, 1)),
                                          0.5 * (change(0, 0) - change(1, 1)),
                                          0.5 * (change(0, 1) + change(1, 0))};
  return error.dot(target.uncertainty.information * error);
}

// Counts the frames in which the target is tracked.
Shares shares_in(const Scene& scene, int frames) {
  SceneRenderer renderer(scene);
  support::GrayPicture picture(640, 360);
  Tracker tracker;
  Shares shares;
  for (int i = 0; i < frames; ++i) {
    const Truth truth =
        renderer.render(i / 30.0, static_cast<std::uint64_t>(i), picture.writable());
    const auto target = tracker.process(picture.view(), i * 1'000'000'000LL / 30);
    if (!target || target->state != TargetState::kTracked || !truth.outer_edge) continue;
    ++shares.frames;
    shares.inside += squared_error(*target, *truth.outer_edge) <= support::kChiSquare5 ? 1 : 0;
  }
  return shares;
}

// Scenes without motion blur. Independent frames would give 95 %; consecutive errors are
// correlated.
TEST(Uncertainty, ContainsTheTruthInMostFrames) {
  for (const char* name : {"approach", "glare", "noise", "thin"}) {
    const Shares shares = shares_in(scene_by_name(name, 31), 150);
    EXPECT_GT(shares.frames, 140) << name;
    EXPECT_GT(shares.inside, 0.88 * shares.frames) << name;
  }
}

TEST(Uncertainty, ContainsTheTruthInDefocus) {
  for (const char* name : {"approach", "oblique", "disc", "hover"}) {
    for (const double blur_px : {1.0, 1.6, 2.5}) {
      Scene scene = scene_by_name(name, 31);
      scene.sensor.blur_px = blur_px;
      const Shares shares = shares_in(scene, 100);
      EXPECT_GT(shares.frames, 90) << name << ' ' << blur_px;
      EXPECT_GT(shares.inside, 0.85 * shares.frames) << name << ' ' << blur_px;
    }
  }
}

// The mean position during an exposure is not that in its middle.
TEST(Uncertainty, ContainsTheTruthInAcceleratedMotion) {
  for (const char* name : {"dash", "shake"}) {
    const Shares shares = shares_in(scene_by_name(name, 31), 150);
    EXPECT_GT(shares.frames, 140) << name;
    EXPECT_GT(shares.inside, 0.82 * shares.frames) << name;
  }
}

// The uncertainty is not simply too large: errors twice as large would exceed it.
TEST(Uncertainty, MatchesTheErrors) {
  SceneRenderer renderer(scene_by_name("oblique", 31));
  support::GrayPicture picture(640, 360);
  Tracker tracker;
  double sum = 0.0;
  int frames = 0;
  for (int i = 0; i < 150; ++i) {
    const Truth truth =
        renderer.render(i / 30.0, static_cast<std::uint64_t>(i), picture.writable());
    const auto target = tracker.process(picture.view(), i * 1'000'000'000LL / 30);
    if (!target || target->state != TargetState::kTracked) continue;
    sum += squared_error(*target, truth.outer_edge.value());
    ++frames;
  }
  EXPECT_NEAR(sum / frames, 5.0, 2.0);  // the mean of the distribution
}

}  // namespace
}  // namespace ellipse
