// SPDX-License-Identifier: MIT
//
// ellipseoverlay: what it draws, where and in which colour, and which pixels it leaves unchanged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/image/luma.hpp"
#include "gst/track/video_view.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using ellipse::Ellipse;
using support::add_circle;
using support::byte_formats;
using support::caps_of;
using support::GrayPicture;
using support::harness_of;
using support::info_of;
using support::Owned;
using support::push;

constexpr const char* kAllParts = "overlay=ellipse+axes+centre+roi+label";

using Bytes = std::vector<guint8>;

Bytes bytes_of(GstBuffer* buffer) {
  Bytes bytes(gst_buffer_get_size(buffer));
  gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
  return bytes;
}

void add_ellipse(GstBuffer* buffer, const Ellipse& e) {
  add_circle(buffer, e.cx, e.cy, e.semi_major);
  GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->semi_minor = e.semi_minor;
  meta->angle_rad = e.angle_rad;
}

// A buffer of varied bytes, opaque in formats with alpha.
Owned<GstBuffer> noise_buffer(const GstVideoInfo& info) {
  const gsize size = GST_VIDEO_INFO_SIZE(&info);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_WRITE);
  for (gsize i = 0; i < size; ++i) map.data[i] = static_cast<guint8>((i * 2654435761U) >> 24U);
  gst_buffer_unmap(buffer, &map);
  return Owned<GstBuffer>(buffer);
}

Owned<GstBuffer> even_buffer(const std::string& format, int width, int height) {
  return support::buffer_of(GrayPicture(width, height, 128), info_of(format, width, height));
}

Owned<GstBuffer> drawn(const std::string& settings,
                       const std::string& format,
                       int width,
                       int height,
                       const Ellipse& e) {
  const std::string caps = caps_of(format, width, height);
  auto buffer = even_buffer(format, width, height);
  add_ellipse(buffer.get(), e);
  return push(harness_of("ellipseoverlay " + settings, caps, caps), std::move(buffer));
}

// The first component after drawing: luma, or red.
GrayPicture drawn_picture(const std::string& settings,
                          const std::string& format,
                          int width,
                          int height,
                          const Ellipse& e) {
  const auto buffer = drawn(settings, format, width, height, e);
  return support::picture_of(buffer.get(), info_of(format, width, height));
}

GrayPicture drawn_gray(const std::string& settings, int width, int height, const Ellipse& e) {
  return drawn_picture(settings, "GRAY8", width, height, e);
}

// One byte of a frame and the block of pixels that shares it.
struct Sample {
  std::size_t at = 0;
  guint component = 0;
  ellipse::Rect block = {};
};

std::vector<Sample> samples_of(const GstVideoInfo& info) {
  std::vector<Sample> samples;
  for (guint c = 0; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    const int w = 1 << GST_VIDEO_FORMAT_INFO_W_SUB(info.finfo, c);
    const int h = 1 << GST_VIDEO_FORMAT_INFO_H_SUB(info.finfo, c);
    for (int y = 0; y < GST_VIDEO_INFO_HEIGHT(&info); y += h) {
      for (int x = 0; x < GST_VIDEO_INFO_WIDTH(&info); x += w) {
        const auto at = GST_VIDEO_INFO_COMP_OFFSET(&info, c) +
                        static_cast<gsize>(y / h * GST_VIDEO_INFO_COMP_STRIDE(&info, c) +
                                           x / w * GST_VIDEO_INFO_COMP_PSTRIDE(&info, c));
        samples.push_back({at, c, {x, y, w, h}});
      }
    }
  }
  return samples;
}

bool is_near(const Ellipse& e, const ellipse::Rect& block, double reach_px) {
  for (int y = block.y; y < block.y + block.height; ++y) {
    for (int x = block.x; x < block.x + block.width; ++x) {
      if (std::abs(ellipse::sampson_distance(e, {x, y})) <= reach_px) return true;
    }
  }
  return false;
}

