// SPDX-License-Identifier: MIT
//
// The stages of the edge tracker, one by one.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>
#include <vector>

#include "core/edges/noise.hpp"
#include "core/tracking/pad/edge_search.hpp"
#include "core/tracking/pad/homography_filter.hpp"
#include "core/tracking/pad/homography_solver.hpp"
#include "core/tracking/pad/line_learner.hpp"
#include "core/tracking/pad/model_errors.hpp"
#include "core/tracking/pad/model_updates.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using support::GrayPicture;
using support::plain_ring;
using support::rendered;

const Ellipse kPad{160.3, 120.6, 70.0, 55.0, 0.4};
constexpr double kInner = 0.795;  // of a ring as wide as Pad's own

Scene scene_of(Pattern pattern, bool is_bright = false) {
  Scene scene = plain_ring();
  scene.pad.pattern = pattern;
  if (is_bright) {
    scene.pad.paint_level = 215.0;
    scene.ground.level = 90.0;
  }
  return scene;
}

GrayPicture flat_picture() {
  Scene scene = scene_of(Pattern::kNone);
  return rendered(scene, kPad);
}

PadModel ring_model() {
  return {{{1.0, true, 145.0}, {kInner, false, 145.0}}, {}};
}

PadModel disc_model() {
  return {{{1.0, true, 145.0}}, {}};
}

Ellipse resized(Ellipse e, double factor) {
  e.semi_major *= factor;
  e.semi_minor *= factor;
  return e;
}

// -- PadView

// The next pixel of a point that rounds to the last column or row would be outside the picture.
TEST(PadView, HasNoLevelOnTheLastColumnAndRow) {
  const GrayPicture picture(20, 10, 100);
  const PadView view(Matrix3d::Identity());
  const auto level_at = [&](double x, double y) {
    return view.level_at(picture.view(), {x, y, 1.0});
  };
  EXPECT_EQ(level_at(18.5, 8.5), 100.0F);
  EXPECT_TRUE(std::isnan(level_at(19.0 - 1e-9, 5.0)));
  EXPECT_TRUE(std::isnan(level_at(5.0, 9.0 - 1e-9)));
  EXPECT_TRUE(std::isnan(level_at(-0.1, 5.0)));
}

// -- learn_circles

struct Circles {
  const char* name;
  Pattern pattern;
  std::vector<double> radii;
};

class LearnCircles : public testing::TestWithParam<Circles> {};

