// SPDX-License-Identifier: MIT
#include "core/edges/thin_ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detection/arcs/arc_detector.hpp"
#include "core/detection/target_selection.hpp"
#include "core/scene/random.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

Ellipse grown(Ellipse e, double px) {
  e.semi_major += px;
  e.semi_minor += px;
  return e;
}

Ellipse shrunk(Ellipse e, double factor) {
  e.semi_major *= factor;
  e.semi_minor *= factor;
  return e;
}

// Mean sharpness of edges in focus.
const Estimate kInFocus{0.61, 0.0};

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(RingEdges, KeepsDistantEdges) {
  const Ellipse outer{50.0, 50.0, 40.0, 30.0, 0.3};
  const Ellipse inner = grown(outer, -7.0);
  EXPECT_FALSE(is_thin({outer, inner}, kInFocus.value));
  EXPECT_TRUE(is_thin({outer, grown(outer, -5.0)}, kInFocus.value));
  // Blur by twice the length displaces edges at twice the distance.
  EXPECT_TRUE(is_thin({outer, grown(outer, -11.0)}, kInFocus.value / 4.0));
  EXPECT_FALSE(is_thin({outer, grown(outer, -13.0)}, kInFocus.value / 4.0));
  const RingEdges edges = without_blur_bias({outer, inner}, kInFocus).edges;
  EXPECT_EQ(edges.outer, outer);
  EXPECT_EQ(edges.inner, inner);
}

TEST(RingEdges, UsesAKnownRatioWithinTheLimits) {
  const Ellipse outer{50.0, 50.0, 30.0, 24.0, 0.3};
  const RingEdges maxima{outer, grown(outer, -4.5)};
  const Estimate soft{0.36, 0.02};
  const UnblurredRing unknown = without_blur_bias(maxima, soft);
  ASSERT_GT(unknown.width.sigma, 0.01);
  const double known = unknown.width.value - 1.2 * unknown.width.sigma;
  const double ratio = (2.0 - known) / (2.0 + known);
  const UnblurredRing inside = without_blur_bias(maxima, soft, ratio);
  EXPECT_NEAR(inside.width.value, known, 1e-9);
  EXPECT_NEAR(inside.width.sigma, 0.0, 1e-9);
  EXPECT_NEAR(mean_radius_px(inside.edges.inner) / mean_radius_px(inside.edges.outer), ratio, 0.01);
  const UnblurredRing outside = without_blur_bias(maxima, soft, 0.5);
  EXPECT_NEAR(outside.width.value, unknown.width.value, 1e-9);
  EXPECT_NEAR(outside.width.sigma, 2.0 / 3.0 - unknown.width.value, 1e-9);
}

TEST(RingEdges, MovesNearbyMaximaTogether) {
  const Ellipse outer{50.0, 50.0, 14.0, 11.0, 0.3};
  for (const double ratio : {0.78, 0.75, 0.72}) {
    const Ellipse inner = shrunk(outer, ratio);
    const RingEdges edges = without_blur_bias({outer, inner}, kInFocus).edges;
    const double width = edges.outer.semi_major - edges.inner.semi_major;
    EXPECT_LT(width, outer.semi_major - inner.semi_major) << ratio;
    EXPECT_GT(width, 0.0) << ratio;
    // The middle line stays in place.
    EXPECT_NEAR(edges.outer.semi_major + edges.inner.semi_major, 14.0 * (1.0 + ratio), 1e-3);
    EXPECT_LT((edges.outer.center() - outer.center()).norm(), 1e-9);
  }
}

TEST(RingEdges, ReducesUnresolvedRingsToALine) {
  // Noise puts the gradient maxima closer together than those of a line: the ring has no width.
  const Ellipse outer{50.0, 50.0, 14.0, 11.0, 0.0};
  const RingEdges edges = without_blur_bias({outer, grown(outer, -1.5)}, kInFocus).edges;
  EXPECT_NEAR(edges.outer.semi_major, 13.25, 0.01);
  EXPECT_NEAR(edges.inner.semi_major, 13.25, 0.01);
}

TEST(RingEdges, RemoveTheBiasOfSmallRings) {
  Random random(5);
  ArcDetector detector;
  Thresholds thresholds;
  thresholds.contour_overlap = detector.detecting_overlaps().contour;
  thresholds.ellipse_overlap = detector.detecting_overlaps().ellipse;
  for (const double radius : {10.0, 12.0, 16.0, 20.0}) {
    std::vector<double> major;
    std::vector<double> minor;
    for (std::uint64_t i = 0; i < 31; ++i) {
      const Ellipse truth = support::random_ellipse(random, 80, 70, radius);
      Scene scene = support::plain_ring();
      scene.sensor.read_noise = 3.0;
      scene.seed = i;
      const support::GrayPicture picture = support::rendered(scene, truth, 160, 140, i);
      const auto target = select_target(detector.detect(picture.view(), thresholds));
      ASSERT_TRUE(target) << radius;
      major.push_back(target->ellipse.semi_major - truth.semi_major);
      minor.push_back(target->ellipse.semi_minor - truth.semi_minor);
    }
    EXPECT_NEAR(median(major), 0.0, 0.06) << radius;
    EXPECT_NEAR(median(minor), 0.0, 0.06) << radius;
  }
}

TEST(RingEdges, ArePartnersIfConcentricAndOfOneShape) {
  const Ellipse outer{50.0, 50.0, 40.0, 30.0, 0.3};
  EXPECT_TRUE(are_partners(outer, shrunk(outer, 0.8)));
  EXPECT_FALSE(are_partners(outer, shrunk(outer, 0.99)));
  EXPECT_FALSE(are_partners(outer, shrunk(outer, 0.2)));
  EXPECT_FALSE(are_partners(outer, translated(shrunk(outer, 0.8), 8.0, 0.0)));
}

}  // namespace
}  // namespace ellipse