TEST(EllipseOverlay, ChangesNoByteAwayFromTheLine) {
  const Ellipse e{80.3, 60.6, 50.0, 35.0, 0.5};
  for (const char* format : byte_formats()) {
    for (const int line_width : {1, 2, 5, 8}) {
      const GstVideoInfo info = info_of(format, 161, 121);
      const std::string caps = caps_of(format, 161, 121);
      auto buffer = noise_buffer(info);
      const Bytes before = bytes_of(buffer.get());
      add_ellipse(buffer.get(), e);
      const auto harness = harness_of(
          "ellipseoverlay overlay=ellipse line-width=" + std::to_string(line_width), caps, caps);
      Bytes after = bytes_of(push(harness, std::move(buffer)).get());
      const double casing = GST_VIDEO_INFO_IS_GRAY(&info) ? 1.0 : 0.0;
      const double reach = 0.5 * line_width + casing + 0.6;
      int changes = 0;
      for (const Sample& sample : samples_of(info)) {
        if (!is_near(e, sample.block, reach)) continue;
        changes += after[sample.at] != before[sample.at] ? 1 : 0;
        after[sample.at] = before[sample.at];
      }
      EXPECT_GT(changes, 200) << format;
      EXPECT_EQ(after, before) << format << ' ' << line_width;
    }
  }
}

TEST(EllipseOverlay, CoversTheWholeLineInEachFormat) {
  const Ellipse circle{80.5, 60.5, 30.0, 30.0, 0.0};
  for (const char* format : byte_formats()) {
    const auto buffer = drawn("overlay=ellipse overlay-color=0xffffffff", format, 161, 121, circle);
    const Bytes bytes = bytes_of(buffer.get());
    int on_line = 0;
    for (const Sample& sample : samples_of(info_of(format, 161, 121))) {
      if (sample.component != 0 || !is_near(circle, sample.block, 0.5)) continue;
      EXPECT_GT(bytes[sample.at], 220) << format << ' ' << sample.block.x << ' ' << sample.block.y;
      ++on_line;
    }
    EXPECT_GT(on_line, 150) << format;
  }
}

// A red line that covers all pixels that share a sample, also at the border, where the block is
// cut. Checks both standards and both ranges against their definitions.
TEST(EllipseOverlay, UsesTheColorimetryOfTheCaps) {
  struct Case {
    const char* colorimetry;
    guint8 yuv[3];
  };
  constexpr Case kCases[] = {{"bt601", {81, 90, 240}},
                             {"bt709", {63, 102, 240}},
                             {"1:4:5:1", {76, 85, 255}},
                             {"1:3:5:1", {54, 99, 255}}};
  for (const char* format : byte_formats()) {
    for (const Case& of : kCases) {
      const GstVideoInfo info = info_of(format, 97, 97);
      if (!GST_VIDEO_INFO_IS_YUV(&info)) continue;
      const std::string caps = caps_of(format, 97, 97) + ",colorimetry=" + of.colorimetry;
      const auto harness = harness_of(
          "ellipseoverlay overlay=ellipse line-width=20 overlay-color=0xffff0000", caps, caps);
      auto buffer = even_buffer(format, 97, 97);
      add_ellipse(buffer.get(), {66.0, 48.0, 30.0, 30.0, 0.0});
      const Bytes bytes = bytes_of(push(harness, std::move(buffer)).get());
      for (const Sample& sample : samples_of(info)) {
        if (!sample.block.contains(96, 48)) continue;
        EXPECT_EQ(bytes[sample.at], of.yuv[sample.component])
            << format << ' ' << of.colorimetry << ' ' << sample.component;
      }
    }
  }
}

// The luma or grey of a frame, its 8 most significant bits, as ellipsetrack reads them.
std::vector<int> levels_of(GstBuffer* buffer, const GstVideoInfo& info) {
  GstVideoFrame frame;
  EXPECT_TRUE(gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ));
  ellipse::LumaReader reader;
  reader.begin(pixel_view_of(frame));
  const ellipse::ImageView luma = reader.read({0, 0, frame.info.width, frame.info.height});
  std::vector<int> levels;
  for (int y = 0; y < luma.height; ++y) {
    levels.insert(levels.end(), luma.row(y), luma.row(y) + luma.width);
  }
  gst_video_frame_unmap(&frame);
  return levels;
}