TEST_P(LearnCircles, FindsAllCirclesInBothPolarities) {
  for (const bool is_bright : {false, true}) {
    const GrayPicture picture = rendered(scene_of(GetParam().pattern, is_bright), kPad);
    const auto model = learn_circles(picture.view(), image_from_pad(kPad));
    ASSERT_TRUE(model) << is_bright;
    ASSERT_EQ(model->circles.size(), GetParam().radii.size()) << is_bright;
    EXPECT_TRUE(model->lines.empty());
    EXPECT_EQ(model->circles[0].radius, 1.0);
    const double contrast = is_bright ? 125.0 : 145.0;
    for (std::size_t i = 0; i < model->circles.size(); ++i) {
      const PadCircle& circle = model->circles[i];
      EXPECT_NEAR(circle.radius, GetParam().radii[i], 0.01) << is_bright << i;
      EXPECT_EQ(circle.is_bright_outside, (i % 2 == 0) != is_bright) << i;
      // Blur reduces it.
      EXPECT_NEAR(circle.contrast, 0.75 * contrast, 0.2 * contrast) << is_bright << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Patterns,
    LearnCircles,
    testing::Values(Circles{"ring", Pattern::kRing, {1.0, kInner}},
                    Circles{"disc", Pattern::kDisc, {1.0}},
                    Circles{"bullseye",
                            Pattern::kBullseye,
                            {1.0, kInner, 0.75 * kInner, 0.5 * kInner, 0.25 * kInner}},
                    Circles{"x", Pattern::kRingX, {1.0, kInner}},
                    Circles{"h", Pattern::kRingH, {1.0, kInner}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(LearnCirclesFrom, AnOutlineOffByAFewPercent) {
  const GrayPicture picture = rendered(scene_of(Pattern::kRing), kPad);
  for (const double factor : {0.96, 1.04}) {
    const auto model = learn_circles(picture.view(), image_from_pad(resized(kPad, factor)));
    ASSERT_TRUE(model) << factor;
    ASSERT_EQ(model->circles.size(), 2U) << factor;
    EXPECT_NEAR(model->circles[1].radius, kInner, 0.02) << factor;
  }
}

TEST(LearnCirclesFrom, TheOuterEdgeOfAThinRing) {
  for (const double ring_width : {0.1, 0.055}) {
    for (const bool is_bright : {false, true}) {
      Scene scene = scene_of(Pattern::kRing, is_bright);
      scene.pad.ring_width = ring_width;
      const GrayPicture picture = rendered(scene, kPad);
      for (const double factor : {0.985, 1.0, 1.015}) {
        const auto model = learn_circles(picture.view(), image_from_pad(resized(kPad, factor)));
        ASSERT_TRUE(model) << ring_width << is_bright << factor;
        EXPECT_EQ(model->circles[0].is_bright_outside, !is_bright) << ring_width << factor;
        ASSERT_EQ(model->circles.size(), 2U) << ring_width << is_bright << factor;
        EXPECT_NEAR(model->circles[1].radius, 1.0 - ring_width, 0.015) << is_bright << factor;
      }
    }
  }
}

TEST(LearnCirclesFrom, NoOutlineOfBothPolarities) {
  for (int x = 0; x < 60; ++x) {
    const Ellipse ball{130.3 + x, 120.6, 50.0, 50.0, 0.0};
    const GrayPicture picture = support::lit_ball(ball, 320, 240);
    EXPECT_FALSE(learn_circles(picture.view(), image_from_pad(ball))) << x;
  }
}

TEST(LearnCirclesFrom, AGivenRingRatio) {
  // Too coarse to resolve the ring.
  Scene scene = scene_of(Pattern::kRing, false);
  scene.pad.ring_width = 0.06;
  const Ellipse small{160.0, 120.0, 14.0, 12.0, 0.3};
  const GrayPicture picture = rendered(scene, small);
  const Matrix3d view = image_from_pad(small);
  const auto given = learn_circles(picture.view(), view, 0.94);
  ASSERT_TRUE(given);
  ASSERT_GE(given->circles.size(), 2U);
  EXPECT_EQ(given->circles[1].radius, 0.94);
  EXPECT_TRUE(given->circles[1].is_given);
  EXPECT_NE(given->circles[1].is_bright_outside, given->circles[0].is_bright_outside);
  // A resolved ring does not get a second inner circle.
  const GrayPicture large = rendered(scene_of(Pattern::kRing), kPad);
  const auto model = learn_circles(large.view(), image_from_pad(kPad), kInner + 0.004);
  ASSERT_TRUE(model);
  ASSERT_EQ(model->circles.size(), 2U);
  EXPECT_EQ(model->circles[1].radius, kInner + 0.004);
}

// Two steps in the same direction: the search could take one edge for the other.
TEST(LearnCirclesFrom, StepsThatAreFarEnoughApart) {
  GrayPicture picture(320, 240, 200);
  const Matrix3d from_picture = image_from_pad(kPad).inverse();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double radius = (from_picture * Eigen::Vector3d(x, y, 1.0)).hnormalized().norm();
      if (radius < 1.0) picture.at(x, y) = radius < 0.85 ? 60 : 130;
    }
  }
  const auto both = learn_circles(picture.view(), image_from_pad(kPad), 0.0, 0.14);
  ASSERT_TRUE(both);
  ASSERT_EQ(both->circles.size(), 2U);
  EXPECT_NEAR(both->circles[1].radius, 0.85, 0.01);
  EXPECT_EQ(both->circles[1].is_bright_outside, both->circles[0].is_bright_outside);
  const auto one = learn_circles(picture.view(), image_from_pad(kPad), 0.0, 0.16);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->circles.size(), 1U);
}

TEST(LearnCirclesFrom, ThePartInsideThePicture) {
  const Ellipse half_out = translated(kPad, -150.0, 0.0);
  const GrayPicture picture = rendered(scene_of(Pattern::kRing), half_out);
  const auto model = learn_circles(picture.view(), image_from_pad(half_out));
  ASSERT_TRUE(model);
  ASSERT_EQ(model->circles.size(), 2U);
  EXPECT_NEAR(model->circles[1].radius, kInner, 0.01);
}

TEST(LearnCirclesFrom, FlatOrOutsideRegionsGivesNothing) {
  const Matrix3d view = image_from_pad(kPad);
  EXPECT_FALSE(learn_circles(flat_picture().view(), view));
  const GrayPicture picture = rendered(scene_of(Pattern::kRing), kPad);
  EXPECT_FALSE(learn_circles(picture.view(), image_from_pad(translated(kPad, 400.0, 0.0))));
  EXPECT_FALSE(learn_circles(picture.view(), image_from_pad(resized(kPad, 0.5))));
  EXPECT_FALSE(learn_circles(ImageView{}, view));
  EXPECT_FALSE(learn_circles(GrayPicture(1, 1, 90).view(), view));
}

TEST(LearnCirclesFrom, AnEllipseBelowAPixelGivesNothing) {
  const GrayPicture picture = rendered(scene_of(Pattern::kRing), kPad);
  EXPECT_FALSE(learn_circles(picture.view(), image_from_pad({160.0, 120.0, 0.3, 0.2, 0.0})));
}

// -- LineLearner

// Whether a point is on the strokes inside the ring, by the dimensions of Pad.
bool is_on_mark(Pattern pattern, const Vector2d& point) {
  const Pad pad;
  const double half_width = 0.5 * pad.mark_width;
  const auto is_in = [&](double along, double across, double half_length) {
    return std::abs(along) <= half_length && std::abs(across) <= half_width;
  };
  const double x = point.x();
  const double y = point.y();
  if (pattern == Pattern::kRingX) {
    const double falling = std::numbers::sqrt2 / 2.0 * (x + y);
    const double rising = std::numbers::sqrt2 / 2.0 * (x - y);
    return is_in(falling, rising, pad.mark_length) || is_in(rising, falling, pad.mark_length);
  }
  constexpr double kBarAt = 0.36;
  const double upright = 0.8 * pad.mark_length;
  return is_in(y, x - kBarAt, upright) || is_in(y, x + kBarAt, upright) || is_in(x, y, kBarAt);
}

void learn_at_once(LineLearner& learner,
                   const ImageView& luma,
                   const Ellipse& pad,
                   PadModel& model) {
  learner.reserve(model);
  learner.start();
  while (!learner.is_ready()) learner.take(luma, image_from_pad(pad));
  learner.learn(model, 1.0);
}

struct Learned {
  explicit Learned(const Scene& scene, const Ellipse& pad = kPad) {
    picture = rendered(scene, pad);
    model = learn_circles(picture.view(), image_from_pad(pad)).value();
    learn_at_once(learner, picture.view(), pad, model);
  }
  GrayPicture picture{0, 0};
  PadModel model;
  LineLearner learner;
};

double total_length(const PadModel& model) {
  double sum = 0.0;
  for (const PadLine& line : model.lines) sum += (line.to - line.from).norm();
  return sum;
}

// The top view may be brighter than the picture that the circles were learned from.
TEST(LineLearner, LearnsInTheModelsContrast) {
  Learned learned(scene_of(Pattern::kRingX, true));
  const double contrast = learned.model.lines.front().contrast;
  learned.learner.learn(learned.model, 2.0);
  ASSERT_FALSE(learned.model.lines.empty());
  EXPECT_NEAR(learned.model.lines.front().contrast, 0.5 * contrast, 1e-6);
}

class LearnLines : public testing::TestWithParam<Pattern> {};

TEST_P(LearnLines, FindsOnlyTheStrokes) {
  constexpr double kBeside = 0.025;
  for (const bool is_bright : {false, true}) {
    const Learned learned(scene_of(GetParam(), is_bright));
    EXPECT_GE(learned.model.lines.size(), 8U);
    for (const PadLine& line : learned.model.lines) {
      EXPECT_NEAR(line.to_bright.norm(), 1.0, 1e-9);
      // All strokes run in directions that are eighths of a turn apart.
      const double turn = std::atan2(line.to_bright.y(), line.to_bright.x());
      const double off = std::remainder(turn, 0.25 * std::numbers::pi);
      EXPECT_LT(std::abs(off) * (line.to - line.from).norm(), 0.004) << line.from.transpose();
      EXPECT_NEAR(line.contrast, is_bright ? 94.0 : 109.0, 30.0);
      for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vector2d point = line.from + at * (line.to - line.from);
        const bool is_painted = is_on_mark(GetParam(), point + kBeside * line.to_bright);
        EXPECT_EQ(is_painted, is_bright) << point.transpose();
        EXPECT_NE(is_on_mark(GetParam(), point - kBeside * line.to_bright), is_painted)
            << point.transpose();
      }
    }
    // Most of the mark's outline: about 5 radii for both marks.
    EXPECT_GT(total_length(learned.model), 3.3);
    EXPECT_LT(total_length(learned.model), 6.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Marks,
                         LearnLines,
                         testing::Values(Pattern::kRingX, Pattern::kRingH),
                         [](const auto& info) {
                           return info.param == Pattern::kRingX ? "x" : "h";
                         });

TEST(LineLearner, FindsNoLineInCircles) {
  for (const Pattern pattern : {Pattern::kRing, Pattern::kDisc, Pattern::kBullseye}) {
    EXPECT_TRUE(Learned(scene_of(pattern)).model.lines.empty()) << static_cast<int>(pattern);
    const Ellipse half_out = translated(kPad, -150.0, 30.0);
    EXPECT_TRUE(Learned(scene_of(pattern), half_out).model.lines.empty())
        << static_cast<int>(pattern);
  }
}

TEST(LineLearner, ReplacesEarlierLines) {
  Learned learned(scene_of(Pattern::kRingX));
  ASSERT_FALSE(learned.model.lines.empty());
  const GrayPicture ring = rendered(scene_of(Pattern::kRing), kPad);
  learn_at_once(learned.learner, ring.view(), kPad, learned.model);
  EXPECT_TRUE(learned.model.lines.empty());
}

// Each part is from a different frame, with the pad at another position.
TEST(LineLearner, CombinesFramesOfAMovingPad) {
  const Learned at_once(scene_of(Pattern::kRingX));
  Learned in_motion(scene_of(Pattern::kRingX));
  in_motion.learner.start();
  int frames = 0;
  while (!in_motion.learner.is_ready()) {
    const Ellipse pad = translated(kPad, 3.0 * frames, -2.0 * frames);
    const GrayPicture picture = rendered(scene_of(Pattern::kRingX), pad);
    in_motion.learner.take(picture.view(), image_from_pad(pad));
    ++frames;
  }
  EXPECT_GT(frames, 4);
  in_motion.learner.learn(in_motion.model, 1.0);
  EXPECT_EQ(in_motion.model.lines.size(), at_once.model.lines.size());
  EXPECT_NEAR(total_length(in_motion.model), total_length(at_once.model), 0.1);
}

TEST(LineLearner, KeepsTheLongestLines) {
  Scene scene = scene_of(Pattern::kRing);
  for (int i = -6; i <= 6; ++i) {
    const double x = 160.0 + 7.0 * i;
    const double half = 15.0 + 2.0 * std::abs(i);
    scene.bars.push_back(support::bar_px({x, 120.0 - half}, {x, 120.0 + half}, 3.0, 40.0));
  }
  const Learned learned(scene, {160.0, 120.0, 90.0, 90.0, 0.0});
  ASSERT_EQ(learned.model.lines.size(), LineLearner::kMaxLines);
  double shortest = 2.0;
  for (const PadLine& line : learned.model.lines) {
    shortest = std::min(shortest, (line.to - line.from).norm());
  }
  // The short lines in the middle are omitted.
  EXPECT_GT(shortest, 30.0 / 90.0 - 0.04);
}

TEST(LineLearner, FindsNothingInEmptyAndTinyPictures) {
  LineLearner learner;
  for (const int size : {0, 1, 2, 7}) {
    PadModel model = ring_model();
    learn_at_once(learner, GrayPicture(size, size, 200).view(), kPad, model);
    EXPECT_TRUE(model.lines.empty()) << size;
  }
}

// -- EdgeSearch

TEST(EdgeSearch, PlacesSamplesInsideThePictureOnly) {
  const PadModel model = Learned(scene_of(Pattern::kRingX)).model;
  EdgeSearch search;
  for (const double dx : {-160.0, -90.0, 120.0, 200.0}) {
    const Ellipse e = translated(kPad, dx, 40.0);
    search.sample(model, image_from_pad(e), GrayPicture(320, 240).view());
    EXPECT_FALSE(search.samples().empty()) << dx;
    for (const EdgeSample& sample : search.samples()) {
      EXPECT_GE(sample.view.point.minCoeff(), 2.99);
      EXPECT_LE(sample.view.point.x(), 316.01);
      EXPECT_LE(sample.view.point.y(), 236.01);
    }
    EXPECT_NEAR(search.visible_fraction(), visible_fraction(e, 320, 240), 0.06) << dx;
  }
}

TEST(EdgeSearch, DistributesSamplesByTheLengthOfTheEdges) {
  const PadModel model = Learned(scene_of(Pattern::kRingX)).model;
  EdgeSearch search;
  search.sample(model, image_from_pad(kPad), GrayPicture(320, 240).view());
  EXPECT_NEAR(static_cast<double>(search.samples().size()), EdgeSearch::kSamples, 14.0);
  std::vector<double> outer_angles;
  int inner = 0;
  int on_lines = 0;
  const Matrix3d pad_from_image = image_from_pad(kPad).inverse();
  for (const EdgeSample& sample : search.samples()) {
    const Vector2d pad_point = (pad_from_image * sample.view.point.homogeneous()).hnormalized();
    if (sample.feature == 0) outer_angles.push_back(std::atan2(pad_point.y(), pad_point.x()));
    inner += sample.feature == 1 ? 1 : 0;
    on_lines += sample.feature >= 2 ? 1 : 0;
  }
  const auto outer = static_cast<double>(outer_angles.size());
  EXPECT_NEAR(inner / outer, kInner, 0.1);
  EXPECT_NEAR(on_lines / outer, total_length(model) / (2.0 * std::numbers::pi), 0.25);
  std::sort(outer_angles.begin(), outer_angles.end());
  outer_angles.push_back(outer_angles.front() + 2.0 * std::numbers::pi);
  for (std::size_t i = 1; i < outer_angles.size(); ++i) {
    const double gap = (outer_angles[i] - outer_angles[i - 1]) * outer / (2.0 * std::numbers::pi);
    EXPECT_GT(gap, 0.4) << i;
    EXPECT_LT(gap, 1.8) << i;
  }
}

TEST(EdgeSearch, PlacesThePredictedNumberOfSamples) {
  PadModel model = ring_model();
  for (const double radius : {0.6, 0.4, 0.2}) model.circles.push_back({radius, true, 100.0});
  const GrayPicture picture(2000, 2000);
  for (const double radius_px : {40.0, 900.0, 5000.0}) {
    EdgeSearch search;
    search.sample(
        model, image_from_pad({1000.0, 900.0, radius_px, 0.9 * radius_px, 0.2}), picture.view());
    EXPECT_NEAR(static_cast<double>(search.samples().size()), EdgeSearch::kSamples, 6.0);
  }
}

TEST(EdgeSearch, MeasuresTheOffsetsOfTheEdges) {
  for (const bool is_bright : {false, true}) {
    const GrayPicture picture = rendered(scene_of(Pattern::kRing, is_bright), kPad);
    const auto model = learn_circles(picture.view(), image_from_pad(kPad)).value();
    for (const Vector2d& shift : {Vector2d(2.0, 0.0), Vector2d(-2.0, 0.0), Vector2d(1.4, -1.4)}) {
      const Ellipse expected = translated(kPad, shift.x(), shift.y());
      EdgeSearch search;
      search.sample(model, image_from_pad(expected), picture.view());
      search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 5.0);
      for (const EdgeSample& sample : search.samples()) {
        ASSERT_TRUE(sample.is_visible);
        ASSERT_EQ(sample.count, 1);
        const double off = -shift.dot(sample.view.normal);
        // Circles are learned to half a percent: 0.2 px of the inner one.
        EXPECT_NEAR(sample.candidates[0].distance_px, off, 0.3) << sample.feature;
        EXPECT_NEAR(sample.candidates[0].contrast / sample.contrast, 1.0, 0.3);
      }
    }
  }
}

TEST(EdgeSearch, IgnoresEdgesOfTheOtherSign) {
  const GrayPicture picture = rendered(scene_of(Pattern::kDisc), kPad);
  PadModel model = disc_model();
  EdgeSearch search;
  const auto matched_samples = [&] {
    search.sample(model, image_from_pad(kPad), picture.view());
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 6.0);
    return std::count_if(search.samples().begin(),
                         search.samples().end(),
                         [](const EdgeSample& sample) { return sample.count > 0; });
  };
  const auto all = matched_samples();
  EXPECT_GT(all, 50);
  EXPECT_EQ(all, static_cast<std::ptrdiff_t>(search.samples().size()));
  model.circles[0].is_bright_outside = false;
  EXPECT_EQ(matched_samples(), 0);
}

TEST(EdgeSearch, IgnoresEdgesTooWeakForTheLight) {
  Scene faint = scene_of(Pattern::kDisc);
  faint.pad.paint_level = faint.ground.level - 20.0;
  const GrayPicture picture = rendered(faint, kPad);
  EdgeSearch search;
  search.sample(disc_model(), image_from_pad(kPad), picture.view());
  search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 6.0);
  for (const EdgeSample& sample : search.samples()) EXPECT_EQ(sample.count, 0);
  search.search(picture.view(), {0.1, pixel_noise(picture.view())}, 6.0);
  for (const EdgeSample& sample : search.samples()) EXPECT_EQ(sample.count, 1);
}

