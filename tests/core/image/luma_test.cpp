// SPDX-License-Identifier: MIT
#include "core/image/luma.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "tests/support/page_watch.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using Kind = PixelLayout::Kind;

std::vector<int> levels_of(const ImageView& luma) {
  std::vector<int> levels;
  for (int y = 0; y < luma.height; ++y) {
    levels.insert(levels.end(), luma.row(y), luma.row(y) + luma.width);
  }
  return levels;
}

std::vector<int> read(const PixelView& picture, const Rect& region) {
  LumaReader reader;
  reader.begin(picture);
  return levels_of(reader.read(region));
}

TEST(LumaReader, ReadsPlainLumaInPlace) {
  const support::GrayPicture picture(10, 8, 7);
  LumaReader reader;
  reader.begin(picture.view());
  const ImageView region = reader.read({2, 3, 4, 4});
  EXPECT_EQ(region.data, picture.pixels.data() + 32);
  EXPECT_EQ(region.stride, 10);
}

TEST(LumaReader, WeighsColoursInAnyOrder) {
  // One pixel, red 200, green 100, blue 50: luma 0.299 R + 0.587 G + 0.114 B = 124.2.
  const std::array<std::uint8_t, 4> xrgb = {9, 200, 100, 50};
  const std::array<std::uint8_t, 4> bgr = {50, 100, 200, 9};
  const std::vector<int> expected = {124};
  EXPECT_EQ(read({xrgb.data(), 1, 1, 4, {Kind::kRgb, 4, 0, 1, 2, 3}}, {0, 0, 1, 1}), expected);
  EXPECT_EQ(read({bgr.data(), 1, 1, 3, {Kind::kRgb, 3, 0, 2, 1, 0}}, {0, 0, 1, 1}), expected);
}

TEST(LumaReader, ConvertsOnlyTheRegion) {
  const std::array<std::uint8_t, 8> yuy2 = {10, 128, 20, 128, 30, 128, 40, 128};
  EXPECT_EQ(read({yuy2.data(), 4, 1, 8, {Kind::kLuma, 2}}, {1, 0, 2, 1}),
            (std::vector<int>{20, 30}));
}

TEST(LumaReader, ReadsBottomUpPictures) {
  const std::array<std::uint8_t, 4> rows = {1, 2, 3, 4};
  const ImageView upside_down{rows.data() + 2, 2, 2, -2};
  EXPECT_EQ(read(upside_down, {0, 0, 2, 2}), (std::vector<int>{3, 4, 1, 2}));
}

TEST(LumaReader, ReadsTheEightHighestBits) {
  // 10 bits: 1023, 514, 3.
  const std::array<std::uint8_t, 6> low = {0xff, 0x03, 0x02, 0x02, 0x03, 0x00};
  const std::array<std::uint8_t, 6> high = {0xc0, 0xff, 0x80, 0x80, 0xc0, 0x00};
  const std::array<std::uint8_t, 6> big_endian = {0xff, 0xc0, 0x80, 0x80, 0x00, 0xc0};
  const std::vector<int> expected = {255, 128, 0};
  const Rect all{0, 0, 3, 1};
  EXPECT_EQ(read({low.data(), 3, 1, 6, {.kind = Kind::kWord, .pixel_stride = 2, .shift = 2}}, all),
            expected);
  EXPECT_EQ(read({high.data(), 3, 1, 6, {Kind::kLuma, 2, 1}}, all), expected);
  EXPECT_EQ(read({big_endian.data(), 3, 1, 6, {Kind::kLuma, 2, 0}}, all), expected);
}

TEST(LumaReader, UnpacksThreePixelsPerWord) {
  std::vector<std::uint8_t> bytes;
  std::vector<int> expected;
  for (unsigned pixel = 0; pixel < 9; pixel += 3) {
    const auto level = [&](unsigned at) { return (113U * (pixel + at) + 5U) % 1024U; };
    const unsigned word = level(0) | level(1) << 10U | level(2) << 20U;
    for (unsigned byte = 0; byte < 4; ++byte) {
      bytes.push_back(static_cast<std::uint8_t>(word >> 8U * byte));
    }
    for (unsigned at = 0; at < 3; ++at) expected.push_back(static_cast<int>(level(at) >> 2U));
  }
  const PixelView picture(bytes.data(), 8, 1, 12, {Kind::kPacked});
  expected.pop_back();
  EXPECT_EQ(read(picture, picture.bounds()), expected);
  EXPECT_EQ(read(picture, {4, 0, 3, 1}),
            std::vector<int>(expected.begin() + 4, expected.begin() + 7));
}