TEST(EllipseOverlay, DrawsTheSameInDeepFormats) {
  const Ellipse e{80.3, 60.6, 50.0, 35.0, 0.5};
  const std::string settings = std::string(kAllParts) + " overlay-color=0xff40f010";
  for (const char* format : support::kDeepFormats) {
    if (gst_video_format_from_string(format) == GST_VIDEO_FORMAT_UNKNOWN) continue;
    const GstVideoInfo info = info_of(format, 161, 121);
    const char* of_bytes = GST_VIDEO_INFO_IS_GRAY(&info) ? "GRAY8" : "I420";
    const auto deep = drawn(settings, format, 161, 121, e);
    const auto shallow = drawn(settings, of_bytes, 161, 121, e);
    const auto levels = levels_of(deep.get(), info);
    const auto expected = levels_of(shallow.get(), info_of(of_bytes, 161, 121));
    ASSERT_EQ(levels.size(), expected.size());
    int drawn_px = 0;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      ASSERT_NEAR(levels[i], expected[i], 1) << format << ' ' << i % 161 << ' ' << i / 161;
      drawn_px += levels[i] != 128 ? 1 : 0;
    }
    EXPECT_GT(drawn_px, 500) << format;
  }
}

TEST(EllipseOverlay, HasItsColourInDeepChroma) {
  // A red line over the whole block: Y 81, U 90, V 240 by [BT601], times four with 10 bits.
  constexpr int kRed[] = {81 * 4, 90 * 4, 240 * 4};
  for (const char* format : {"I420_10LE", "P010_10LE"}) {
    const GstVideoInfo info = info_of(format, 96, 96);
    const auto buffer = drawn("overlay=ellipse line-width=20 overlay-color=0xffff0000",
                              format,
                              96,
                              96,
                              {48.0, 48.0, 30.0, 30.0, 0.0});
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info, buffer.get(), GST_MAP_READ));
    for (guint c = 0; c < 3; ++c) {
      const int column = c == 0 ? 78 : 39;
      const int row = c == 0 ? 48 : 24;
      const guint8* at = support::samples_of(frame, c) +
                         std::ptrdiff_t{row} * GST_VIDEO_FRAME_COMP_STRIDE(&frame, c) +
                         std::ptrdiff_t{column} * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c);
      const int level = GST_READ_UINT16_LE(at) >> GST_VIDEO_FORMAT_INFO_SHIFT(info.finfo, c);
      EXPECT_NEAR(level, kRed[c], 4) << format << ' ' << c;
    }
    gst_video_frame_unmap(&frame);
  }
}

TEST(EllipseOverlay, HasItsColourInRgb) {
  constexpr int kRed[] = {0xf0, 0x40, 0x10, 0xff};
  for (const char* format : byte_formats()) {
    const GstVideoInfo info = info_of(format, 96, 96);
    if (!GST_VIDEO_INFO_IS_RGB(&info)) continue;
    const auto buffer = drawn("overlay=ellipse line-width=8 overlay-color=0xfff04010",
                              format,
                              96,
                              96,
                              {48.0, 48.0, 30.0, 30.0, 0.0});
    const Bytes bytes = bytes_of(buffer.get());
    for (const Sample& sample : samples_of(info)) {
      if (!sample.block.contains(78, 48)) continue;
      EXPECT_EQ(bytes[sample.at], kRed[sample.component]) << format << ' ' << sample.component;
    }
  }
}

TEST(EllipseOverlay, DrawsLinesOfTheGivenWidth) {
  for (int width = 1; width <= 8; ++width) {
    const GrayPicture picture = drawn_picture(
        "overlay=ellipse overlay-color=0xffffffff line-width=" + std::to_string(width),
        "RGB",
        161,
        121,
        {80.3, 60.6, 50.0, 35.0, 0.5});
    double covered_px = 0.0;
    for (const auto level : picture.pixels) covered_px += (level - 128) / 127.0;
    const double line_px = ellipse::perimeter_px({80.3, 60.6, 50.0, 35.0, 0.5});
    EXPECT_NEAR(covered_px / line_px, width, 0.03) << width;
  }
}

// The curvature radius is below the line width.
TEST(EllipseOverlay, FlatEllipsesHaveNoHoles) {
  const Ellipse flat{60.0, 60.0, 50.0, 3.0, 0.7};
  const GrayPicture picture =
      drawn_picture("overlay=ellipse overlay-color=0xffffffff line-width=8", "RGB", 121, 121, flat);
  for (int y = 0; y < 121; ++y) {
    for (int x = 0; x < 121; ++x) {
      if (ellipse::sampson_distance(flat, {x, y}) < 0.0) {
        EXPECT_EQ(picture.view().row(y)[x], 255) << x << ' ' << y;
      }
    }
  }
}

