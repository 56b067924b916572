// SPDX-License-Identifier: MIT
//
// The packaged peers: each finds its kind of target and survives other input.
#include "examples/evaluate/peers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/detection/target_selection.hpp"
#include "core/tracking/tracker.hpp"
#include "examples/evaluate/randomized_hough.hpp"
#include "tests/support/picture.hpp"

// OpenCV 4.6's EdgeDrawing frees with delete what it allocated with new[]. Only AddressSanitizer
// calls this function.
extern "C" const char* __asan_default_options();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "alloc_dealloc_mismatch=0";
}

namespace evaluate {
namespace {

const ellipse::Thresholds kLimits;
const ellipse::Ellipse kCircle{160.0, 120.0, 70.0, 70.0, 0.0};
const ellipse::Ellipse kEllipse{160.0, 120.0, 90.0, 60.0, 0.5};

ellipse::Scene disc() {
  ellipse::Scene scene = support::plain_ring();
  scene.pad.pattern = ellipse::Pattern::kDisc;
  return scene;
}

std::vector<ellipse::Detection> found_by(const std::string& peer, const ellipse::ImageView& luma) {
  const auto detector = make_peer(peer);
  const auto detections = detector->detect(luma, kLimits);
  return {detections.begin(), detections.end()};
}

bool is_valid(const ellipse::Ellipse& e) {
  constexpr double kHalfPi = std::numbers::pi / 2.0;
  return std::isfinite(e.cx + e.cy + e.semi_major) && e.semi_major >= e.semi_minor &&
         e.semi_minor > 0.0 && e.angle_rad > -kHalfPi && e.angle_rad <= kHalfPi;
}

double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, std::numbers::pi));
}

class EachPeer : public testing::TestWithParam<const char*> {
 protected:
  // The target that the peer can detect.
  [[nodiscard]] ellipse::Ellipse target() const {
    return GetParam() == std::string("hough-circles") ? kCircle : kEllipse;
  }
};

TEST_P(EachPeer, FindsADisc) {
  const support::GrayPicture picture = support::rendered(disc(), target());
  const auto target_found = ellipse::select_target(found_by(GetParam(), picture.view()));
  ASSERT_TRUE(target_found);
  EXPECT_LE(ellipse::max_difference_px(target_found->ellipse, target()), 3.0);
  EXPECT_GT(target_found->score, 0.0);
  EXPECT_EQ(target_found->contour_overlap, 0.0);
}

TEST_P(EachPeer, KeepsNoStateBetweenPictures) {
  const auto detector = make_peer(GetParam());
  const support::GrayPicture with = support::rendered(disc(), target());
  ASSERT_FALSE(detector->detect(with.view(), kLimits).empty());
  const support::GrayPicture without(with.width, with.height, 128);
  EXPECT_TRUE(detector->detect(without.view(), kLimits).empty());
}

TEST_P(EachPeer, WorksAsTheTrackersDetector) {
  ellipse::TrackerSettings settings;
  settings.tracking = ellipse::TrackingMode::kNone;
  ellipse::Tracker tracker(settings, make_peer(GetParam()));
  const support::GrayPicture picture = support::rendered(disc(), target());
  const auto found = tracker.process(picture.view(), 0);
  ASSERT_TRUE(found);
  EXPECT_LE(ellipse::max_difference_px(found->ellipse, target()), 3.0);
}

TEST_P(EachPeer, GivesTheSameAnswerForAnyStride) {
  const support::GrayPicture picture = support::rendered(disc(), target());
  std::vector<std::uint8_t> wide(400 * 240, 255);
  std::vector<std::uint8_t> upside_down(320 * 240);
  for (int y = 0; y < 240; ++y) {
    std::copy_n(picture.view().row(y), 320, wide.data() + 400 * y);
    std::copy_n(picture.view().row(y), 320, upside_down.data() + 320 * (239 - y));
  }
  const auto dense = found_by(GetParam(), picture.view());
  const auto padded = found_by(GetParam(), {wide.data(), 320, 240, 400});
  const auto negative = found_by(GetParam(), {upside_down.data() + 320 * 239, 320, 240, -320});
  ASSERT_FALSE(dense.empty());
  ASSERT_EQ(padded.size(), dense.size());
  ASSERT_EQ(negative.size(), dense.size());
  for (std::size_t i = 0; i < dense.size(); ++i) {
    EXPECT_EQ(padded[i].ellipse, dense[i].ellipse);
    EXPECT_EQ(negative[i].ellipse, dense[i].ellipse);
  }
}

TEST_P(EachPeer, FindsNothingInSmallAndFlatPictures) {
  EXPECT_TRUE(found_by(GetParam(), {}).empty());
  for (int size = 1; size <= 24; ++size) {
    const support::GrayPicture small(size, 50 - 2 * size, 90);
    EXPECT_TRUE(found_by(GetParam(), small.view()).empty()) << size;
  }
  EXPECT_TRUE(found_by(GetParam(), support::GrayPicture(640, 360, 255).view()).empty());
}