TEST(LumaReader, MosaicOfAnyArrangementAndSizeHasTheSameLuma) {
  constexpr int kColours[4] = {200, 100, 100, 20};  // red, green, green, blue: mean 105
  for (const int size : {2, 3, 4, 5, 8}) {
    for (int phase = 0; phase < 4; ++phase) {
      std::vector<std::uint8_t> bytes;
      for (int i = 0; i < size * size; ++i) {
        const int x = i % size + phase % 2;
        const int y = i / size + phase / 2;
        bytes.push_back(static_cast<std::uint8_t>(kColours[2 * (y % 2) + x % 2]));
      }
      const PixelView picture(bytes.data(), size, size, size, {Kind::kMosaic});
      EXPECT_EQ(read(picture, picture.bounds()),
                std::vector<int>(static_cast<std::size_t>(size) * size, 105));
    }
  }
  const std::uint8_t one = 77;
  EXPECT_EQ(read({&one, 1, 1, 1, {Kind::kMosaic}}, {0, 0, 1, 1}), std::vector<int>{77});
}

class EachLayout : public testing::TestWithParam<PixelLayout> {
 protected:
  static constexpr int kWidth = 67;
  static constexpr int kHeight = 41;
};

TEST_P(EachLayout, PartsEqualThoseOfTheWhole) {
  std::mt19937 random(7);
  std::vector<std::uint8_t> bytes(4UL * kWidth * kHeight);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  PixelView picture(bytes.data(), kWidth, kHeight, 4L * kWidth, GetParam());
  const ImageView whole{bytes.data(), kWidth, kHeight, 4L * kWidth};
  LumaReader of_whole;
  of_whole.begin(picture);
  const ImageView expected = of_whole.read(whole.bounds());
  for (const bool is_slow : {false, true}) {
    picture.is_slow = is_slow;
    for (int round = 0; round < 50; ++round) {
      LumaReader reader;
      reader.begin(picture);
      for (int part = 0; part < 4; ++part) {
        const auto any = [&](int min, int max) {
          return min + static_cast<int>(random() % static_cast<unsigned>(max - min + 1));
        };
        const Rect region{any(-5, kWidth), any(-5, kHeight), any(0, kWidth), any(0, kHeight)};
        EXPECT_EQ(levels_of(reader.read(region)), levels_of(expected.region(region)));
      }
    }
  }
}

TEST_P(EachLayout, SlowMemoryIsReadOnceAndInOrder) {
  support::PageWatch memory(kHeight);
  PixelView picture(memory.data(), kWidth, kHeight, support::PageWatch::kPage, GetParam());
  picture.is_slow = true;
  LumaReader reader;
  reader.begin(picture);
  memory.start();
  const bool is_read =
      !reader.read({20, 10, 30, 16}).empty() && !reader.read({25, 12, 5, 5}).empty();
  const auto first = memory.stop();
  ASSERT_TRUE(is_read);
  const bool needs_neighbours = GetParam().kind == Kind::kMosaic;
  std::vector<std::size_t> rows(needs_neighbours ? 18 : 16);
  std::iota(rows.begin(), rows.end(), needs_neighbours ? 9 : 10);
  EXPECT_EQ(first, rows);

  memory.start();
  (void)reader.read({20, 26, 30, 4});
  const auto second = memory.stop();
  EXPECT_EQ(std::set<std::size_t>(second.begin(), second.end()).size(), second.size());
  EXPECT_EQ(*std::min_element(second.begin(), second.end()), needs_neighbours ? 25U : 26U);

  picture.is_slow = true;
  reader.begin(picture);
  memory.start();
  (void)reader.read(picture.bounds());
  std::vector<std::size_t> all(kHeight);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(memory.stop(), all);
}

INSTANTIATE_TEST_SUITE_P(Layouts,
                         EachLayout,
                         testing::Values(PixelLayout{},
                                         PixelLayout{.kind = Kind::kLuma, .pixel_stride = 2},
                                         PixelLayout{Kind::kRgb, 3, 0, 2, 1, 0},
                                         PixelLayout{Kind::kRgb, 4, 0, 1, 2, 3},
                                         PixelLayout{
                                             .kind = Kind::kWord, .pixel_stride = 2, .shift = 2},
                                         PixelLayout{.kind = Kind::kPacked},
                                         PixelLayout{.kind = Kind::kMosaic}));

}  // namespace
}  // namespace ellipse