// Of a model on a picture of a pad at kPad.
HomographySupport support_in(const GrayPicture& picture, const PadModel& model) {
  EdgeSearch search;
  search.sample(model, image_from_pad(kPad), picture.view());
  search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 4.0);
  return support_of(
      search.samples(), HomographyChange::Zero(), 1.5, static_cast<int>(model.circles.size()));
}

// A shadow leaves .3 of the light, and of the contrast.
TEST(EdgeSearch, SeesEdgesInShadow) {
  GrayPicture picture = rendered(scene_of(Pattern::kRing), kPad);
  const PadModel model = learn_circles(picture.view(), image_from_pad(kPad)).value();
  const HomographySupport lit = support_in(picture, model);
  EXPECT_NEAR(lit.gain / lit.relative_gain, plain_ring().ground.level, 5.0);
  for (std::uint8_t& level : picture.pixels) level = static_cast<std::uint8_t>(0.3 * level);
  const double noise = pixel_noise(picture.view());
  for (const bool knows_light : {true, false}) {
    EdgeSearch search;
    search.sample(model, image_from_pad(kPad), picture.view());
    search.search(picture.view(), {1.0, noise, knows_light ? lit.relative_gain : 0.0}, 5.0);
    for (const EdgeSample& sample : search.samples()) EXPECT_EQ(sample.count, knows_light ? 1 : 0);
  }
}

