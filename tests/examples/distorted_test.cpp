// SPDX-License-Identifier: MIT
//
// Frames distorted by a lens, and the judging of answers on them.
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene/catalog.hpp"
#include "examples/evaluate/distorted_frame.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/scenes.hpp"

namespace evaluate {
namespace {

ellipse::Camera camera_with(const char* lens) {
  ellipse::Scene scene;
  ellipse::put_on_lens(scene, lens);
  return camera_of(scene, 640, 360);
}

Sequence distorted(const std::string& name, const ScenePace& pace) {
  for (Sequence& sequence : make_distorted({7}, pace)) {
    if (sequence.name == name) return std::move(sequence);
  }
  throw std::invalid_argument(name);
}

TEST(Distorted, RendersAllScenesThroughEachLens) {
  const std::vector<Sequence> sequences = make_distorted({5, 6}, {1.0, 10.0});
  ASSERT_EQ(sequences.size(), 2 * ellipse::scene_catalog().size() * ellipse::lens_catalog().size());
  EXPECT_EQ(sequences[0].name, "approach-barrel-5");
  EXPECT_EQ(sequences[3].name, "approach-fisheye-6");
  std::set<const DistortedFrame*> lenses;
  for (const Sequence& sequence : sequences) {
    EXPECT_EQ(sequence.dataset, "distorted");
    EXPECT_EQ(sequence.frames.size(), 10U);
    ASSERT_TRUE(sequence.distortion);
    lenses.insert(sequence.distortion.get());
  }
  EXPECT_EQ(lenses.size(), ellipse::lens_catalog().size());  // shared: each has a pixel table
}

TEST(Distorted, SequencesAreNamedBySeeds) {
  using Seeds = std::vector<std::uint64_t>;
  EXPECT_EQ(scene_seeds("distorted:7,9-10", "distorted"), (Seeds{7, 9, 10}));
  EXPECT_FALSE(scene_seeds("distorted:7"));
  EXPECT_FALSE(scene_seeds("scenes:7", "distorted"));
  EXPECT_THROW((void)scene_seeds("distorted:x", "distorted"), std::invalid_argument);
}

// The pad leaves the picture; frames with half of it in view also have a truth.
TEST(Distorted, PartlyVisibleTargetsHaveATruth) {
  for (const char* name : {"reenter-barrel-7", "reenter-fisheye-7"}) {
    int in_part = 0;
    int empty = 0;
    for (const Frame& frame : distorted(name, {8.0, 10.0}).frames) {
      const double visible = frame.truth.visible_fraction.value_or(0.0);
      in_part += visible > 0.2 && visible < 0.8 ? 1 : 0;
      empty += frame.truth.target ? 0 : 1;
    }
    EXPECT_GT(in_part, 5) << name;
    EXPECT_GT(empty, 5) << name;
  }
}

TEST(DistortedFrame, IouEqualsThatOfTheRectangleForAWeakLens) {
  ellipse::Camera camera = ellipse::Camera::with_hfov(1.012, 640, 360);
  camera.distortion[0] = 1e-9;
  const DistortedFrame frame(camera);
  const ellipse::Ellipse truth{300.0, 200.0, 120.0, 80.0, 0.4};
  for (const double shift : {0.0, 10.0, 60.0, 200.0}) {
    const ellipse::Ellipse answer = ellipse::translated(truth, shift, -0.5 * shift);
    EXPECT_NEAR(frame.iou(answer, truth), ellipse::iou_inside(answer, truth, 640, 360), 0.005);
  }
  EXPECT_EQ(frame.iou({-500.0, 0.0, 9.0, 9.0, 0.0}, {-500.0, 0.0, 9.0, 9.0, 0.0}), 0.0);
}

TEST(DistortedFrame, ContainsEllipsesOutsideTheIdealPlanesRectangle) {
  const DistortedFrame frame(camera_with("fisheye"));
  // Near the picture's right border, far out in the ideal plane.
  const ellipse::Ellipse far_out{780.0, 180.0, 60.0, 40.0, 0.0};
  EXPECT_EQ(ellipse::iou_inside(far_out, far_out, 640, 360), 0.0);
  EXPECT_EQ(frame.iou(far_out, far_out), 1.0);
}

TEST(DistortedFrame, ConvertsToThePictureAndBack) {
  for (const char* lens : {"barrel", "fisheye"}) {
    const DistortedFrame frame(camera_with(lens));
    for (const ellipse::Ellipse& ideal : {ellipse::Ellipse{120.0, 90.0, 60.0, 50.0, 0.3},
                                          ellipse::Ellipse{560.0, 300.0, 40.0, 25.0, -0.7}}) {
      const auto shown = frame.to_picture(ideal);
      ASSERT_TRUE(shown) << lens;
      EXPECT_GT(max_difference_px(*shown, ideal), 0.5) << lens;
      // Not exactly equal: a distorted ellipse is not an ellipse.
      EXPECT_LT(max_difference_px(frame.to_ideal(*shown), ideal), 0.5) << lens;
    }
  }
}

// Answers with the truth, in the picture or in the ideal plane.
class Truthful : public Method {
 public:
  Truthful(const char* name, bool knows_lens, bool means_ideal)
      : Method(name), knows_lens_(knows_lens), means_ideal_(means_ideal) {}
  void start(const DistortedFrame* distortion) override { distortion_ = distortion; }
  [[nodiscard]] bool knows_lens() const override { return knows_lens_; }
  Answer find(const Frame& frame, const cv::Mat& /*picture*/, std::int64_t /*pts_ns*/) override {
    Answer answer;
    const auto& truth = frame.truth.target;
    answer.target = truth && !means_ideal_ ? distortion_->to_picture(*truth) : truth;
    return answer;
  }