// The maximum difference from the background within 2 px of a point.
int contrast_near(const GrayPicture& picture, const Eigen::Vector2d& point, int background) {
  int max_difference = 0;
  const int cx = static_cast<int>(std::lround(point.x()));
  const int cy = static_cast<int>(std::lround(point.y()));
  for (int y = cy - 2; y <= cy + 2; ++y) {
    for (int x = cx - 2; x <= cx + 2; ++x) {
      max_difference = std::max(max_difference, std::abs(picture.view().row(y)[x] - background));
    }
  }
  return max_difference;
}

// Without colour a line is grey, possibly the grey of the background.
TEST(EllipseOverlay, IsVisibleOnAnyGreyInGreyFormats) {
  const Ellipse e{80.3, 60.6, 50.0, 35.0, 0.5};
  const GstVideoInfo info = info_of("GRAY8", 161, 121);
  const std::string caps = caps_of("GRAY8", 161, 121);
  for (const char* color : {"0xff00ff00", "0xffffffff", "0xff000000", "0xff808080", "0xffff0000"}) {
    for (const char* element : {"ellipseoverlay overlay=ellipse", "ellipseoverlay overlay=roi"}) {
      for (const int level : {0, 76, 128, 150, 200, 255}) {
        const auto harness =
            harness_of(std::string(element) + " overlay-color=" + color, caps, caps);
        auto buffer =
            support::buffer_of(GrayPicture(161, 121, static_cast<std::uint8_t>(level)), info);
        add_ellipse(buffer.get(), e);
        GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
        meta->roi_x = 20;
        meta->roi_y = 20;
        meta->roi_width = 60;
        const auto out = push(harness, std::move(buffer));
        const GrayPicture picture = support::picture_of(out.get(), info);
        const bool is_region = std::string(element).ends_with("roi");
        const Eigen::Vector2d point = is_region ? Eigen::Vector2d(50.0, 20.0) : e.point_at(1.0);
        EXPECT_GE(contrast_near(picture, point, level), 64) << element << color << " on " << level;
      }
    }
  }
}

TEST(EllipseOverlay, BorderOnlyClips) {
  const Ellipse e{120.3, 90.6, 70.0, 45.0, 0.5};
  const GrayPicture whole = drawn_gray("overlay=ellipse+axes+centre", 240, 180, e);
  const GrayPicture part =
      drawn_gray("overlay=ellipse+axes+centre", 77, 61, ellipse::translated(e, -37.0, -53.0));
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 77; ++x) {
      ASSERT_EQ(part.view().row(y)[x], whole.view().row(y + 53)[x + 37]) << x << ' ' << y;
    }
  }
}

TEST(EllipseOverlay, DrawsAllPartsInTheSmallestFrames) {
  for (const char* format : byte_formats()) {
    for (const int size : {1, 2, 3, 5}) {
      const auto buffer = drawn(kAllParts, format, size, size, {0.0, 0.0, 2.0, 0.5, 0.3});
      EXPECT_NE(bytes_of(buffer.get()), bytes_of(even_buffer(format, size, size).get()))
          << format << ' ' << size;
    }
  }
}

TEST(EllipseOverlay, KeepsNothingOfThePreviousFrame) {
  const std::string caps = caps_of("GRAY8", 320, 240);
  const auto harness = harness_of("ellipseoverlay", caps, caps);
  const auto frame_with = [&](const Ellipse& e) {
    auto buffer = even_buffer("GRAY8", 320, 240);
    add_ellipse(buffer.get(), e);
    return bytes_of(push(harness, std::move(buffer)).get());
  };
  const Ellipse e{200.0, 120.0, 40.0, 30.0, 0.0};
  const Bytes alone = frame_with(e);
  EXPECT_NE(frame_with({90.0, 70.0, 60.0, 50.0, 0.3}), alone);
  EXPECT_EQ(frame_with(e), alone);
}