// Blur also reduces the contrast, but the picture is as bright as before beside the edge.
TEST(EdgeSearch, DoesNotTakeBlurForShadow) {
  constexpr int kBlurPx = 12;
  GrayPicture picture = rendered(scene_of(Pattern::kDisc), kPad);
  const PadModel model = learn_circles(picture.view(), image_from_pad(kPad)).value();
  const double relative_gain = support_in(picture, model).relative_gain;
  cv::Mat pixels(picture.height, picture.width, CV_8UC1, picture.pixels.data());
  cv::blur(pixels, pixels, {kBlurPx, 1});
  EdgeSearch search;
  search.sample(model, image_from_pad(kPad), picture.view());
  search.search(picture.view(), {1.0, pixel_noise(picture.view()), relative_gain}, kBlurPx);
  int at_sides = 0;
  for (const EdgeSample& sample : search.samples()) {
    if (std::abs(sample.view.normal.x()) < 0.9) continue;
    ++at_sides;
    EXPECT_EQ(sample.count, 0) << sample.view.point.transpose();
  }
  EXPECT_GT(at_sides, 10);
}

// Of a disc as faint as the noise, chance matches are few.
TEST(EdgeSearch, IgnoresNoise) {
  Scene flat = scene_of(Pattern::kDisc);
  flat.pad.paint_level = flat.ground.level;
  PadModel model = disc_model();
  model.circles[0].contrast = 8.0;
  for (const double noise : {4.0, 8.0, 16.0}) {
    flat.sensor.read_noise = noise;
    const GrayPicture picture = rendered(flat, kPad);
    EdgeSearch search;
    search.sample(model, image_from_pad(kPad), picture.view());
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 2.0);
    const auto matched = std::count_if(search.samples().begin(),
                                       search.samples().end(),
                                       [](const EdgeSample& sample) { return sample.count > 0; });
    EXPECT_LT(static_cast<double>(matched), 0.2 * static_cast<double>(search.samples().size()))
        << noise;
  }
}

