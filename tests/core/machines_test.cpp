// SPDX-License-Identifier: MIT
//
// Results that must be the same on every processor.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <iomanip>

#include "core/detection/arcs/arc_detector.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/image/scale.hpp"
#include "tests/support/integer_disc.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;
using support::IntegerDisc;

constexpr std::array<IntegerDisc, 3> kDiscs = {
    {{160, 120, 70, 40}, {90, 100, 25, 60}, {250, 180, 12, 9}}};

GrayPicture picture_of(const IntegerDisc& disc) {
  return disc.draw(320, 240, 6);
}

/// [FowlerNollVo] FNV-1a, 64 bits.
class Digest {
 public:
  void add(std::uint64_t value) { digest_ = (digest_ ^ value) * 0x100000001b3u; }
  [[nodiscard]] std::uint64_t value() const { return digest_; }

 private:
  std::uint64_t digest_ = 0xcbf29ce484222325u;
};

std::uint64_t digest_of_stages(const GrayPicture& picture, Simd simd) {
  Digest digest;
  Scaler scaler;
  for (const int scale : {1, 2, 4}) {
    GradientMap map(simd);
    map.compute(scaler.reduce(picture.view(), scale), {4.0, 8.0});
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        const int at = y * map.stride() + x;
        digest.add(map.maxima()[at]);
        if (map.maxima()[at] == 0) continue;
        digest.add(static_cast<std::uint16_t>(map.gradients()[at].x));
        digest.add(static_cast<std::uint16_t>(map.gradients()[at].y));
      }
    }
    ChainTracer chains;
    chains.trace(map);
    for (const std::int32_t pixel : chains.pixels()) digest.add(static_cast<std::uint32_t>(pixel));
  }
  return digest.value();
}

TEST(Machines, IntegerStagesAreBitEqual) {
  constexpr std::array<std::uint64_t, 3> kDigests = {
      69581730297642070U, 7268294265261161847U, 7064622963298312029U};
  for (std::size_t i = 0; i < kDiscs.size(); ++i) {
    const GrayPicture picture = picture_of(kDiscs[i]);
    EXPECT_EQ(digest_of_stages(picture, Simd::kBaseline), kDigests[i]) << "disc " << i;
    EXPECT_EQ(digest_of_stages(picture, best_simd()), kDigests[i]) << "disc " << i;
  }
}

TEST(Machines, EllipsesAreEqualToATenThousandthOfAPixel) {
  constexpr std::array<Ellipse, 3> kExpected = {{
      {159.6250412, 119.62735, 69.99872917, 39.99845909, 0.0001333937642},
      {89.61992959, 99.63902814, 59.99834424, 24.98587457, -1.570603408},
      {249.6073549, 179.623386, 11.97672202, 8.990699929, -0.001522013209},
  }};
  ArcDetector detector;
  for (std::size_t i = 0; i < kDiscs.size(); ++i) {
    const GrayPicture picture = picture_of(kDiscs[i]);
    const auto found = detector.detect(picture.view(), Thresholds{});
    ASSERT_EQ(found.size(), 1U) << "disc " << i;
    const Ellipse& e = found[0].ellipse;
    EXPECT_LT(max_difference_px(e, kExpected[i]), 1e-4)
        << std::setprecision(10) << "disc " << i << ": " << e.cx << ", " << e.cy << ", "
        << e.semi_major << ", " << e.semi_minor << ", " << e.angle_rad;
  }
}

}  // namespace
}  // namespace ellipse