TEST(EllipseOverlay, HonoursStrideAndOffset) {
  constexpr int kStride = 300;
  GstBuffer* wide = gst_buffer_new_allocate(nullptr, 40 + kStride * 121, nullptr);
  gst_buffer_memset(wide, 0, 128, gst_buffer_get_size(wide));
  gsize offset[GST_VIDEO_MAX_PLANES] = {40};
  gint stride[GST_VIDEO_MAX_PLANES] = {kStride};
  gst_buffer_add_video_meta_full(
      wide, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 161, 121, 1, offset, stride);
  const Ellipse e{80.3, 60.6, 90.0, 35.0, 0.5};
  add_ellipse(wide, e);
  const std::string caps = caps_of("GRAY8", 161, 121);
  const auto harness = harness_of("ellipseoverlay overlay=ellipse+centre", caps, caps);
  const Bytes bytes = bytes_of(push(harness, Owned<GstBuffer>(wide)).get());
  const GrayPicture expected = drawn_gray("overlay=ellipse+centre", 161, 121, e);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int x = static_cast<int>(i + kStride - 40) % kStride;
    const int y = static_cast<int>(i + kStride - 40) / kStride - 1;
    const bool is_pixel = y >= 0 && x < 161;
    ASSERT_EQ(bytes[i], is_pixel ? expected.view().row(y)[x] : 128) << x << ' ' << y;
  }
}

TEST(EllipseOverlay, NonFiniteAndExtremeEllipsesAreNotDrawn) {
  const double not_a_number = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {not_a_number, infinity, -infinity, 1e300, -1e300}) {
    for (double GstEllipseMeta::*field : {&GstEllipseMeta::cx,
                                          &GstEllipseMeta::cy,
                                          &GstEllipseMeta::semi_major,
                                          &GstEllipseMeta::semi_minor,
                                          &GstEllipseMeta::angle_rad}) {
      if (field == &GstEllipseMeta::angle_rad && std::isfinite(value)) continue;
      const std::string caps = caps_of("I420", 64, 64);
      auto buffer = even_buffer("I420", 64, 64);
      const Bytes before = bytes_of(buffer.get());
      add_circle(buffer.get(), 32.0, 32.0, 10.0);
      gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->*field = value;
      const auto harness = harness_of(std::string("ellipseoverlay ") + kAllParts, caps, caps);
      EXPECT_EQ(bytes_of(push(harness, std::move(buffer)).get()), before) << value;
    }
  }
}

TEST(EllipseOverlay, DegenerateAndHugeOnesAreDrawn) {
  for (const Ellipse& e : {Ellipse{30.0, 30.0, 0.2, 0.1, 0.0},
                           Ellipse{30.0, 30.0, 25.0, 0.1, 0.8},
                           Ellipse{30.0, -99940.0, 99990.0, 99970.0, 0.0}}) {
    const GrayPicture picture = drawn_gray(kAllParts, 64, 64, e);
    EXPECT_FALSE(std::all_of(
        picture.pixels.begin(), picture.pixels.end(), [](auto level) { return level == 128; }));
  }
}

TEST(EllipseOverlay, AcceptsUnknownStates) {
  const std::string caps = caps_of("GRAY8", 320, 64);
  const auto harness = harness_of("ellipseoverlay overlay=label", caps, caps);
  auto buffer = even_buffer("GRAY8", 320, 64);
  add_circle(buffer.get(), 32.0, 32.0, 10.0);
  const gint foreign = 7;
  std::memcpy(&gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->state,
              &foreign,
              sizeof foreign);
  EXPECT_TRUE(push(harness, std::move(buffer)));
}

TEST(EllipseOverlay, DrawsCandidatesThinAndGrey) {
  const Ellipse e{160.0, 120.0, 80.0, 60.0, 0.0};
  const auto drawn_as = [&](GstEllipseRole role) {
    const std::string caps = caps_of("RGB", 320, 240);
    auto buffer = even_buffer("RGB", 320, 240);
    add_ellipse(buffer.get(), e);
    gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET)->role = role;
    const auto harness = harness_of(
        "ellipseoverlay overlay=ellipse line-width=6 overlay-color=0xffffffff", caps, caps);
    return bytes_of(push(harness, std::move(buffer)).get());
  };
  const auto changed = [](const Bytes& bytes) {
    return std::count_if(bytes.begin(), bytes.end(), [](guint8 byte) { return byte != 128; });
  };
  const Bytes target = drawn_as(GST_ELLIPSE_ROLE_TARGET);
  const Bytes candidate = drawn_as(GST_ELLIPSE_ROLE_CANDIDATE);
  EXPECT_EQ(target.at(3 * (120 * 320 + 240)), 255);
  EXPECT_NEAR(candidate.at(3 * (120 * 320 + 240)), 0xb0, 1);
  EXPECT_NEAR(
      static_cast<double>(changed(candidate)) / static_cast<double>(changed(target)), 0.5, 0.15);
  EXPECT_EQ(changed(drawn_as(GST_ELLIPSE_ROLE_TRUTH)), 0);  // unless truth=true
}