TEST(EdgeSearch, SearchesAsFarAsTheCovariance) {
  const GrayPicture picture = rendered(scene_of(Pattern::kDisc), kPad);
  const Ellipse expected = translated(kPad, 7.0, 0.0);
  EdgeSearch search;
  search.sample(disc_model(), image_from_pad(expected), picture.view());
  const auto matched_at_sides = [&](const HomographyCovariance& covariance, double max_px) {
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 3.0, &covariance, max_px);
    int matched = 0;
    for (const EdgeSample& sample : search.samples()) {
      matched += std::abs(sample.view.normal.x()) > 0.8 && sample.count > 0 ? 1 : 0;
    }
    return matched;
  };
  HomographyCovariance covariance = HomographyCovariance::Zero();
  EXPECT_EQ(matched_at_sides(covariance, 12.0), 0);
  covariance(0, 0) = covariance(1, 1) = std::pow(0.05, 2);  // 3 px
  EXPECT_GT(matched_at_sides(covariance, 12.0), 10);
  EXPECT_EQ(matched_at_sides(covariance, 4.0), 0);
  // Only rounding can produce such a covariance.
  covariance = -HomographyCovariance::Identity();
  EXPECT_EQ(matched_at_sides(covariance, 12.0), 0);
}

TEST(EdgeSearch, KeepsTheStrongestEdgesFirst) {
  GrayPicture picture(120, 60, 20);
  const int steps[] = {30, 40, 50, 60, 70, 80};
  const int rises[] = {10, 60, 20, 40, 30, 15};
  for (int y = 0; y < 60; ++y) {
    int level = 20;
    for (int x = 0, next = 0; x < 120; ++x) {
      if (next < 6 && x == steps[next]) level += rises[next++];
      picture.at(x, y) = static_cast<std::uint8_t>(level);
    }
  }
  PadModel model = disc_model();
  model.circles.clear();
  model.lines.push_back({{0.0, -1.0}, {0.0, 1.0}, {1.0, 0.0}, 10.0});
  EdgeSearch search;
  search.sample(model, image_from_pad({55.0, 30.0, 20.0, 20.0, 0.0}), picture.view());
  search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 40.0);
  ASSERT_FALSE(search.samples().empty());
  for (const EdgeSample& sample : search.samples()) {
    ASSERT_EQ(sample.count, 3);
    EXPECT_NEAR(sample.candidates[0].distance_px, 39.5 - 55.0, 1.0);
    EXPECT_NEAR(sample.candidates[1].distance_px, 59.5 - 55.0, 1.0);
    EXPECT_NEAR(sample.candidates[2].distance_px, 69.5 - 55.0, 1.0);
  }
}

TEST(EdgeSearch, StaysInsideLargePictures) {
  // Steps along a normal accumulate in floats, which are coarse at large coordinates.
  GrayPicture picture(31, 12'000, 200);
  for (int y = 11'960; y < 12'000; ++y) {
    for (int x = 0; x < 31; ++x) picture.at(x, y) = 40;
  }
  PadModel model = disc_model();
  model.circles.clear();
  model.lines.push_back({{-1.0, 0.0}, {1.0, 0.0}, {0.0, -1.0}, 100.0});
  int matched = 0;
  for (int i = 0; i < 200; ++i) {
    const double y = 11'970.0 + 0.1 * i;
    EdgeSearch search;
    search.sample(model, image_from_pad({15.0, y, 10.0, 9.9, 0.001 * i}), picture.view());
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 20.0 + 0.2 * i);
    for (const EdgeSample& sample : search.samples()) {
      if (sample.count == 0) continue;
      ++matched;
      EXPECT_NEAR(sample.candidates[0].distance_px, sample.view.point.y() - 11'959.5, 3.0);
    }
  }
  EXPECT_GT(matched, 100);
}

TEST(EdgeSearch, PlacesNoSampleInEmptyAndTinyPictures) {
  EdgeSearch search;
  for (const int size : {0, 1, 2, 6}) {
    const GrayPicture picture(size, size, 90);
    search.sample(ring_model(), image_from_pad({0.0, 0.0, 3.0, 2.0, 0.0}), picture.view());
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, 4.0);
    EXPECT_TRUE(search.samples().empty()) << size;
    EXPECT_EQ(search.visible_fraction(), 0.0) << size;
  }
}

