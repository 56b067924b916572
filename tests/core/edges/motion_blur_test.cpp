// SPDX-License-Identifier: MIT
#include "core/edges/motion_blur.hpp"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "core/edges/outline_samples.hpp"
#include "core/scene/random.hpp"

namespace ellipse {
namespace {

const Eigen::Vector2f kNone(0.0F, 0.0F);
const Eigen::Vector2f kAlongX(1.0F, 0.0F);
const Eigen::Vector2f kAlongY(0.0F, 1.0F);
constexpr float kSharpest = 0.5F;

// Edges all around an outline, as sharp as `sharpness_of` their normal.
template <class SharpnessOf>
std::vector<EdgeMeasurement> edges_with(const SharpnessOf& sharpness_of) {
  const auto normals = circle_directions(64);
  std::vector<EdgeMeasurement> edges(normals.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges[i].sample = static_cast<int>(i);
    edges[i].normal = normals[i];
    edges[i].sharpness = sharpness_of(normals[i]);
  }
  return edges;
}

// Edges blurred evenly over this length along x.
std::vector<EdgeMeasurement> blurred_over(float length_px) {
  return edges_with([=](const Eigen::Vector2f& normal) {
    const float across_px = length_px * normal.x();
    return kSharpest / (1.0F + kSharpest * across_px * across_px / 12.0F);
  });
}

TEST(MotionBlur, FindsTheLengthOfTheBlur) {
  const Eigen::Vector2f blur_px = motion_blur(blurred_over(4.0F), -10.0F * kAlongX);
  EXPECT_NEAR(blur_px.x(), -4.0F, 1e-3F);
  EXPECT_EQ(blur_px.y(), 0.0F);
}

TEST(MotionBlur, IsNoLongerThanTheMotion) {
  const float length_px = motion_blur(blurred_over(4.0F), 3.9F * kAlongX).norm();
  EXPECT_LE(length_px, 3.9F);
  EXPECT_GT(length_px, 3.8F);
  // Most of this blur has another reason.
  EXPECT_EQ(motion_blur(blurred_over(4.0F), 1.0F * kAlongX), kNone);
  EXPECT_EQ(motion_blur(blurred_over(4.0F), 0.0F * kAlongX), kNone);
}

TEST(MotionBlur, IsAlongTheMotion) {
  EXPECT_EQ(motion_blur(blurred_over(4.0F), 10.0F * kAlongY), kNone);
}

TEST(MotionBlur, IgnoresDifferencesWithinTheScatter) {
  Random random(1);
  const auto edges = edges_with([&](const Eigen::Vector2f& normal) {
    const float scatter = 0.4F * static_cast<float>(random.unit() - 0.5);
    return kSharpest - 0.05F * normal.x() * normal.x() + scatter;
  });
  EXPECT_EQ(motion_blur(edges, 10.0F * kAlongX), kNone);
}

// A sharp lid covers the upper quarter of a soft pupil.
TEST(MotionBlur, IgnoresAPartThatIsSharper) {
  const auto edges = edges_with(
      [](const Eigen::Vector2f& normal) { return normal.y() < -0.7F ? kSharpest : 0.3F; });
  EXPECT_EQ(motion_blur(edges, 10.0F * kAlongX), kNone);
}

TEST(MotionBlur, SurvivesTooFewEdges) {
  EXPECT_EQ(motion_blur({}, 10.0F * kAlongX), kNone);
  const auto edges = blurred_over(4.0F);
  EXPECT_EQ(motion_blur(std::span(edges).first(1), 10.0F * kAlongX), kNone);
  const auto alike = edges_with([](const Eigen::Vector2f& /*normal*/) { return kSharpest; });
  EXPECT_EQ(motion_blur(alike, 10.0F * kAlongX), kNone);
}

}  // namespace
}  // namespace ellipse
