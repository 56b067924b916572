// SPDX-License-Identifier: MIT
#include "core/tracking/pad/outer_edge.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/tracking/pad/pad_model.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::plain_ring;
using support::rendered;

Scene quiet_disc() {
  Scene scene = support::plain_disc();
  scene.sensor.read_noise = 1.0;
  return scene;
}

const Eigen::Vector2d kAtRest(0.0, 0.0);

std::optional<FittedEllipse> refined_outer_edge(const GrayPicture& picture,
                                                const PadView& view,
                                                const PadModel& model,
                                                const Eigen::Vector2d& motion_px = kAtRest,
                                                Refinement refinement = Refinement::kEdges) {
  OuterEdge edge;
  edge.configure(refinement);
  return edge.refine(picture.view(), view, model, 1.0, motion_px, 1.0);
}

TEST(OuterEdge, IsExactForThickAndThinRings) {
  for (const double ring_width : {0.205, 0.1, 0.055}) {
    Scene scene = plain_ring();
    scene.pad.ring_width = ring_width;
    const Ellipse truth{130.3, 129.6, 70.0, 55.0, 0.4};
    const GrayPicture picture = rendered(scene, truth, 260, 260);
    const Eigen::Matrix3d view = image_from_pad(truth);
    const auto model = learn_circles(picture.view(), view);
    ASSERT_TRUE(model) << ring_width;
    Eigen::Matrix3d nudge = Eigen::Matrix3d::Identity();
    nudge(0, 2) = 0.2;
    const Eigen::Matrix3d start = nudge * view;
    const auto error = [&](Refinement refinement) {
      const auto exact = refined_outer_edge(picture, {start, {}}, *model, kAtRest, refinement);
      return exact ? max_difference_px(exact->ellipse, truth) : 9.0;
    };
    EXPECT_LT(error(Refinement::kEdges), 0.08) << ring_width;
    EXPECT_LT(error(Refinement::kPhotometric), 0.08) << ring_width;
    EXPECT_FALSE(refined_outer_edge(picture, {start, {}}, *model, kAtRest, Refinement::kNone));
  }
}

TEST(OuterEdge, IsNotFoundFarFromThePad) {
  const Ellipse truth{130.3, 129.6, 70.0, 55.0, 0.4};
  const GrayPicture picture = rendered(plain_ring(), truth, 260, 260);
  const auto model = learn_circles(picture.view(), image_from_pad(truth));
  ASSERT_TRUE(model);
  const Eigen::Matrix3d far_off = image_from_pad(translated(truth, 30.0, 0.0));
  EXPECT_FALSE(
      refined_outer_edge(picture, {far_off, {}}, *model, kAtRest, Refinement::kPhotometric));
}

const Ellipse kSmallPad{130.3, 129.6, 44.0, 35.0, 0.4};

// The refined outer edge of kSmallPad out of focus.
// @param ring_ratio  As of learn_circles().
std::optional<FittedEllipse> refined_in_defocus(double ring_width,
                                                double blur_px,
                                                double ring_ratio = 0.0) {
  Scene scene = plain_ring();
  scene.pad.ring_width = ring_width;
  scene.sensor.blur_px = blur_px;
  const GrayPicture picture = rendered(scene, kSmallPad, 260, 260);
  const PadView view(image_from_pad(kSmallPad), {});
  const auto model = learn_circles(picture.view(), view, ring_ratio);
  return model ? refined_outer_edge(picture, view, *model) : std::nullopt;
}

// Blur separates the gradient maxima of both edges, the more, the thinner the ring is. The
// sharpness of the edges shows the blur.
TEST(OuterEdge, IsExactForDefocusedRings) {
  for (const double blur_px : {1.0, 1.6, 2.5}) {
    const auto exact = refined_in_defocus(plain_ring().pad.ring_width, blur_px);
    ASSERT_TRUE(exact) << blur_px;
    EXPECT_LT(max_difference_px(exact->ellipse, kSmallPad), 0.06 * blur_px) << blur_px;
  }
}

// The width of such a thin ring does not follow from its edges: the stated error of the size
// contains the truth, also if the blur is so small that the ring may be in focus.
TEST(OuterEdge, IsNotSureOfTheSizeOfADefocusedThinRing) {
  for (const double blur_px : {0.7, 0.8, 1.0, 1.6}) {
    const auto exact = refined_in_defocus(0.055, blur_px);
    ASSERT_TRUE(exact) << blur_px;
    const double radius_px = kSmallPad.semi_major;
    const double sigma_px = radius_px * std::sqrt(exact->uncertainty.information.inverse()(2, 2));
    EXPECT_GT(sigma_px, 0.1) << blur_px;
    EXPECT_LT(sigma_px, 1.0) << blur_px;
    EXPECT_LT(std::abs(exact->ellipse.semi_major - radius_px), 2.0 * sigma_px) << blur_px;
    EXPECT_LT((exact->ellipse.center() - kSmallPad.center()).norm(), 0.05) << blur_px;
  }
}

TEST(OuterEdge, IsExactForADefocusedThinRingOfKnownRatio) {
  for (const double blur_px : {0.6, 1.0, 1.6, 2.5}) {
    const auto exact = refined_in_defocus(0.055, blur_px, 0.945);
    ASSERT_TRUE(exact) << blur_px;
    EXPECT_LT(max_difference_px(exact->ellipse, kSmallPad), 0.06 * blur_px) << blur_px;
  }
}