// -- solve_homography

HomographyPrior weak_prior() {
  HomographyPrior prior;
  prior.information.diagonal() << 1e2, 1e2, 1e2, 1e2, 1e2, 1e4, 1e4, 1e4;
  return prior;
}

// A ring, searched at a position displaced by a change.
struct SearchedRing {
  explicit SearchedRing(const HomographyChange& off, double reach_px = 10.0)
      : picture(rendered(scene_of(Pattern::kRing), kPad)), start(moved(image_from_pad(kPad), off)) {
    search.sample(ring_model(), start, picture.view());
    search.search(picture.view(), {1.0, pixel_noise(picture.view())}, reach_px);
  }
  [[nodiscard]] double error_px(const HomographyChange& change) const {
    return max_difference_px(project_circle(moved(start, change), 1.0).value(), kPad);
  }
  GrayPicture picture;
  Matrix3d start;
  EdgeSearch search;
};

TEST(SolvePose, FindsShiftGrowthAndStretch) {
  for (const int i : {0, 1, 2, 3, 4}) {
    for (const double size : {-0.06, 0.06}) {
      const SearchedRing searched(size * HomographyChange::Unit(i));
      const auto estimate =
          solve_homography(searched.search.samples(), weak_prior(), {12.0, 12.0, 0.6});
      ASSERT_TRUE(estimate);
      EXPECT_GT(searched.error_px(HomographyChange::Zero()), 1.0) << i;
      // The rows are linearised: a few hundredths of the change remain.
      EXPECT_LT(searched.error_px(estimate->change), 0.35) << i;
      EXPECT_NEAR(estimate->change(i), -size, 0.1 * std::abs(size)) << i;
    }
  }
}

TEST(SolvePose, ReportsItsInformation) {
  const SearchedRing searched(HomographyChange::Zero());
  const auto at = [&](double sigma_px) {
    return solve_homography(searched.search.samples(), weak_prior(), {6.0, 6.0, sigma_px})
        ->information;
  };
  const HomographyCovariance fine = at(0.5) - weak_prior().information;
  const HomographyCovariance coarse = at(1.0) - weak_prior().information;
  EXPECT_NEAR(fine(2, 2) / coarse(2, 2), 4.0, 1e-4);
  // Rings carry no information on their rotation.
  EXPECT_LT(fine(5, 5), 1e-3 * fine(2, 2));
}

TEST(SolvePose, RespectsAStrongPrior) {
  const SearchedRing searched(0.05 * HomographyChange::Unit(0) - 0.04 * HomographyChange::Unit(1));
  HomographyPrior prior = weak_prior();
  prior.information(0, 0) = 1e12;
  prior.mean(0) = 0.01;
  const auto estimate = solve_homography(searched.search.samples(), prior, {12.0, 12.0, 0.6});
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->change(0), 0.01, 1e-4);
  EXPECT_NEAR(estimate->change(1), 0.04, 0.005);
}

TEST(SolvePose, IgnoresEdgesOutOfReach) {
  const SearchedRing searched(0.06 * HomographyChange::Unit(2));  // all edges are 3 px off or more
  const auto estimate = solve_homography(searched.search.samples(), weak_prior(), {2.0, 2.0, 0.6});
  ASSERT_TRUE(estimate);
  EXPECT_LT(estimate->change.norm(), 1e-6);
}

TEST(SolvePose, KnowsLittleFromMatchesByChance) {
  const SearchedRing searched(HomographyChange::Zero());
  const std::span<const EdgeSample> found = searched.search.samples();
  HomographyPrior prior;
  prior.information.diagonal().setConstant(1e4);
  const MatchLimits with_scatter{4.0, 4.0, 0.6, true};
  const auto true_view = solve_homography(found, prior, with_scatter);
  ASSERT_TRUE(true_view);
  EXPECT_NEAR(true_view->precision, 1.0 / 0.36, 0.1 / 0.36);

  std::mt19937 random(3);
  std::uniform_real_distribution<float> anywhere(-4.0F, 4.0F);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<EdgeSample> samples(found.begin(), found.end());
    for (EdgeSample& sample : samples) {
      sample.count = 1;
      sample.candidates[0] = {.distance_px = anywhere(random), .contrast = sample.contrast};
    }
    const auto estimate = solve_homography(samples, prior, with_scatter);
    ASSERT_TRUE(estimate);
    EXPECT_LT(estimate->precision, 0.1 / 0.36) << trial;
    const HomographyCovariance matches = estimate->information - prior.information;
    const HomographyCovariance of_true_view = true_view->information - prior.information;
    EXPECT_LT(matches.trace(), 0.1 * of_true_view.trace()) << trial;
    EXPECT_DOUBLE_EQ(solve_homography(samples, prior, {4.0, 4.0, 0.6})->precision, 1.0 / 0.36)
        << trial;
  }
}

TEST(SolvePose, FailsWithoutInformation) {
  EXPECT_FALSE(solve_homography({}, {}, {5.0, 5.0, 0.6}));
  const SearchedRing searched(HomographyChange::Zero());
  HomographyPrior broken = weak_prior();
  broken.mean(3) = std::nan("");
  EXPECT_FALSE(solve_homography(searched.search.samples(), broken, {5.0, 5.0, 0.6}));
}

