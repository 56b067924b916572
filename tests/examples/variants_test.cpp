// SPDX-License-Identifier: MIT
//
// Altered copies of data sets.
#include "examples/evaluate/variants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/camera/camera.hpp"

namespace evaluate {
namespace {

const ellipse::Ellipse kBright{110.3, 61.7, 40.0, 22.0, 0.4};
const ellipse::Ellipse kOther{300.0, 160.0, 18.0, 12.0, -0.7};

// A bright and a darker filled ellipse, on black.
class TwoEllipses : public PictureSource {
 public:
  [[nodiscard]] cv::Mat picture(const Frame& /*frame*/) override {
    cv::Mat picture(240, 390, CV_8U, cv::Scalar(0));
    draw(picture, kBright, 220);
    draw(picture, kOther, 90);
    return picture;
  }

 private:
  // Antialiased with 1/16 px.
  static void draw(cv::Mat& picture, const ellipse::Ellipse& e, int level) {
    const auto fixed = [](double px) { return cvRound(16.0 * px); };
    cv::ellipse(picture,
                {fixed(e.cx), fixed(e.cy)},
                {fixed(e.semi_major), fixed(e.semi_minor)},
                e.angle_rad * 180.0 / std::numbers::pi,
                0.0,
                360.0,
                cv::Scalar(level),
                cv::FILLED,
                cv::LINE_AA,
                4);
  }
};

Sequence sequence() {
  Sequence result;
  result.dataset = "two";
  result.name = "ellipses";
  for (std::size_t i = 0; i < 2; ++i) {
    Frame frame;
    frame.name = "frame" + std::to_string(i);
    frame.number = i;
    frame.truth.target = kBright;
    frame.truth.others = {{kOther, {}}};
    result.frames.push_back(frame);
  }
  result.pictures = std::make_shared<TwoEllipses>();
  return result;
}

Sequence variant(const std::string& name) {
  return variants_of({sequence()}, {name}).front();
}

// Mean level inside an ellipse scaled about its centre by `from`, but not by `to`.
double level_between(const cv::Mat& picture, const ellipse::Ellipse& e, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double dx = x - e.cx;
      const double dy = y - e.cy;
      const double c = std::cos(e.angle_rad);
      const double s = std::sin(e.angle_rad);
      const double radius =
          std::hypot((c * dx + s * dy) / e.semi_major, (c * dy - s * dx) / e.semi_minor);
      if (radius < from || radius > to) continue;
      sum += picture.at<std::uint8_t>(y, x);
      ++count;
    }
  }
  return sum / count;
}

TEST(Variants, MoveTheTruthWithThePicture) {
  for (const std::string& name : variant_names()) {
    const Sequence altered = variant(name);
    const Frame& frame = altered.frames.front();
    const cv::Mat picture = altered.pictures->picture(frame);
    const double light = name == "dark" ? 0.13 : 1.0;
    for (const auto& [e, level] : {std::pair{*frame.truth.target, 220.0},
                                   std::pair{frame.truth.others.front().ellipse, 90.0}}) {
      // The step is where the truth is, in any direction: the levels beside it differ by most of
      // it.
      const double inside = level_between(picture, e, 0.7, 0.97);
      const double outside = level_between(picture, e, 1.03, 1.3);
      EXPECT_GT(inside - outside,
                (name == "defocus" || name == "motion" ? 0.4 : 0.65) * light * level)
          << name;
      EXPECT_NEAR(level_between(picture, e, 0.0, 0.5), light * level, 12.0) << name;
    }
  }
}

TEST(Variants, RotateClockwise) {
  const Sequence altered = variant("rotate");
  const ellipse::Ellipse target = *altered.frames.front().truth.target;
  EXPECT_NEAR(target.cx, 239.0 - kBright.cy, 1e-9);
  EXPECT_NEAR(target.cy, kBright.cx, 1e-9);
  EXPECT_EQ(altered.pictures->picture(altered.frames.front()).size(), cv::Size(240, 390));
}

TEST(Variants, AreTheSameAtEachRequest) {
  for (const std::string& name : variant_names()) {
    const Sequence altered = variant(name);
    const auto picture = [&](std::size_t i) {
      return altered.pictures->picture(altered.frames[i]);
    };
    EXPECT_EQ(cv::norm(picture(0), picture(0), cv::NORM_INF), 0.0) << name;
  }
  const Sequence noisy = variant("noise");
  EXPECT_GT(cv::norm(noisy.pictures->picture(noisy.frames[0]),
                     noisy.pictures->picture(noisy.frames[1]),
                     cv::NORM_INF),
            0.0);
}

TEST(Variants, HaveTheNoiseTheyName) {
  const Sequence noisy = variant("noise");
  const cv::Mat picture = noisy.pictures->picture(noisy.frames.front());
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture(cv::Rect(95, 50, 30, 24)), mean, deviation);
  EXPECT_NEAR(deviation[0], 6.0, 0.5);
  EXPECT_NEAR(mean[0], 220.0, 1.0);
}

TEST(Variants, AreDataSetsOfTheirOwn) {
  const auto copies = variants_of({sequence()}, {"blur", "flip-y"});
  ASSERT_EQ(copies.size(), 2U);
  EXPECT_EQ(copies[0].dataset, "two blur");
  EXPECT_EQ(copies[1].dataset, "two flip-y");
  EXPECT_TRUE(copies[1].frames[0].image.empty());
}

TEST(Variants, ErrorsNameTheVariant) {
  try {
    (void)variants_of({sequence()}, {"fog"});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("--variants fog: unknown; known are flip-x"),
              std::string::npos);
  }
  Sequence distorted = sequence();
  ellipse::Camera camera = ellipse::Camera::with_hfov(1.0, 390, 240);
  camera.distortion[0] = -0.1;
  distorted.distortion = std::make_shared<DistortedFrame>(camera);
  EXPECT_THROW((void)variants_of({distorted}, {"flip-x"}), std::invalid_argument);
  EXPECT_EQ(variants_of({distorted}, {"noise"}).size(), 1U);
}

}  // namespace
}  // namespace evaluate