// A blur that is longer than the ring is wide moves its edges across the motion apart.
TEST(OuterEdge, IsExactForThinRingsInMotion) {
  Scene scene = plain_ring();
  scene.pad.ring_width = 0.12;
  const Ellipse truth{160.0, 120.0, 60.0, 54.0, 0.0};
  const GrayPicture sharp = rendered(scene, truth, 320, 240);
  const PadView view(image_from_pad(truth), {});
  const auto model = learn_circles(sharp.view(), view);
  ASSERT_TRUE(model);
  const GrayPicture picture = support::blurred_by_motion(truth, 12, [&](const Ellipse& e, int k) {
    return rendered(scene, e, 320, 240, std::uint64_t(k));
  });
  const auto exact = refined_outer_edge(picture, view, *model, {24.0, 0.0});
  ASSERT_TRUE(exact);
  EXPECT_LT((exact->ellipse.center() - truth.center()).norm(), 0.1);
  EXPECT_NEAR(exact->ellipse.semi_major, truth.semi_major, 0.4);
  const auto at_rest = refined_outer_edge(picture, view, *model);
  ASSERT_TRUE(at_rest);
  EXPECT_GT(at_rest->ellipse.semi_major, truth.semi_major + 1.0);
}

TEST(OuterEdge, LearnsTheExposureFromTheBlur) {
  const Scene scene = quiet_disc();
  const Ellipse truth{160.0, 120.0, 40.0, 36.0, 0.0};
  const GrayPicture sharp = rendered(scene, truth, 320, 240);
  const PadView view(image_from_pad(truth), {});
  const auto model = learn_circles(sharp.view(), view, 0.0, 0.1);
  ASSERT_TRUE(model);
  OuterEdge edge;
  EXPECT_EQ(edge.squared_exposure(), 0.0);
  EXPECT_TRUE(edge.refine(sharp.view(), view, *model, 1.0, {24.0, 0.0}, 1.0));
  EXPECT_EQ(edge.squared_exposure(), 0.0);
  edge.restart();
  const GrayPicture picture = support::blurred_by_motion(truth, 12, [&](const Ellipse& e, int k) {
    return rendered(scene, e, 320, 240, std::uint64_t(k));
  });
  EXPECT_TRUE(edge.refine(picture.view(), view, *model, 1.0, {24.0, 0.0}, 1.0));
  // A blur of 13 px: (13 / 24)^2 is .29.
  EXPECT_GT(edge.squared_exposure(), 0.25);
  EXPECT_LT(edge.squared_exposure(), 0.5);
  edge.restart();
  EXPECT_EQ(edge.squared_exposure(), 0.0);
}

TEST(OuterEdge, LearnsNothingFromAnEdgeThatIsTooFarAway) {
  Scene scene = plain_ring();
  const Ellipse truth{130.3, 129.6, 20.0, 19.0, 0.4};
  const GrayPicture sharp = rendered(scene, truth, 260, 260);
  scene.sensor.blur_px = 1.6;
  const GrayPicture defocused = rendered(scene, truth, 260, 260);
  const PadView view(image_from_pad(truth), {});
  const auto model = learn_circles(sharp.view(), view);
  ASSERT_TRUE(model);
  OuterEdge edge;
  const auto refine = [&](const GrayPicture& picture, const Ellipse& predicted, double adaptation) {
    const PadView at(image_from_pad(predicted), {});
    return edge.refine(picture.view(), at, *model, 1.0, kAtRest, adaptation);
  };
  const auto exact = refine(sharp, truth, 1.0);
  ASSERT_TRUE(exact);
  ASSERT_FALSE(refine(defocused, {130.3, 129.6, 22.0, 21.0, 0.4}, 1.0));
  const auto again = refine(sharp, truth, 0.0);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->ellipse, exact->ellipse);
  ASSERT_TRUE(refine(defocused, truth, 1.0));
  const auto softer = refine(sharp, truth, 0.0);
  ASSERT_TRUE(softer);
  EXPECT_NE(softer->ellipse, exact->ellipse);
}

// Blurred edges may be matched anywhere over the length of the blur, so that the view is off.
TEST(OuterEdge, MayBeFartherFromThePredictedOneInMotion) {
  const Scene scene = quiet_disc();
  const Ellipse truth{160.0, 120.0, 40.0, 36.0, 0.0};
  const GrayPicture picture = support::blurred_by_motion(truth, 12, [&](const Ellipse& e, int k) {
    return rendered(scene, e, 320, 240, std::uint64_t(k));
  });
  Ellipse predicted = truth;
  predicted.semi_major += 3.0;
  const PadView view(image_from_pad(predicted), {});
  const auto model = learn_circles(picture.view(), view, 0.0, 0.1);
  ASSERT_TRUE(model);
  const auto exact = refined_outer_edge(picture, view, *model, {24.0, 0.0});
  ASSERT_TRUE(exact);
  EXPECT_LT((exact->ellipse.center() - truth.center()).norm(), 0.1);
  EXPECT_NEAR(exact->ellipse.semi_major, truth.semi_major, 0.3);
}

}  // namespace
}  // namespace ellipse
