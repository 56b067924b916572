// SPDX-License-Identifier: MIT
//
// Altered copies of data sets.
#include "examples/evaluate/variants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "core/camera/camera.hpp"

namespace evaluate {
namespace {

const ellipse::Ellipse kBright{110.3, 61.7, 40.0, 22.0, 0.4};
const ellipse::Ellipse kSecond{300.0, 160.0, 18.0, 12.0, -0.7};

// Distance of a pixel from the centre of an ellipse; 1 on its perimeter.
double radius_in(const ellipse::Ellipse& e, int x, int y) {
  const double dx = x - e.cx;
  const double dy = y - e.cy;
  const double c = std::cos(e.angle_rad);
  const double s = std::sin(e.angle_rad);
  return std::hypot((c * dx + s * dy) / e.semi_major, (c * dy - s * dx) / e.semi_minor);
}

// A bright and a darker filled ellipse, on black.
class TwoEllipses : public PictureSource {
 public:
  [[nodiscard]] cv::Mat picture(const Frame& /*frame*/) override {
    cv::Mat picture(240, 390, CV_8U);
    picture.forEach<std::uint8_t>([](std::uint8_t& level, const int* at) {
      const bool is_bright = radius_in(kBright, at[1], at[0]) <= 1.0;
      const bool is_other = radius_in(kSecond, at[1], at[0]) <= 1.0;
      level = is_bright ? 220 : is_other ? 90 : 0;
    });
    return picture;
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
    frame.truth.others = {{kSecond, {}}};
    result.frames.push_back(frame);
  }
  result.pictures = std::make_shared<TwoEllipses>();
  return result;
}

Sequence variant(const std::string& name) {
  return variants_of({sequence()}, {name}).front();
}

// Mean level between `from` and `to` times an ellipse.
double level_between(const cv::Mat& picture, const ellipse::Ellipse& e, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double radius = radius_in(e, x, y);
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

TEST(Variants, MoveCentresExactly) {
  const auto centre = [](const std::string& name) {
    return variant(name).frames.front().truth.target->center();
  };
  const Eigen::Vector2d here = kBright.center();
  EXPECT_TRUE(centre("flip-x").isApprox(Eigen::Vector2d(389.0 - here.x(), here.y())));
  EXPECT_TRUE(centre("flip-y").isApprox(Eigen::Vector2d(here.x(), 239.0 - here.y())));
  const Eigen::Vector2d half(0.5, 0.5);
  EXPECT_TRUE(centre("third").isApprox((here + half) / 3.0 - half));
  EXPECT_EQ(centre("noise"), here);
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
