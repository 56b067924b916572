// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using support::buffer_of;
using support::BusTap;
using support::caps_of;
using support::element_of;
using support::GrayPicture;
using support::info_of;
using support::kRing;
using support::Owned;
using support::push;
using support::ring_picture;
using support::target_on;
using support::tracker;

constexpr int kLargest = 8192;

// A black frame; pages that are never written take no memory.
Owned<GstBuffer> black(const GstVideoInfo& info) {
  const gsize size = GST_VIDEO_INFO_SIZE(&info);
  void* pixels = std::calloc(size, 1);
  return Owned<GstBuffer>(gst_buffer_new_wrapped_full(
      static_cast<GstMemoryFlags>(0), pixels, size, 0, size, pixels, std::free));
}

void paint(GstBuffer* buffer, const GstVideoInfo& info, const GrayPicture& picture, int x, int y) {
  GstVideoFrame frame;
  ASSERT_TRUE(gst_video_frame_map(&frame, &info, buffer, GST_MAP_WRITE));
  const guint components = GST_VIDEO_FORMAT_INFO_IS_RGB(info.finfo) ? 3 : 1;
  for (guint c = 0; c < components; ++c) {
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column) {
        support::set_sample(frame, c, x + column, y + row, picture.view().row(row)[column]);
      }
    }
  }
  gst_video_frame_unmap(&frame);
}

class EachFormat : public testing::TestWithParam<const char*> {};

TEST_P(EachFormat, PassesInTheSmallestAndTheThinnestFrames) {
  const auto harness = tracker();
  const auto pass = [&](int width, int height) {
    const std::string caps = caps_of(GetParam(), width, height);
    gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
    auto buffer = black(info_of(GetParam(), width, height));
    const gsize size = gst_buffer_get_size(buffer.get());
    const auto out = push(harness, std::move(buffer));
    ASSERT_TRUE(out) << width << 'x' << height;
    EXPECT_EQ(gst_buffer_get_size(out.get()), size);
  };
  for (int width = 1; width <= 5; ++width) {
    for (int height = 1; height <= 5; ++height) pass(width, height);
  }
  pass(kLargest, 1);
  pass(1, kLargest);
  pass(kLargest, 3);
}

TEST_P(EachFormat, FindsTargetsInTheFarCornerOfTheLargestFrames) {
  const GstVideoInfo info = info_of(GetParam(), kLargest, kLargest);
  auto buffer = black(info);
  const GrayPicture ring = ring_picture();
  const int x = kLargest - ring.width;
  const int y = kLargest - ring.height;
  paint(buffer.get(), info, ring, x, y);
  const auto harness = tracker("", caps_of(GetParam(), kLargest, kLargest));
  const auto out = push(harness, std::move(buffer));
  const GstEllipseMeta* meta = target_on(out);
  ASSERT_NE(meta, nullptr);
  EXPECT_NEAR(meta->cx, x + kRing.cx, 0.2);
  EXPECT_NEAR(meta->cy, y + kRing.cy, 0.2);
  EXPECT_NEAR(meta->semi_major, kRing.semi_major, 0.3);
}

TEST_P(EachFormat, SharedPixelsAreNotCopied) {
  const auto harness = tracker("", caps_of(GetParam(), 320, 240));
  auto buffer = buffer_of(ring_picture(), info_of(GetParam(), 320, 240));
  const Owned<GstBuffer> shared(gst_buffer_ref(buffer.get()));  // as after a tee
  const std::string before = support::bytes_of(shared.get());
  const auto out = push(harness, std::move(buffer));
  EXPECT_NE(target_on(out), nullptr);
  EXPECT_EQ(target_on(shared), nullptr);
  ASSERT_EQ(gst_buffer_n_memory(out.get()), gst_buffer_n_memory(shared.get()));
  for (guint i = 0; i < gst_buffer_n_memory(out.get()); ++i) {
    EXPECT_EQ(gst_buffer_peek_memory(out.get(), i), gst_buffer_peek_memory(shared.get(), i));
  }
  EXPECT_EQ(support::bytes_of(out.get()), before);
}

TEST_P(EachFormat, AcceptsAnyStridesAndPlaneOffsets) {
  const GrayPicture ring = ring_picture();
  const GstVideoInfo plain = info_of(GetParam(), ring.width, ring.height);
  GstVideoInfo info = plain;
  GstVideoAlignment around;
  gst_video_alignment_reset(&around);
  around.padding_left = 8;
  around.padding_right = 24;
  around.padding_top = 4;
  around.padding_bottom = 2;
  ASSERT_TRUE(gst_video_info_align(&info, &around));
  EXPECT_GT(GST_VIDEO_INFO_PLANE_OFFSET(&info, 0), 0U);
  auto padded = buffer_of(ring, info);
  gst_buffer_add_video_meta_full(padded.get(),
                                 GST_VIDEO_FRAME_FLAG_NONE,
                                 GST_VIDEO_INFO_FORMAT(&info),
                                 static_cast<guint>(ring.width),
                                 static_cast<guint>(ring.height),
                                 GST_VIDEO_INFO_N_PLANES(&info),
                                 info.offset,
                                 info.stride);
  const std::string caps = caps_of(GetParam(), ring.width, ring.height);
  const auto out = push(tracker("", caps), std::move(padded));
  const auto expected = push(tracker("", caps), buffer_of(ring, plain));
  ASSERT_NE(target_on(out), nullptr);
  EXPECT_EQ(target_on(out)->cx, target_on(expected)->cx);
  EXPECT_EQ(target_on(out)->semi_major, target_on(expected)->semi_major);
}

