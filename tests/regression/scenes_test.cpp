// SPDX-License-Identifier: MIT
//
// Every scene of the catalog: how many frames are right at the least, how many false at the most.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>

#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracker.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr std::uint64_t kSeed = 201;
constexpr double kRightIou = 0.8;
constexpr double kLeastVisible = 0.3;

/// What was measured when the row was written last. Who makes a tracker better moves them.
struct Limits {
  const char* scene;
  double from_s;
  double step_s;
  int frames;
  const char* detector;
  const char* tracking;
  int least_right;  ///< Frames with the right target.
  int most_false;   ///< Frames with another target, or with one where there is none.
};

constexpr Limits kLimits[] = {
    {"approach", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"approach", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"oblique", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"oblique", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"dusk", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"dusk", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"glare", 2.0, 0.1, 40, "contours", "redetect", 28, 12},
    {"glare", 2.0, 0.1, 40, "contours", "none", 37, 3},
    {"occluded", 2.0, 0.1, 40, "contours", "redetect", 0, 23},
    {"dash", 2.0, 1.0 / 30.0, 20, "contours", "redetect", 13, 0},
    {"dash", 2.0, 1.0 / 30.0, 20, "contours", "none", 8, 0},
    {"touchdown", 2.0, 0.1, 40, "contours", "redetect", 16, 3},
    {"touchdown", 2.0, 0.1, 40, "contours", "none", 14, 2},
    {"reenter", 2.0, 0.1, 40, "contours", "redetect", 19, 0},
    {"reenter", 2.0, 0.1, 40, "contours", "none", 19, 0},
    {"thin", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"thin", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"disc", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"disc", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"bullseye", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"bullseye", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"crumpled", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"crumpled", 2.0, 0.1, 40, "contours", "none", 32, 8},
    {"noise", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"noise", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"negative", 2.0, 0.1, 40, "contours", "redetect", 0, 10},
    {"negative", 2.0, 0.1, 40, "contours", "none", 0, 7},
    {"orbit", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"orbit", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"shake", 2.0, 1.0 / 30.0, 20, "contours", "redetect", 20, 0},
    {"shake", 2.0, 1.0 / 30.0, 20, "contours", "none", 20, 0},
    {"hover", 2.0, 0.1, 40, "contours", "redetect", 40, 0},
    {"hover", 2.0, 0.1, 40, "contours", "none", 40, 0},
    {"approach", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"approach", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"oblique", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"oblique", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"dusk", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"dusk", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"glare", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"glare", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"occluded", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"occluded", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"dash", 2.0, 1.0 / 30.0, 20, "arcs", "redetect", 20, 0},
    {"dash", 2.0, 1.0 / 30.0, 20, "arcs", "none", 19, 1},
    {"touchdown", 2.0, 0.1, 40, "arcs", "redetect", 19, 2},
    {"touchdown", 2.0, 0.1, 40, "arcs", "none", 21, 0},
    {"reenter", 2.0, 0.1, 40, "arcs", "redetect", 15, 0},
    {"reenter", 2.0, 0.1, 40, "arcs", "none", 16, 0},
    {"thin", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"thin", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"disc", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"disc", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"bullseye", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"bullseye", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"crumpled", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"crumpled", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"noise", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"noise", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"negative", 2.0, 0.1, 40, "arcs", "redetect", 0, 2},
    {"negative", 2.0, 0.1, 40, "arcs", "none", 0, 3},
    {"orbit", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"orbit", 2.0, 0.1, 40, "arcs", "none", 40, 0},
    {"shake", 2.0, 1.0 / 30.0, 20, "arcs", "redetect", 20, 0},
    {"shake", 2.0, 1.0 / 30.0, 20, "arcs", "none", 20, 0},
    {"hover", 2.0, 0.1, 40, "arcs", "redetect", 40, 0},
    {"hover", 2.0, 0.1, 40, "arcs", "none", 40, 0},
};

void PrintTo(const Limits& limits, std::ostream* out) {
  *out << limits.scene << ' ' << limits.detector << ' ' << limits.tracking;
}

class Scenes : public testing::TestWithParam<Limits> {
 protected:
  void run() {
    const Limits& limits = GetParam();
    TrackerSettings settings;
    set_by_name(settings, "detector", limits.detector);
    set_by_name(settings, "tracking", limits.tracking);
    Tracker tracker(settings);
    SceneRenderer renderer(scene_by_name(limits.scene, kSeed));
    support::Picture picture(kWidth, kHeight);
    for (int i = 0; i < limits.frames; ++i) {
      const double time_s = limits.from_s + i * limits.step_s;
      const Truth truth = renderer.render(time_s, i, picture.writable());
      count(tracker.process(picture.view(), std::llround(1e9 * time_s)), truth);
    }
  }

  void count(const std::optional<Target>& target, const Truth& truth) {
    if (!target) return;
    const bool is_right =
        truth.outer_edge &&
        iou_inside(target->ellipse, *truth.outer_edge, kWidth, kHeight) >= kRightIou;
    const bool is_judged = truth.visible_fraction >= kLeastVisible || truth.visible_fraction <= 0.0;
    right += is_right ? 1 : 0;
    wrong += !is_right && is_judged ? 1 : 0;
  }

  int right = 0;
  int wrong = 0;
};

TEST_P(Scenes, ShowTheirTargetAndNoOther) {
  run();
  RecordProperty("right", right);
  RecordProperty("false", wrong);
  EXPECT_GE(right, GetParam().least_right);
  EXPECT_LE(wrong, GetParam().most_false);
}

INSTANTIATE_TEST_SUITE_P(Catalog, Scenes, testing::ValuesIn(kLimits), [](const auto& info) {
  return std::string(info.param.scene) + '_' + info.param.detector + '_' + info.param.tracking;
});

// Grounds on which nothing may be found, ever.
struct Ban {
  const char* detector;
  const char* ground;
};

constexpr Ban kBans[] = {
    {"contours", "plain"},
    {"arcs", "asphalt"},
    {"arcs", "grass"},
    {"arcs", "tiles"},
    {"arcs", "rounded"},
};

void PrintTo(const Ban& ban, std::ostream* out) {
  *out << ban.detector << " on " << ban.ground;
}

class BareGround : public testing::TestWithParam<Ban> {};

TEST_P(BareGround, ShowsNothing) {
  Scene scene = scene_by_name("negative", kSeed);
  const auto nicks = ground_nicks();
  const auto nick = std::find(nicks.begin(), nicks.end(), std::string(GetParam().ground));
  scene.ground.kind = static_cast<GroundKind>(nick - nicks.begin());
  SceneRenderer renderer(scene);
  TrackerSettings settings;
  set_by_name(settings, "detector", GetParam().detector);
  set_by_name(settings, "tracking", "none");
  Tracker tracker(settings);
  support::Picture picture(kWidth, kHeight);
  for (int i = 0; i < 20; ++i) {
    renderer.render(0.5 * i, i, picture.writable());
    EXPECT_FALSE(tracker.process(picture.view(), 0)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Detectors, BareGround, testing::ValuesIn(kBans), [](const auto& info) {
  return std::string(info.param.detector) + '_' + info.param.ground;
});

TEST(SceneLimits, CoverTheCatalog) {
  for (const NamedScene& scene : scene_catalog()) {
    const bool is_here =
        std::any_of(std::begin(kLimits), std::end(kLimits), [&](const Limits& row) {
          return std::string(row.scene) == scene.name;
        });
    EXPECT_TRUE(is_here) << scene.name;
  }
}

}  // namespace
}  // namespace ellipse