TEST(NearestCandidate, IsNearestToThePrediction) {
  EdgeSample sample;
  EXPECT_EQ(nearest_candidate(sample, 0.0), nullptr);
  sample.candidates = {{{4.0F, 50.0F}, {-2.0F, 40.0F}, {0.5F, 30.0F}}};
  sample.count = 2;
  EXPECT_EQ(nearest_candidate(sample, 0.0), &sample.candidates[1]);
  EXPECT_EQ(nearest_candidate(sample, 1.5), &sample.candidates[0]);
  sample.count = 3;
  EXPECT_EQ(nearest_candidate(sample, 0.0), &sample.candidates[2]);
}

TEST(Support, DecreasesWithTheErrorOfTheView) {
  const SearchedRing searched(HomographyChange::Zero());
  const auto samples = searched.search.samples();
  double coverage = 2.0;
  for (const double off : {0.0, 0.03, 0.06, 0.2}) {
    const HomographyChange change = off * HomographyChange::Unit(0);
    const HomographySupport support = support_of(samples, change, 1.5, 2);
    EXPECT_EQ(support.visible, static_cast<int>(samples.size()));
    EXPECT_LT(support.coverage, coverage) << off;
    coverage = support.coverage;
    if (off > 0.0) continue;
    EXPECT_EQ(support.coverage, 1.0);
    EXPECT_TRUE(support.has_circles);
    EXPECT_NEAR(support.gain, 0.75, 0.15);
  }
  EXPECT_LT(coverage, 0.3);
}

// Of a model on a picture of a pad at kPad.
HomographySupport support_on(Pattern pattern, const PadModel& model) {
  return support_in(rendered(scene_of(pattern), kPad), model);
}

// Two matches on each circle: one as expected, one .8 px farther out.
TEST(ModelUpdates, MoveInnerRadiiTowardsTheirMatches) {
  PadModel model = ring_model();
  model.circles.push_back({0.3, true, 145.0, true});
  std::vector<EdgeSample> samples;
  for (int feature = 0; feature < 3; ++feature) {
    for (const float beside_px : {0.0F, 0.8F}) {
      EdgeSample& sample = samples.emplace_back();
      sample.view.px_per_unit = 50.0;
      sample.view.row.setZero();
      sample.feature = feature;
      const float sign =
          model.circles[static_cast<std::size_t>(feature)].is_bright_outside ? 1.0F : -1.0F;
      sample.candidates[0] = {sign * beside_px, 100.0F, 200.0F};
      sample.count = 1;
    }
  }
  const PadModel before = model;
  update_radii(model, samples, HomographyChange::Zero(), 0.5, 1000.0);
  EXPECT_EQ(model.circles[0].radius, before.circles[0].radius) << "the unit";
  EXPECT_NEAR(model.circles[1].radius, before.circles[1].radius + 0.5 * 0.4 / 50.0, 1e-6);
  EXPECT_EQ(model.circles[2].radius, before.circles[2].radius) << "given";
}

TEST(ModelUpdates, DropLinesThatAreMostlyUnmatched) {
  PadModel model = disc_model();
  model.lines.resize(2);
  std::vector<EdgeSample> samples;
  for (const int feature : {1, 2}) {
    for (int i = 0; i < 20; ++i) {
      EdgeSample& sample = samples.emplace_back();
      sample.view.row.setZero();
      sample.feature = feature;
      sample.is_visible = true;
      sample.candidates[0] = {feature == 1 ? 5.0F : 0.5F, 100.0F, 200.0F};
      sample.count = 1;
    }
  }
  drop_refuted_lines(model, samples, HomographyChange::Zero(), 2.0);
  ASSERT_EQ(model.lines.size(), 1U);
  EXPECT_EQ(model.lines[0].matched, 20);
}

TEST(Support, ReportsAMissingCircle) {
  PadModel model = disc_model();
  model.circles.push_back({0.4, true, 145.0});
  const HomographySupport support = support_on(Pattern::kDisc, model);
  EXPECT_FALSE(support.has_circles);
  EXPECT_NEAR(support.coverage, 1.0 / 1.4, 0.05);
}

TEST(Support, ToleratesAMissingCircleInsideAMatchedRing) {
  PadModel model = ring_model();
  model.circles.push_back({0.4, true, 145.0});
  const HomographySupport support = support_on(Pattern::kRing, model);
  EXPECT_TRUE(support.has_circles);
  EXPECT_NEAR(support.coverage, (1.0 + kInner) / (1.4 + kInner), 0.05);
}

TEST(Support, ToleratesAMissingCircleAroundMatchedLines) {
  PadModel model = Learned(scene_of(Pattern::kRingX)).model;
  ASSERT_FALSE(model.lines.empty());
  model.circles = disc_model().circles;
  model.circles.push_back({0.9, true, 145.0});
  EXPECT_TRUE(support_on(Pattern::kRingX, model).has_circles);
  model.lines.clear();
  EXPECT_FALSE(support_on(Pattern::kRingX, model).has_circles);
}

TEST(Support, NeedsTheOuterCircle) {
  PadModel model = ring_model();
  model.circles[0].is_bright_outside = false;
  const HomographySupport support = support_on(Pattern::kRing, model);
  EXPECT_EQ(support.outer_coverage, 0.0);
  EXPECT_FALSE(support.has_circles);
}

TEST(LineOf, IsNoCircleAndNoRemovedLine) {
  PadModel model = ring_model();
  model.lines.resize(2);
  EXPECT_EQ(line_of(model, 0), nullptr);
  EXPECT_EQ(line_of(model, 1), nullptr);
  EXPECT_EQ(line_of(model, 3), &model.lines[1]);
  EXPECT_EQ(line_of(model, 4), nullptr);
  model.lines.clear();
  EXPECT_EQ(line_of(model, 3), nullptr);
}