TEST(EllipseOverlay, PassesTooSmallBuffersWithAWarning) {
  const std::string caps = caps_of("GRAY8", 320, 240);
  const auto harness = harness_of("ellipseoverlay name=overlay", caps, caps);
  const Owned<GstElement> overlay(gst_bin_get_by_name(GST_BIN(harness->element), "overlay"));
  support::BusTap bus(overlay.get());  // a bin and its bus messages would reference each other
  Owned<GstBuffer> small(gst_buffer_new_allocate(nullptr, 100, nullptr));
  gst_buffer_memset(small.get(), 0, 128, 100);
  add_ellipse(small.get(), {160.0, 120.0, 80.0, 60.0, 0.0});
  const auto out = push(harness, std::move(small));
  EXPECT_EQ(bytes_of(out.get()), Bytes(100, 128));
  EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING));
}

TEST(EllipseOverlay, TransparentColourDrawsNothing) {
  const GrayPicture picture = drawn_gray(kAllParts + std::string(" overlay-color=0x00ffffff"),
                                         320,
                                         240,
                                         {50.0, 50.0, 30.0, 20.0, 0.0});
  for (const auto level : picture.pixels) EXPECT_EQ(level, 128);
}

// Bounding box and number of the pixels that a label changes.
struct Touched {
  int left = 1 << 20;
  int top = 1 << 20;
  int right = 0;
  int bottom = 0;
  int count = 0;
};

Touched touched_by_label(int width, int height, const Ellipse& e) {
  const GrayPicture picture =
      drawn_gray("overlay=label overlay-color=0xffffffff", width, height, e);
  Touched touched;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (picture.view().row(y)[x] == 128) continue;
      touched.left = std::min(touched.left, x);
      touched.top = std::min(touched.top, y);
      touched.right = std::max(touched.right, x + 1);
      touched.bottom = std::max(touched.bottom, y + 1);
      ++touched.count;
    }
  }
  return touched;
}

TEST(EllipseOverlay, LabelStaysInTheFrameAndOffTheCentre) {
  for (const double radius : {10.0, 45.0, 99.0, 230.0}) {
    const Touched free = touched_by_label(960, 240, {480.0, 100.0, radius, radius, 0.0});
    ASSERT_GT(free.count, 0);
    for (int cy = -20; cy <= 260; cy += 4) {
      for (const int cx : {-20, 0, 40, 160, 300, 319, 340}) {
        const Ellipse e{1.0 * cx, 1.0 * cy, radius, radius, 0.0};
        const Touched label = touched_by_label(320, 240, e);
        EXPECT_EQ(label.count, free.count) << "cut at " << cx << ' ' << cy;
        const bool is_on_centre =
            label.left <= cx && cx < label.right && label.top <= cy && cy < label.bottom;
        EXPECT_FALSE(is_on_centre) << cx << ' ' << cy << ' ' << radius;
      }
    }
  }
}

TEST(EllipseOverlay, LabelFollowsTheHeightOfTheFrame) {
  const Touched small = touched_by_label(320, 240, {160.0, 100.0, 40.0, 40.0, 0.0});
  const Touched large = touched_by_label(3840, 2160, {1900.0, 1000.0, 40.0, 40.0, 0.0});
  EXPECT_GE(small.bottom - small.top, 14);
  EXPECT_LE(small.right - small.left, 200);
  EXPECT_GE(large.bottom - large.top, 60);
  EXPECT_LE(large.right - large.left, 1000);
}

TEST(EllipseOverlay, LabelsDoNotOverlap) {
  const std::string caps = caps_of("GRAY8", 320, 240);
  const auto count = [&](const char* settings) {
    const auto harness =
        harness_of(std::string("ellipseoverlay overlay=label ") + settings, caps, caps);
    auto buffer = even_buffer("GRAY8", 320, 240);
    add_circle(buffer.get(), 160.0, 120.0, 30.0);
    GstEllipseMeta* truth = gst_buffer_add_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TRUTH);
    truth->cx = 160.0;
    truth->cy = 120.0;
    truth->semi_major = 31.0;
    truth->semi_minor = 31.0;
    const Bytes bytes = bytes_of(push(harness, std::move(buffer)).get());
    return bytes.size() - static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), 128));
  };
  // The truth's label is a few letters shorter; if the labels overlapped, it would add few pixels.
  EXPECT_GT(count("truth=true"), 3 * count("truth=false") / 2);
}