 private:
  bool knows_lens_;
  bool means_ideal_;
  const DistortedFrame* distortion_ = nullptr;
};

TEST(Distorted, AnswersInThePictureAreJudgedInTheIdealPlane) {
  std::vector<Sequence> sequences;
  sequences.push_back(distorted("reenter-fisheye-7", {1.0, 10.0}));
  std::vector<std::unique_ptr<Method>> methods;
  methods.push_back(std::make_unique<Truthful>("ideal", true, true));
  methods.push_back(std::make_unique<Truthful>("picture", false, false));
  methods.push_back(std::make_unique<Truthful>("confused", true, false));
  const Evaluation evaluation =
      evaluate(sequences, methods, Rule::kIou, [](const Frame&) { return true; });
  int judged = 0;
  int off = 0;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    if (evaluation.frames[i].frame->truth.visible_fraction.value_or(0.0) < kMinToStart) continue;
    const auto result = [&](std::size_t method) { return evaluation.methods[method].results[i]; };
    EXPECT_EQ(result(0).outcome, Outcome::kTruePositive);
    EXPECT_EQ(result(0).centre_error_px, 0.0);
    EXPECT_EQ(result(1).outcome, Outcome::kTruePositive);
    EXPECT_LT(result(1).centre_error_px, 2.0);
    ++judged;
    off += result(2).outcome == Outcome::kTruePositive && result(2).centre_error_px < 2.0 ? 0 : 1;
  }
  EXPECT_GT(judged, 5);
  EXPECT_GT(off, 3);  // the pad is off centre
}

// Our methods know the lens; box trackers are initialised in the picture.
TEST(Distorted, MethodsTrackThroughALens) {
  std::vector<Sequence> sequences;
  sequences.push_back(distorted("hover-fisheye-7", {0.5, 10.0}));
  std::vector<std::unique_ptr<Method>> methods;
  for (const char* name : {"arcs+edges", "edge-drawing", "kcf"}) {
    methods.push_back(make_method(name, {}));
  }
  const Evaluation evaluation =
      evaluate(sequences, methods, Rule::kIou, [](const Frame&) { return true; });
  ASSERT_EQ(evaluation.frames.size(), 5U);
  EXPECT_TRUE(evaluation.methods[2].results.front().is_given);
  for (const MethodResults& method : evaluation.methods) {
    for (const Result& result : method.results) {
      if (result.is_given) continue;
      EXPECT_EQ(result.outcome, Outcome::kTruePositive) << method.name;
      EXPECT_LT(result.centre_error_px, 3.0) << method.name;
    }
  }
}

}  // namespace
}  // namespace evaluate
