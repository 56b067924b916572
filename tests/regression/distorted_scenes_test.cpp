// SPDX-License-Identifier: MIT
//
// Tracks every scene of the catalog through every lens, in the ideal plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::kHeight;
using support::kWidth;

constexpr std::uint64_t kSeed = 202;
constexpr double kRightIou = 0.8;
constexpr double kMinVisible = 0.3;
constexpr double kMinRight = 0.995;
constexpr double kMaxCentrePx = 0.05;  // median

// Parts of the ideal plane that the picture shows lie outside the picture's rectangle.
double iou(const Ellipse& a, const Ellipse& b) {
  constexpr int kAround = 3000;
  return iou_inside(translated(a, kAround, kAround),
                    translated(b, kAround, kAround),
                    kWidth + 2 * kAround,
                    kHeight + 2 * kAround);
}

struct Tally {
  int shown = 0;
  int right = 0;
  std::vector<double> centres_px;
  double max_centre = 0.0;  // [semi-major axes]
};

void follow(const Scene& scene, double from_s, int frames, Tally& tally) {
  TrackerSettings settings;
  settings.camera = camera_of(scene, kWidth, kHeight);
  Tracker tracker(settings);
  SceneRenderer renderer(scene);
  support::GrayPicture picture(kWidth, kHeight);
  for (int i = 0; i < frames; ++i) {
    const double time_s = from_s + i / 30.0;
    const Truth truth = renderer.render(time_s, static_cast<std::uint64_t>(i), picture.writable());
    const auto target = tracker.process(picture.view(), i * 33'333'333LL);
    if (!truth.outer_edge || truth.visible_fraction < kMinVisible) continue;
    ++tally.shown;
    if (!target || iou(target->ellipse, *truth.outer_edge) < kRightIou) continue;
    ++tally.right;
    const double centre_px = (target->ellipse.center() - truth.outer_edge->center()).norm();
    tally.centres_px.push_back(centre_px);
    tally.max_centre = std::max(tally.max_centre, centre_px / truth.outer_edge->semi_major);
  }
}

TEST(DistortedScenes, AreTrackedInTheIdealPlane) {
  Tally all;
  for (const NamedLens& lens : lens_catalog()) {
    for (const NamedScene& named : scene_catalog()) {
      Scene scene = scene_by_name(named.name, kSeed);
      put_on_lens(scene, lens.name);
      Tally tally;
      follow(scene, 2.0, 24, tally);
      RecordProperty(
          std::string(named.name).append("-").append(lens.name),
          std::to_string(tally.right).append(" of ").append(std::to_string(tally.shown)));
      all.shown += tally.shown;
      all.right += tally.right;
      all.centres_px.insert(all.centres_px.end(), tally.centres_px.begin(), tally.centres_px.end());
    }
  }
  ASSERT_GT(all.shown, 600);
  EXPECT_GE(all.right, kMinRight * all.shown);
  const auto middle = all.centres_px.begin() + std::ssize(all.centres_px) / 2;
  std::nth_element(all.centres_px.begin(), middle, all.centres_px.end());
  EXPECT_LE(*middle, kMaxCentrePx);
}

// Blurred edges must not count as edges in shadow: then weak edges beside the pad count as well.
TEST(DistortedScenes, AreExactInMotionBlur) {
  Scene scene = scene_by_name("dash", 962);
  put_on_lens(scene, "fisheye");
  Tally tally;
  follow(scene, 0.0, 60, tally);
  EXPECT_EQ(tally.right, tally.shown);
  EXPECT_GT(tally.shown, 50);
  EXPECT_LT(tally.max_centre, 0.05);
}

}  // namespace
}  // namespace ellipse