TEST(EllipseOverlay, LeavesBuffersWithoutEllipseAlone) {
  const std::string caps = caps_of("GRAY8", 64, 64);
  const auto harness = harness_of("ellipseoverlay", caps, caps);
  auto buffer = even_buffer("GRAY8", 64, 64);
  const Owned<GstBuffer> same(gst_buffer_ref(buffer.get()));
  GstMemory* memory = gst_buffer_peek_memory(same.get(), 0);
  EXPECT_EQ(gst_buffer_peek_memory(push(harness, std::move(buffer)).get(), 0), memory);
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(EllipseOverlay, LeavesThePixelsOfAnotherBranchAlone) {
  const support::TemporaryFolder folder;
  const auto sink = [&](const char* name) { return "filesink location=" + folder.file(name); };
  for (const char* format : {"GRAY8", "NV12"}) {
    const std::string source =
        "ellipsetestsrc num-buffers=5 ! video/x-raw,width=320,height=180,"
        "format=" +
        std::string(format) + " ! ellipsetrack ! ";
    ASSERT_EQ(support::run_pipeline(source + sink("plain")), "");
    ASSERT_EQ(support::run_pipeline(source + "tee name=t t. ! queue ! ellipseoverlay ! " +
                                    sink("drawn") + " t. ! queue ! " + sink("kept")),
              "");
    EXPECT_EQ(content_of(folder.file("kept")), content_of(folder.file("plain")));
    EXPECT_NE(content_of(folder.file("drawn")), content_of(folder.file("plain")));
  }
}

/* Composition metadata in place of drawing */

Owned<GstHarness> composing_harness(const std::string& elements, const std::string& caps) {
  Owned<GstHarness> harness(gst_harness_new_parse(elements.c_str()));
  support::offer_composition(harness.get());
  gst_harness_set_src_caps_str(harness.get(), caps.c_str());
  return harness;
}

GstVideoOverlayComposition* composition_on(const Owned<GstBuffer>& buffer) {
  GstVideoOverlayCompositionMeta* meta =
      gst_buffer_get_video_overlay_composition_meta(buffer.get());
  return meta != nullptr ? meta->overlay : nullptr;
}

bool sends_composition_caps(const Owned<GstHarness>& harness) {
  GstCaps* caps = gst_pad_get_current_caps(harness->sinkpad);
  const bool has_feature = gst_caps_features_contains(
      gst_caps_get_features(caps, 0), GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION);
  gst_caps_unref(caps);
  return has_feature;
}

TEST(EllipseOverlay, LeavesCompositionToDownstream) {
  // GStreamer always blends by BT.709, and takes each chroma sample from a single pixel.
  for (const char* format : {"BGRx", "RGB", "ARGB", "Y444", "I420"}) {
    const GstVideoInfo info = info_of(format, 640, 480);
    const std::string caps =
        caps_of(format, 640, 480) + (GST_VIDEO_INFO_IS_YUV(&info) ? ",colorimetry=bt709" : "");
    const std::string element = std::string("ellipseoverlay ") + kAllParts;
    const Ellipse e{310.3, 200.6, 290.0, 150.0, 0.5};
    const auto buffer = [&] {
      auto fresh = even_buffer(format, 640, 480);
      add_ellipse(fresh.get(), e);
      return fresh;
    };
    const Bytes expected = bytes_of(push(harness_of(element, caps, caps), buffer()).get());

    const auto harness = composing_harness(element, caps);
    auto composed = push(harness, buffer());
    EXPECT_TRUE(sends_composition_caps(harness));
    ASSERT_NE(composition_on(composed), nullptr);
    EXPECT_EQ(bytes_of(composed.get()), bytes_of(even_buffer(format, 640, 480).get()));
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info, composed.get(), GST_MAP_READWRITE));
    EXPECT_TRUE(gst_video_overlay_composition_blend(composition_on(composed), &frame));
    gst_video_frame_unmap(&frame);
    const Bytes blended = bytes_of(composed.get());
    for (const Sample& sample : samples_of(info)) {
      if (sample.block.width > 1) continue;
      ASSERT_NEAR(blended[sample.at], expected[sample.at], 2)
          << format << ' ' << sample.block.x << ' ' << sample.block.y << ' ' << sample.component;
    }
  }
}

