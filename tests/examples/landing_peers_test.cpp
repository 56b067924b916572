// SPDX-License-Identifier: MIT
//
// The landing peers beside ellipsetrack, each on its own pad.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "examples/landing/apriltag_pad.hpp"
#include "examples/landing/landing.hpp"
#include "examples/landing/method.hpp"
#include "examples/landing/report.hpp"

namespace {

using Eigen::Vector3d;
using landing::Look;
using landing::Motion;
using landing::Platform;
using landing::Rig;

constexpr int kSearch = 16;  // frames that WhyCon needs to try all its thresholds

std::vector<std::string> built_in_peers() {
  std::vector<std::string> peers = {"whycon"};
  if (landing::has_apriltag()) peers.emplace_back("apriltag");
  return peers;
}

ellipse::Scene scene_with(const std::string& method, const char* name) {
  ellipse::Scene scene = ellipse::scene_by_name(name, 5);
  landing::lay_pad(method, scene);
  return scene;
}

// The vehicle is tilted and off the pad's centre; its height is above the pad.
struct Hover {
  Rig rig;
  Motion vehicle;
  Platform platform{landing::Course::kStraight, 0.0, 0.0};

  explicit Hover(double height) {
    vehicle.position = {-0.08 * height, 0.05 * height, height};
    vehicle.world_from_body = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(0.12, Vector3d(1.0, 1.0, 0.0).normalized());
  }

  [[nodiscard]] ellipse::View view() const { return view_of(rig, vehicle, platform); }

  [[nodiscard]] Vector3d truth() const {
    return rig.pad_radius * (rig.camera.matrix().inverse() * view().image_from_pad.col(2));
  }

  // The result on the last of several frames of the scene.
  [[nodiscard]] Look look(const std::string& method, const ellipse::Scene& scene) const {
    ellipse::SceneRenderer renderer(scene);
    const auto eye = landing::eye_of(method, rig, scene_with(method, "approach").pad, 30);
    Look look;
    for (int frame = 0; frame < kSearch && !look.has_target; ++frame) {
      look = eye->look(gravity_of(rig, vehicle), [&](const ellipse::MutableImage& picture) {
        (void)renderer.render(view(), static_cast<std::uint64_t>(frame), picture);
      });
    }
    return look;
  }
};

TEST(LandingPeers, LocateTheirPadsWithinThreePercent) {
  for (const std::string& method : built_in_peers()) {
    for (const char* condition : {"approach", "dusk", "noise"}) {
      for (const double height : {2.5, 5.0, 9.0}) {
        const Hover hover(height);
        const Look look = hover.look(method, scene_with(method, condition));
        ASSERT_TRUE(look.position) << method << ", " << condition << ", " << height << " m";
        const double off = (*look.position - hover.truth()).norm();
        EXPECT_LE(off, 0.03 * height) << method << ", " << condition << ", " << height << " m";
      }
    }
  }
}

TEST(LandingPeers, FindNothingOnOtherPads) {
  const Hover hover(4.0);
  for (const std::string& method : built_in_peers()) {
    EXPECT_FALSE(hover.look(method, ellipse::scene_by_name("negative", 5)).has_target) << method;
    EXPECT_FALSE(hover.look(method, ellipse::scene_by_name("approach", 5)).has_target) << method;
  }
  ellipse::Scene narrow = scene_with("whycon", "approach");
  narrow.sheets.front().shapes.front().hole = 0.9;
  EXPECT_FALSE(hover.look("whycon", narrow).has_target);
}

TEST(LandingPeers, LandOnTheMovingPad) {
  for (const std::string& method : built_in_peers()) {
    landing::Flight flight;
    flight.seed = 4;
    flight.course = landing::Course::kCircle;
    flight.speed = 3.0;
    flight.method = method;
    const landing::Outcome outcome = landing::fly(flight);
    EXPECT_TRUE(outcome.is_within(landing::kMaxOff)) << method << ": " << outcome.off.norm();
  }
}

// The renderer casts no shadows on sheets; the tag's pad must have the same light as the others.
TEST(LandingPeers, DetectTheTagInTheShadowsOfTheOtherPads) {
  if (!landing::has_apriltag()) GTEST_SKIP() << "built without apriltag";
  const auto picture_of = [](ellipse::Scene scene) {
    scene.sensor.read_noise = 0.0;
    std::vector<std::uint8_t> pixels(640 * 360);
    (void)ellipse::SceneRenderer(scene).render(
        Hover(4.0).view(), 0, {pixels.data(), 640, 360, 640});
    return pixels;
  };
  ASSERT_FALSE(ellipse::scene_by_name("glare", 5).light.shadows.empty());
  const auto ring = picture_of(ellipse::scene_by_name("glare", 5));
  const auto tag = picture_of(scene_with("apriltag", "glare"));
  const Eigen::Matrix3d pad_from_image = Hover(4.0).view().image_from_pad.inverse();
  int largest = 0;
  int changed = 0;
  for (int i = 0; i < 640 * 360; ++i) {
    const Eigen::Vector3d at = pad_from_image * Vector3d(i % 640, i / 640, 1.0);
    const auto index = static_cast<std::size_t>(i);
    const int difference = std::abs(int{ring[index]} - int{tag[index]});
    if (at.hnormalized().norm() > 0.8) {
      largest = std::max(largest, difference);
    } else {
      changed += difference > 20 ? 1 : 0;
    }
  }
  EXPECT_LE(largest, 3);
  EXPECT_GT(changed, 500);  // the tag itself
}

TEST(LandingPeers, UnknownMethodsAreRejected) {
  EXPECT_NO_THROW(landing::check_method("contours+redetect"));
  EXPECT_NO_THROW(landing::check_method("whycon"));
  EXPECT_THROW(landing::check_method("aruco"), std::invalid_argument);
  if (landing::has_apriltag()) {
    EXPECT_NO_THROW(landing::check_method("apriltag"));
  } else {
    EXPECT_THROW(landing::check_method("apriltag"), std::runtime_error);
  }
}

}  // namespace
