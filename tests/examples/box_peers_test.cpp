// SPDX-License-Identifier: MIT
//
// The packaged box trackers: initialised with the true target, they follow it.
#include "examples/evaluate/box_peers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/method.hpp"
#include "tests/support/picture.hpp"

namespace evaluate {
namespace {

constexpr FrameSize kSize{320, 240};
const ellipse::Ellipse kStart{120.0, 110.0, 40.0, 30.0, 0.4};

ellipse::Scene marked_pad() {
  ellipse::Scene scene = support::plain_ring();
  scene.pad.pattern = ellipse::Pattern::kRingX;
  scene.ground.contrast = 1.0;
  return scene;
}

// Frames with the pad at given positions.
class EachBoxPeer : public testing::TestWithParam<const char*> {
 protected:
  EachBoxPeer() : method_(make_method(GetParam(), {})) { method_->start(nullptr); }

  Answer see(const ellipse::Ellipse& pad) {
    support::GrayPicture picture = support::rendered(marked_pad(), pad);
    return see(picture, {pad, std::nullopt, true});
  }
  Answer see(support::GrayPicture& picture, const Truth& truth) {
    Frame frame;
    frame.truth = truth;
    const cv::Mat grey(picture.height, picture.width, CV_8UC1, picture.pixels.data());
    return method_->find(frame, grey, 0);
  }
  Answer see_noise() {
    support::GrayPicture noise(kSize.width, kSize.height);
    for (std::uint8_t& pixel : noise.pixels) {
      pixel = static_cast<std::uint8_t>(random_.below(256));
    }
    return see(noise, {});
  }

  std::unique_ptr<Method> method_;
  ellipse::Random random_{7};
};

TEST_P(EachBoxPeer, IsInitializedOnceAndThenTracks) {
  const Answer first = see(kStart);
  EXPECT_TRUE(first.is_given);
  EXPECT_EQ(first.target, kStart);
  EXPECT_TRUE(std::isnan(first.processing_ms));
  ellipse::Ellipse pad = kStart;
  for (int i = 0; i < 12; ++i) {
    pad.cx += 2.0;
    pad.cy += 1.0;
    const Answer answer = see(pad);
    EXPECT_FALSE(answer.is_given);
    EXPECT_GT(answer.processing_ms, 0.0);
    ASSERT_TRUE(answer.target) << i;
    EXPECT_LE((answer.target->center() - pad.center()).norm(), 5.0) << i;
    EXPECT_TRUE(is_right(*answer.target, pad, kSize, Rule::kIou)) << i;
  }
}

TEST_P(EachBoxPeer, IsNotInitializedWithHardlyVisibleTargets) {
  ellipse::Ellipse leaving = kStart;
  leaving.cx = -10.0;
  EXPECT_LT(ellipse::visible_fraction(leaving, kSize.width, kSize.height), kMinToStart);
  EXPECT_FALSE(see(leaving).target);
  support::GrayPicture picture = support::rendered(marked_pad(), kStart);
  EXPECT_FALSE(see(picture, {kStart, std::nullopt, false}).target);  // not labelled
  EXPECT_FALSE(see({160.0, 120.0, 3.0, 2.0, 0.0}).target);           // too small a box
  EXPECT_TRUE(see(kStart).is_given);
}

TEST_P(EachBoxPeer, TracksTargetsCutByTheBorder) {
  ellipse::Ellipse pad = kStart;
  pad.cx = 12.0;
  ASSERT_TRUE(see(pad).is_given);
  for (int i = 0; i < 5; ++i) {
    pad.cx += 1.0;
    const Answer answer = see(pad);
    ASSERT_TRUE(answer.target) << i;
    EXPECT_LE((answer.target->center() - pad.center()).norm(), 5.0) << i;
  }
}

TEST_P(EachBoxPeer, SurvivesTargetsThatLeaveTheFrame) {
  ellipse::Ellipse pad = kStart;
  (void)see(pad);
  for (int i = 0; i < 25; ++i) {
    pad.cx -= 8.0;
    const Answer answer = see(pad);
    if (answer.target) {
      EXPECT_TRUE(std::isfinite(answer.target->cx + answer.target->semi_major));
    }
  }
}

TEST_P(EachBoxPeer, IsInitializedAgainInEachSequence) {
  EXPECT_TRUE(see(kStart).is_given);
  EXPECT_FALSE(see(kStart).is_given);
  method_->start(nullptr);
  EXPECT_TRUE(see(kStart).is_given);
}

TEST_P(EachBoxPeer, IsInitializedAgainAfterALoss) {
  ASSERT_TRUE(see(kStart).is_given);
  ASSERT_TRUE(see(kStart).target);  // KCF's first update does not search
  ASSERT_FALSE(see_noise().target);
  EXPECT_FALSE(see_noise().target);
  EXPECT_TRUE(see(kStart).is_given);
}

INSTANTIATE_TEST_SUITE_P(BoxPeers,
                         EachBoxPeer,
                         testing::ValuesIn(box_peer_names().begin(), box_peer_names().end()),
                         [](const auto& info) { return std::string(info.param); });

TEST(BoxPeers, CsrtScalesTheEllipseWithItsBox) {
  const auto csrt = make_method("csrt", {});
  csrt->start(nullptr);
  ellipse::Ellipse pad{160.0, 120.0, 40.0, 30.0, 0.4};
  std::optional<ellipse::Ellipse> last;
  for (int i = 0; i < 12; ++i) {
    support::GrayPicture picture = support::rendered(marked_pad(), pad);
    Frame frame;
    frame.truth = {pad, std::nullopt, true};
    const cv::Mat grey(picture.height, picture.width, CV_8UC1, picture.pixels.data());
    last = csrt->find(frame, grey, 0).target;
    ASSERT_TRUE(last) << i;
    pad.semi_major *= 1.02;
    pad.semi_minor *= 1.02;
  }
  EXPECT_GT(last->semi_major, 44.0);
  EXPECT_NEAR(last->aspect_ratio(), 40.0 / 30.0, 1e-9);
  EXPECT_EQ(last->angle_rad, 0.4);
}

TEST(BoxPeers, ErrorNamesUnknownPeers) {
  try {
    (void)make_box_peer("goturn");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"goturn\""), std::string::npos);
  }
}

}  // namespace
}  // namespace evaluate