TEST(EllipseOverlay, CompositionKeepsTheMemory) {
  const auto harness = composing_harness("ellipseoverlay", caps_of("I420", 64, 64));
  auto buffer = even_buffer("I420", 64, 64);
  add_circle(buffer.get(), 32.0, 32.0, 20.0);
  const Owned<GstBuffer> shared(gst_buffer_ref(buffer.get()));  // as after a tee
  const auto out = push(harness, std::move(buffer));
  EXPECT_NE(composition_on(out), nullptr);
  EXPECT_EQ(composition_on(shared), nullptr);
  EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), gst_buffer_peek_memory(shared.get(), 0));
}

TEST(EllipseOverlay, DrawsUnlessDownstreamOffersBothCapsAndMeta) {
  const std::string plain = caps_of("I420", 64, 64);
  const std::string with_feature =
      "video/x-raw(memory:SystemMemory, meta:GstVideoOverlayComposition); video/x-raw";
  for (const bool has_feature : {false, true}) {
    const Owned<GstHarness> harness(gst_harness_new("ellipseoverlay"));
    gst_harness_set_sink_caps_str(harness.get(),
                                  has_feature ? with_feature.c_str() : plain.c_str());
    if (!has_feature) {
      gst_harness_add_propose_allocation_meta(
          harness.get(), GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE, nullptr);
    }
    gst_harness_set_src_caps_str(harness.get(), plain.c_str());
    auto buffer = even_buffer("I420", 64, 64);
    add_circle(buffer.get(), 32.0, 32.0, 20.0);
    const auto out = push(harness, std::move(buffer));
    EXPECT_FALSE(sends_composition_caps(harness)) << has_feature;
    EXPECT_EQ(composition_on(out), nullptr) << has_feature;
    EXPECT_NE(bytes_of(out.get()), bytes_of(even_buffer("I420", 64, 64).get())) << has_feature;
  }
}

TEST(EllipseOverlay, AddsToAnExistingComposition) {
  const std::string caps = caps_of("I420", 64, 64);
  const auto rectangles = [&](const std::string& elements) {
    auto buffer = even_buffer("I420", 64, 64);
    add_circle(buffer.get(), 32.0, 32.0, 20.0);
    const auto out = push(composing_harness(elements, caps), std::move(buffer));
    return gst_video_overlay_composition_n_rectangles(composition_on(out));
  };
  EXPECT_EQ(rectangles("ellipseoverlay overlay=ellipse"), 1U);
  EXPECT_EQ(rectangles("ellipseoverlay overlay=ellipse ! ellipseoverlay overlay=centre"), 2U);
}

TEST(EllipseOverlay, FailsNegotiationRatherThanLoseACompositionFromUpstream) {
  const Owned<GstHarness> harness(gst_harness_new("ellipseoverlay"));
  gst_harness_set_sink_caps_str(harness.get(), caps_of("I420", 64, 64).c_str());
  gst_harness_set_src_caps_str(
      harness.get(),
      "video/x-raw(memory:SystemMemory, meta:GstVideoOverlayComposition),format=I420,width=64,"
      "height=64,framerate=30/1");
  EXPECT_EQ(gst_harness_push(harness.get(), even_buffer("I420", 64, 64).release()),
            GST_FLOW_NOT_NEGOTIATED);
}

TEST(EllipseOverlay, FollowsDownstreamRenegotiation) {
  const std::string caps = caps_of("I420", 64, 64);
  const auto harness = composing_harness("ellipseoverlay", caps);
  const auto frame = [] {
    auto buffer = even_buffer("I420", 64, 64);
    add_circle(buffer.get(), 32.0, 32.0, 20.0);
    return buffer;
  };
  EXPECT_NE(composition_on(push(harness, frame())), nullptr);
  gst_harness_set_sink_caps_str(harness.get(), caps.c_str());  // requests a renegotiation
  EXPECT_EQ(composition_on(push(harness, frame())), nullptr);
  EXPECT_FALSE(sends_composition_caps(harness));
}

}  // namespace