// An inner circle that is the only edge: the view errs by the error of its radius, however many
// samples and frames there are.
TEST(ModelErrors, DoNotFallWithTheNumberOfSamplesOrFrames) {
  const SearchedRing searched(HomographyChange::Zero());
  std::vector<EdgeSample> inner;
  for (const EdgeSample& sample : searched.search.samples()) {
    if (sample.feature == 1) inner.push_back(sample);
  }
  PadModel model = ring_model();
  HomographyPrior prior = weak_prior();
  prior.information *= 1e-4;
  double sigma = 0.0;
  for (int frame = 0; frame < 20; ++frame) {
    const auto estimate = solve_homography(inner, prior, {6.0, 6.0, 0.6});
    ASSERT_TRUE(estimate);
    const HomographyCovariance covariance = inverse_of(estimate->information);
    propagate_model_errors(
        model, inner, {estimate->change, covariance, prior.information, 6.0, estimate->precision});
    const double now = std::sqrt(model_error_covariance(model)(2, 2));
    if (frame > 0) {
      EXPECT_NEAR(now, sigma, 0.01 * sigma) << frame;
    }
    sigma = now;
    prior = {HomographyChange::Zero(), estimate->information};
  }
  EXPECT_NEAR(sigma, 0.0014 / model.circles[1].radius, 0.0001);
  RingGain gain = RingGain::Zero();
  gain.topRows<5>().diagonal().setConstant(0.75);
  reduce_model_errors(model, gain);
  EXPECT_NEAR(std::sqrt(model_error_covariance(model)(2, 2)), 0.25 * sigma, 1e-9);
  gain.topRows<5>().setIdentity();
  reduce_model_errors(model, gain);
  EXPECT_EQ(model_error_covariance(model)(2, 2), 0.0) << "by an exact measurement";
}

// With an uncertain velocity; its position and velocity are correlated.
HomographyFilter moving_filter() {
  HomographyFilter filter;
  filter.covariance.diagonal().setConstant(1e-6);
  filter.covariance(0, 6) = filter.covariance(6, 0) = 5e-7;
  filter.velocity_covariance.diagonal().setConstant(1e-2);
  return filter.after(0.1, 1e-3 * HomographyCovariance::Identity());
}

// The Kalman filter in information form.
TEST(HomographyFilter, CorrectsByTheRingLikeTheSumOfTheInformation) {
  const HomographyFilter before = moving_filter();
  RingChange change;
  change << 0.02, -0.01, 0.005, 0.001, -0.002;
  const RingMatrix errors = 4e-5 * RingMatrix::Identity();
  HomographyCovariance measured = HomographyCovariance::Zero();
  measured.topLeftCorner<5, 5>() = errors.inverse();
  HomographyEstimate estimate;
  estimate.information = inverse_of(before.covariance) + measured;
  estimate.change = inverse_of(estimate.information).leftCols<5>() * errors.inverse() * change;
  const HomographyFilter expected = before.corrected(estimate);

  HomographyFilter filter = before;
  const RingGain gain = filter.correct_by_ring(change, errors, HomographyCovariance::Zero());
  EXPECT_TRUE((gain * change).isApprox(estimate.change, 1e-6));
  EXPECT_GT(std::abs((gain * change)(6)), 1e-5) << "correlated with the ring";
  EXPECT_TRUE(filter.velocity.isApprox(expected.velocity, 1e-6));
  EXPECT_TRUE(filter.covariance.isApprox(expected.covariance, 1e-6));
  EXPECT_TRUE(filter.cross_covariance.isApprox(expected.cross_covariance, 1e-6));
  EXPECT_TRUE(filter.velocity_covariance.isApprox(expected.velocity_covariance, 1e-6));
}

TEST(HomographyFilter, TrustsTheRingMoreIfItsOwnViewHasOtherErrors) {
  const RingChange change = RingChange::Constant(0.01);
  const RingMatrix errors = 4e-5 * RingMatrix::Identity();
  HomographyFilter filter = moving_filter();
  const HomographyCovariance considered = 1e-2 * HomographyCovariance::Identity();
  const RingGain gain = filter.correct_by_ring(change, errors, considered);
  EXPECT_TRUE((gain * change).head<5>().isApprox(change, 0.01));
  const RingMatrix covariance = filter.covariance.topLeftCorner<5, 5>();
  EXPECT_TRUE(covariance.isApprox(errors, 0.02)) << "nearly the measurement";
}

TEST(Refuted, NeedsMoreThanAFewUnmatchedSamples) {
  EXPECT_FALSE(is_refuted(0, 0));
  EXPECT_FALSE(is_refuted(0, 3));
  EXPECT_TRUE(is_refuted(0, 5));
  EXPECT_FALSE(is_refuted(20, 40));
  EXPECT_TRUE(is_refuted(13, 40));
}

TEST(Support, ReportsTheLight) {
  Scene scene = scene_of(Pattern::kRing);
  const PadModel model = learn_circles(rendered(scene, kPad).view(), image_from_pad(kPad)).value();
  for (const double gain : {1.0, 0.5, 0.25}) {
    scene.sensor.gain = gain;
    const GrayPicture picture = rendered(scene, kPad);
    EdgeSearch search;
    search.sample(model, image_from_pad(kPad), picture.view());
    search.search(picture.view(), {gain, pixel_noise(picture.view())}, 4.0);
    const HomographySupport support =
        support_of(search.samples(), HomographyChange::Zero(), 1.5, 2);
    // Circles are learned from levels at larger distances than those that a sample compares.
    EXPECT_NEAR(support.gain / gain, 1.0, 0.2) << gain;
  }
  EXPECT_EQ(support_of({}, HomographyChange::Zero(), 1.5, 1).coverage, 0.0);
}

}  // namespace
}  // namespace ellipse