TEST_P(EachPeer, ReturnsValidEllipsesFromNoiseWithinTheLimits) {
  std::mt19937 random(7);
  const auto detector = make_peer(GetParam());
  for (int i = 0; i < 12; ++i) {
    support::GrayPicture noise(16 + 17 * i, 150 - 11 * i);
    for (std::uint8_t& pixel : noise.pixels) pixel = static_cast<std::uint8_t>(random() >> 24U);
    for (const ellipse::Detection& d : detector->detect(noise.view(), kLimits)) {
      EXPECT_TRUE(is_valid(d.ellipse));
      EXPECT_LE(2.0 * d.ellipse.semi_major, kLimits.max_axis_px);
      EXPECT_LE(d.ellipse.aspect_ratio(), kLimits.max_axis_ratio);
    }
  }
}

TEST_P(EachPeer, HonoursTheLimitsOfTheAxes) {
  const support::GrayPicture picture = support::rendered(disc(), target());
  const auto detector = make_peer(GetParam());
  const auto finds_target = [&](const ellipse::Thresholds& limits) {
    const auto found = detector->detect(picture.view(), limits);
    return std::any_of(found.begin(), found.end(), [&](const ellipse::Detection& d) {
      return ellipse::max_difference_px(d.ellipse, target()) <= 3.0;
    });
  };
  ellipse::Thresholds limits;
  EXPECT_TRUE(finds_target(limits));
  limits.max_axis_px = 100.0;
  EXPECT_FALSE(finds_target(limits));
  limits.max_axis_px = 300.0;
  limits.min_axis_px = 200.0;
  EXPECT_FALSE(finds_target(limits));
}

INSTANTIATE_TEST_SUITE_P(Peers,
                         EachPeer,
                         testing::ValuesIn(peer_names().begin(), peer_names().end()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Peers, AgreeOnTheDirectionOfTheMajorAxis) {
  for (const double angle_rad : {-1.2, -0.6, 0.1, 0.6, 1.2}) {
    ellipse::Ellipse tilted = kEllipse;
    tilted.angle_rad = angle_rad;
    const support::GrayPicture picture = support::rendered(disc(), tilted);
    for (const char* peer : {"edge-drawing", "canny-fit", "randomized-hough"}) {
      const auto found = ellipse::select_target(found_by(peer, picture.view()));
      ASSERT_TRUE(found) << peer << " " << angle_rad;
      EXPECT_LE(angle_between(found->ellipse.angle_rad, angle_rad), 0.07) << peer;
    }
  }
}

TEST(Peers, ErrorNamesUnknownPeers) {
  try {
    (void)make_peer("yolo");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"yolo\""), std::string::npos);
  }
}

// It returns circles and ellipses in separate forms; that of circles has no axes.
TEST(EdgeDrawing, FindsCirclesAndEllipses) {
  for (const ellipse::Ellipse& target : {kCircle, kEllipse}) {
    const support::GrayPicture picture = support::rendered(support::plain_ring(), target);
    const auto found = ellipse::select_target(found_by("edge-drawing", picture.view()));
    ASSERT_TRUE(found);
    EXPECT_LE(ellipse::max_difference_px(found->ellipse, target), 2.0);
  }
}

TEST(EdgeDrawing, AdaptsToChangesOfTheFrameSize) {
  const auto detector = make_peer("edge-drawing");
  for (const int width : {320, 640, 330}) {
    const support::GrayPicture picture = support::rendered(disc(), kEllipse, width);
    EXPECT_FALSE(detector->detect(picture.view(), kLimits).empty()) << width;
  }
}

std::vector<EdgePixel> pixels_along(const ellipse::Ellipse& e) {
  std::vector<EdgePixel> pixels;
  ellipse::walk_perimeter(e, [&](const ellipse::PerimeterStep& step) {
    pixels.push_back({static_cast<float>(std::round(step.point.x())),
                      static_cast<float>(std::round(step.point.y())),
                      static_cast<float>(step.normal().x()),
                      static_cast<float>(step.normal().y())});
  });
  return pixels;
}

TEST(RandomizedHough, FindsAnEllipseAmongClutterDeterministically) {
  std::vector<EdgePixel> pixels = pixels_along(kEllipse);
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const float angle = static_cast<float>(random() % 6283) * 1e-3F;
    pixels.push_back({static_cast<float>(random() % 320),
                      static_cast<float>(random() % 240),
                      std::cos(angle),
                      std::sin(angle)});
  }
  RandomizedHough hough;
  const auto found = hough.find(pixels, kLimits);
  ASSERT_FALSE(found.empty());
  const std::vector<ellipse::Detection> first(found.begin(), found.end());
  const auto best = std::max_element(
      first.begin(), first.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  EXPECT_LE(ellipse::max_difference_px(best->ellipse, kEllipse), 3.0);
  const auto again = hough.find(pixels, kLimits);
  ASSERT_EQ(again.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(again[i].ellipse, first[i].ellipse);
}

TEST(RandomizedHough, AcceptsEmptyAndDegenerateInput) {
  RandomizedHough hough;
  EXPECT_TRUE(hough.find({}, kLimits).empty());
  EXPECT_TRUE(hough.find(std::vector<EdgePixel>(100), kLimits).empty());
}

}  // namespace
}  // namespace evaluate