INSTANTIATE_TEST_SUITE_P(Formats,
                         EachFormat,
                         testing::ValuesIn(support::all_formats()),
                         [](const auto& info) { return std::string(info.param); });

TEST(EllipseTrackFrames, MayBeReadOnly) {
  const GrayPicture picture = ring_picture();
  Owned<GstBuffer> buffer(
      gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY,
                                  const_cast<std::uint8_t*>(picture.pixels.data()),
                                  picture.pixels.size(),
                                  0,
                                  picture.pixels.size(),
                                  nullptr,
                                  nullptr));
  GstMemory* memory = gst_buffer_peek_memory(buffer.get(), 0);
  const auto harness = tracker();
  const auto out = push(harness, std::move(buffer));
  EXPECT_NE(target_on(out), nullptr);
  EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), memory);
}

TEST(EllipseTrackFrames, InterlacedFramesCauseAWarning) {
  for (const char* mode : {"progressive", "interleaved", "mixed", "fields"}) {
    Owned<GstHarness> harness(gst_harness_new_parse("ellipsetrack name=t"));
    BusTap bus(element_of(harness));
    const std::string caps = caps_of("GRAY8", 320, 240) + ",interlace-mode=" + mode;
    gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
    EXPECT_EQ(static_cast<bool>(bus.pop(GST_MESSAGE_WARNING)), std::string(mode) != "progressive");
  }
}

TEST(EllipseTrackFrames, UnsupportedFormatsFailWithTheListOfSupportedOnes) {
  for (const char* element : {"ellipsetrack", "ellipseoverlay"}) {
    support::Pipeline pipeline(
        std::string("filesrc location=/dev/zero num-buffers=100 ! rawvideoparse format=v210 "
                    "width=48 height=32 ! ") +
        element + " ! fakesink");
    ASSERT_EQ(pipeline.failure(), "");
    pipeline.play();
    const std::string words = pipeline.wait_for_end();
    EXPECT_NE(words.find("v210"), std::string::npos) << words;
    EXPECT_NE(words.find("GRAY8, I420"), std::string::npos) << words;
    EXPECT_NE(words.find("P010_10LE"), std::string::npos) << words;
    EXPECT_EQ(words.find("rggb") != std::string::npos, std::string(element) == "ellipsetrack");
  }
}

// A query about formats is not a stream error.
TEST(EllipseTrackFrames, QueriesForUnsupportedFormatsPostNoError) {
  const auto harness = tracker();
  BusTap bus(element_of(harness));
  GstCaps* caps = gst_caps_from_string(caps_of("v210", 48, 32).c_str());
  EXPECT_FALSE(gst_pad_peer_query_accept_caps(harness->srcpad, caps));
  gst_caps_unref(caps);
  EXPECT_FALSE(bus.pop(GST_MESSAGE_ERROR));
}

// Like a camera: GStreamer's own converter makes the mosaic.
TEST(EllipseTrackFrames, MosaicsAndTenBitsGiveTheSameEllipseAsGrey) {
  const auto centre_in = [](const std::string& format) {
    support::Pipeline pipeline("ellipsetestsrc num-buffers=5 ! videoconvert ! " + format +
                               " ! ellipsetrack name=t ! fakesink");
    if (pipeline.failure().starts_with(support::Pipeline::kNotInstalled)) return 0.0;
    EXPECT_EQ(pipeline.failure(), "");
    pipeline.play();
    EXPECT_EQ(pipeline.wait_for_end(), "") << format;
    const Owned<GstStructure> target(
        support::structure_property(pipeline.element("t").get(), "target"));
    double cx = 0.0;
    EXPECT_TRUE(target && gst_structure_get_double(target.get(), "cx", &cx)) << format;
    return cx;
  };
  const double grey = centre_in("video/x-raw,format=GRAY8");
  for (const char* format : {"P010_10LE", "I420_10LE", "GRAY16_LE", "GRAY10_LE32"}) {
    EXPECT_NEAR(centre_in(std::string("video/x-raw,format=") + format), grey, 0.02) << format;
  }
  for (const char* arrangement : support::kMosaics) {
    const double cx = centre_in(std::string("video/x-raw,format=ARGB ! rgb2bayer ! "
                                            "video/x-bayer,format=") +
                                arrangement);
    if (cx == 0.0) GTEST_SKIP() << "no rgb2bayer";
    EXPECT_NEAR(cx, grey, 0.05) << arrangement;
  }
}

}  // namespace
