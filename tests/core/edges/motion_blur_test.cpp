// SPDX-License-Identifier: MIT
#include "core/edges/motion_blur.hpp"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "core/edges/edge_measurement.hpp"
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
  const MotionBlur blur = motion_blur(blurred_over(6.0F), -10.0F * kAlongX);
  EXPECT_NEAR(blur.px.x(), -6.0F, 0.01F);
  EXPECT_EQ(blur.px.y(), 0.0F);
  EXPECT_NEAR(blur.squared_length, 36.0, 0.1);
}

TEST(MotionBlur, IsNoLongerThanTheMotion) {
  const float length_px = motion_blur(blurred_over(6.0F), 5.9F * kAlongX).px.norm();
  EXPECT_LE(length_px, 5.9F);
  EXPECT_GT(length_px, 5.8F);
  // Most of this blur has another reason.
  EXPECT_EQ(motion_blur(blurred_over(6.0F), 1.0F * kAlongX).px, kNone);
  EXPECT_EQ(motion_blur(blurred_over(6.0F), 0.0F * kAlongX).px, kNone);
}

TEST(MotionBlur, IsAlongTheMotion) {
  EXPECT_EQ(motion_blur(blurred_over(6.0F), 10.0F * kAlongY).px, kNone);
}

// Of a Gaussian edge of variance 2 px^2, a blur of 4.9 px halves the sharpness.
TEST(MotionBlur, CountsIfItHalvesTheSharpness) {
  EXPECT_EQ(motion_blur(blurred_over(4.5F), 10.0F * kAlongX).px, kNone);
  EXPECT_NE(motion_blur(blurred_over(5.2F), 10.0F * kAlongX).px, kNone);
}

// Vibration moves the outline in another direction from frame to frame than during the exposure.
TEST(MotionBlur, HasALengthInAnyDirection) {
  for (const float length_px : {1.0F, 2.0F}) {
    const auto edges = blurred_over(length_px);
    const double squared_length = length_px * length_px;
    for (const Eigen::Vector2f& motion : {kAlongX, kAlongY, Eigen::Vector2f(kAlongX + kAlongY)}) {
      EXPECT_NEAR(
          motion_blur(edges, 10.0F * motion).squared_length, squared_length, 0.15 * squared_length);
    }
  }
}

TEST(MotionBlur, IgnoresDifferencesWithinTheScatter) {
  Random random(1);
  const auto edges = edges_with([&](const Eigen::Vector2f& normal) {
    const float scatter = 0.4F * static_cast<float>(random.unit() - 0.5);
    return kSharpest - 0.05F * normal.x() * normal.x() + scatter;
  });
  const MotionBlur blur = motion_blur(edges, 10.0F * kAlongX);
  EXPECT_EQ(blur.px, kNone);
  EXPECT_EQ(blur.squared_length, 0.0);
}

// A sharp lid covers the upper quarter of a soft pupil.
TEST(MotionBlur, IgnoresAPartThatIsSharper) {
  const auto edges = edges_with(
      [](const Eigen::Vector2f& normal) { return normal.y() < -0.7F ? kSharpest : 0.3F; });
  EXPECT_EQ(motion_blur(edges, 10.0F * kAlongX).px, kNone);
}

TEST(MotionBlur, SurvivesTooFewEdges) {
  EXPECT_EQ(motion_blur({}, 10.0F * kAlongX).px, kNone);
  const auto edges = blurred_over(6.0F);
  const MotionBlur of_few = motion_blur(std::span(edges).first(1), 10.0F * kAlongX);
  EXPECT_EQ(of_few.px, kNone);
  EXPECT_EQ(of_few.squared_length, 0.0);
  std::vector<EdgeMeasurement> one_normal(edges.begin(), edges.begin() + 8);
  for (EdgeMeasurement& edge : one_normal) edge.normal = kAlongX;
  EXPECT_EQ(motion_blur(one_normal, 10.0F * kAlongX).px, kNone);
  EXPECT_EQ(motion_blur(one_normal, 10.0F * kAlongX).squared_length, 0.0);
  const auto alike = edges_with([](const Eigen::Vector2f& /*normal*/) { return kSharpest; });
  EXPECT_EQ(motion_blur(alike, 10.0F * kAlongX).px, kNone);
  EXPECT_NEAR(motion_blur(alike, 10.0F * kAlongX).squared_length, 0.0, 1e-9);
}

}  // namespace
}  // namespace ellipse
