// SPDX-License-Identifier: MIT
//
// Detects, tracks and reports, in the ideal plane, circles that the lens distorts to non-ellipses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/detection/arcs/arc_detector.hpp"
#include "core/detection/contours/contour_detector.hpp"
#include "core/detection/target_selection.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/pad/pad_view.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::kHeight;
using support::kWidth;

struct Shot {
  GrayPicture picture{kWidth, kHeight};
  Truth truth;
};

class DistortedPicture : public testing::TestWithParam<const char*> {
 protected:
  // The flight hovers at `lowest`, where the pad is large.
  Shot shot(double time_s) {
    Shot shot;
    shot.truth = SceneRenderer(scene_).render(time_s, 7, shot.picture.writable());
    return shot;
  }

  static Scene through_lens(const char* name) {
    Scene scene = scene_by_name(name, 31);
    put_on_lens(scene, GetParam());
    return scene;
  }

  Scene scene_ = through_lens("hover");
  const Lens lens_{camera_of(scene_, kWidth, kHeight)};
};
INSTANTIATE_TEST_SUITE_P(Lens, DistortedPicture, testing::Values("barrel", "fisheye"));

TEST_P(DistortedPicture, IsFoundInTheIdealPlane) {
  ArcDetector detector;
  for (const double time_s : {0.0, 1.0, 2.5, 4.0}) {
    const Shot frame = shot(time_s);
    const auto target = select_target(detector.detect({frame.picture.view(), lens_}, {}));
    ASSERT_TRUE(target && frame.truth.outer_edge) << time_s;
    EXPECT_LT(max_difference_px(target->ellipse, *frame.truth.outer_edge), 0.15) << time_s;
  }
}

// Without a lens model, the detected ellipse differs from that in the ideal plane.
TEST_P(DistortedPicture, GivesAnotherEllipseWithoutTheLens) {
  ArcDetector detector;
  const Shot frame = shot(1.0);
  const auto target = select_target(detector.detect(frame.picture.view(), {}));
  const bool is_same = target && max_difference_px(target->ellipse, *frame.truth.outer_edge) < 0.45;
  EXPECT_FALSE(is_same);
}

TEST_P(DistortedPicture, ShowsTheLevelsOfPadPoints) {
  const Shot frame = shot(1.0);
  const ImageView luma = frame.picture.view();
  for (const LensView& lens : {LensView(lens_), LensView()}) {
    const PadView view(image_from_pad(*frame.truth.outer_edge), lens);
    int shown = 0;
    for (int i = -40; i <= 40; ++i) {
      const Eigen::Vector2d pad_point(0.1 * i, 0.05 * i);
      const float level = view.level_at(luma, view.ideal_from_pad * pad_point.homogeneous());
      const auto projected = view.at(pad_point);
      const bool is_inside = projected && projected->point.x() >= 0.0 &&
                             projected->point.y() >= 0.0 && projected->point.x() < luma.width - 1 &&
                             projected->point.y() < luma.height - 1;
      ASSERT_EQ(std::isnan(level), !is_inside) << i;
      if (!is_inside) continue;
      ++shown;
      const Eigen::Vector2f point = projected->point.cast<float>();
      EXPECT_NEAR(level, luma.at(point.x(), point.y()), 1e-3F) << i;
    }
    EXPECT_GT(shown, 20);
    EXPECT_LT(shown, 81);
  }
}

TEST_P(DistortedPicture, ContoursAreMappedToTheIdealPlane) {
  ContourDetector detector;
  scene_.flight.lowest *= 4.0;  // so small that its distorted image is nearly an ellipse
  const Shot frame = shot(1.0);
  const auto target = select_target(detector.detect({frame.picture.view(), lens_}, {}));
  ASSERT_TRUE(target && frame.truth.outer_edge);
  EXPECT_LT(max_difference_px(target->ellipse, *frame.truth.outer_edge), 0.5);
}

TEST_P(DistortedPicture, IsRefinedInTheIdealPlane) {
  const Shot frame = shot(1.0);
  ASSERT_TRUE(frame.truth.outer_edge);
  Ellipse guess = translated(*frame.truth.outer_edge, 0.4, -0.3);
  guess.semi_major += 0.3;
  const ellipse::Picture picture(frame.picture.view(), lens_);
  const auto refined = refined_on_picture(picture, guess, Polarity::kBrightInside, 200.0);
  const auto other = refined_on_picture(picture, guess, Polarity::kDarkInside, 200.0);
  ASSERT_TRUE(refined || other);
  const Ellipse& e = refined ? refined->ellipse : other->ellipse;
  EXPECT_LT(max_difference_px(e, *frame.truth.outer_edge), 0.1);
}

TEST_P(DistortedPicture, IsTrackedWhileItFillsTheView) {
  scene_ = through_lens("touchdown");
  TrackerSettings settings;
  settings.camera = camera_of(scene_, kWidth, kHeight);
  Tracker tracker(settings);
  SceneRenderer renderer(scene_);
  GrayPicture picture(kWidth, kHeight);
  double min_visible = 1.0;
  int right = 0;
  int shown = 0;
  for (int i = 0; i < 130; ++i) {
    const Truth truth =
        renderer.render(i / 30.0, static_cast<std::uint64_t>(i), picture.writable());
    const auto target = tracker.process(picture.view(), i * 33'333'333LL);
    if (!truth.outer_edge || truth.visible_fraction < 0.3) continue;
    ++shown;
    min_visible = std::min(min_visible, truth.visible_fraction);
    const double tolerance = 0.02 * truth.outer_edge->semi_major;
    right += target && max_difference_px(target->ellipse, *truth.outer_edge) < tolerance ? 1 : 0;
    if (!target) continue;
    EXPECT_NEAR(target->visible_fraction, truth.visible_fraction, 0.03) << i;
  }
  EXPECT_LT(min_visible, 0.5);
  EXPECT_GT(shown, 60);
  EXPECT_GE(right, 0.99 * shown);
}

TEST_P(DistortedPicture, IsTrackedByRedetection) {
  TrackerSettings settings;
  settings.camera = lens_.camera();
  settings.tracking = TrackingMode::kRedetect;
  Tracker tracker(settings);
  for (int i = 0; i < 10; ++i) {
    const Shot frame = shot(1.0 + i / 30.0);
    const auto target = tracker.process(frame.picture.view(), i * 33'333'333LL);
    ASSERT_TRUE(target) << i;
    EXPECT_EQ(target->state == TargetState::kTracked, i > 0);
    EXPECT_LT(max_difference_px(target->ellipse, *frame.truth.outer_edge), 1.0) << i;
  }
}

}  // namespace
}  // namespace ellipse
