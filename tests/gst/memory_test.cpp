// SPDX-License-Identifier: MIT
//
// Memory that is slow to read, like a capture device's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"
#include "tests/support/page_watch.hpp"

namespace {

using support::caps_of;
using support::info_of;
using support::kRing;
using support::Owned;
using support::PageWatch;
using support::push;
using support::ring_picture;
using support::target_on;
using support::tracker;

constexpr int kFrameWidth = 320;
constexpr int kFrameHeight = 240;

// An allocator of non-system memory, which wraps existing bytes.
struct DeviceAllocator {
  GstAllocator parent;
};
struct DeviceAllocatorClass {
  GstAllocatorClass parent;
};
GType device_allocator_get_type();
G_DEFINE_TYPE(DeviceAllocator, device_allocator, GST_TYPE_ALLOCATOR)

struct DeviceMemory {
  GstMemory parent;
  std::uint8_t* data;
};

void device_allocator_class_init(DeviceAllocatorClass* klass) {
  klass->parent.alloc = nullptr;
  klass->parent.free = [](GstAllocator*, GstMemory* memory) {
    delete reinterpret_cast<DeviceMemory*>(memory);
  };
}

void device_allocator_init(DeviceAllocator* self) {
  GstAllocator* allocator = &self->parent;
  allocator->mem_type = "TestDevice";
  allocator->mem_map = [](GstMemory* memory, gsize, GstMapFlags) -> gpointer {
    return reinterpret_cast<DeviceMemory*>(memory)->data;
  };
  allocator->mem_unmap = [](GstMemory*) {};
  GST_OBJECT_FLAG_SET(allocator, GST_ALLOCATOR_FLAG_CUSTOM_ALLOC);
}

GstMemory* device_memory(GstAllocator* allocator, std::uint8_t* data, gsize size) {
  auto* memory = new DeviceMemory();
  gst_memory_init(&memory->parent,
                  static_cast<GstMemoryFlags>(GST_MEMORY_FLAG_NO_SHARE),
                  allocator,
                  nullptr,
                  size,
                  0,
                  0,
                  size);
  memory->data = data;
  return &memory->parent;
}

// Frames of I420 with one page for each row of luma and of chroma.
class Device {
 public:
  Device()
      : allocator_(static_cast<GstAllocator*>(g_object_new(device_allocator_get_type(), nullptr))) {
    gst_object_ref_sink(allocator_);
    std::memset(pages_.data(), 128, kRows * PageWatch::kPage);
  }
  ~Device() { gst_object_unref(allocator_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void show(const support::GrayPicture& picture) {
    for (int y = 0; y < kFrameHeight; ++y) {
      std::memcpy(pages_.data() + static_cast<std::size_t>(y) * PageWatch::kPage,
                  picture.view().row(y),
                  kFrameWidth);
    }
  }

  [[nodiscard]] Owned<GstBuffer> frame(GstClockTime pts) const {
    GstBuffer* buffer = gst_buffer_new();
    gst_buffer_append_memory(buffer,
                             device_memory(allocator_, pages_.data(), kRows * PageWatch::kPage));
    gsize offset[GST_VIDEO_MAX_PLANES] = {
        0, kFrameHeight * PageWatch::kPage, (kFrameHeight + kFrameHeight / 2) * PageWatch::kPage};
    gint stride[GST_VIDEO_MAX_PLANES] = {PageWatch::kPage, PageWatch::kPage, PageWatch::kPage};
    gst_buffer_add_video_meta_full(buffer,
                                   GST_VIDEO_FRAME_FLAG_NONE,
                                   GST_VIDEO_FORMAT_I420,
                                   kFrameWidth,
                                   kFrameHeight,
                                   3,
                                   offset,
                                   stride);
    GST_BUFFER_PTS(buffer) = pts;
    return Owned<GstBuffer>(buffer);
  }

  [[nodiscard]] PageWatch& pages() { return pages_; }

 private:
  static constexpr std::size_t kRows = 2UL * kFrameHeight;
  PageWatch pages_{kRows};
  GstAllocator* allocator_;
};

std::vector<std::size_t> all_rows() {
  std::vector<std::size_t> rows(kFrameHeight);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

class EachTracking : public testing::TestWithParam<const char*> {};

// 20 frames: detection, then tracking with periodic searches of the whole frame. A search also
// reads the pixels left and right of the tracked region.
TEST_P(EachTracking, SlowMemoryIsReadOnceAndInOrder) {
  const std::string settings = std::string("tracking=") + GetParam();
  const auto harness = tracker(settings, caps_of("I420", kFrameWidth, kFrameHeight));
  const auto reference = tracker(settings, caps_of("I420", kFrameWidth, kFrameHeight));
  Device device;
  const support::GrayPicture picture = ring_picture(kFrameWidth, kFrameHeight);
  device.show(picture);
  int in_order = 0;
  for (guint i = 0; i < 20; ++i) {
    const GstClockTime pts = i * GST_SECOND / 30;
    auto frame = device.frame(pts);
    auto plain = support::buffer_of(picture, info_of("I420", kFrameWidth, kFrameHeight));
    GST_BUFFER_PTS(plain.get()) = pts;
    device.pages().start();
    const auto out = push(harness, std::move(frame));
    const std::vector<std::size_t> rows = device.pages().stop();
    const auto expected = push(reference, std::move(plain));
    ASSERT_NE(target_on(out), nullptr) << i;
    EXPECT_EQ(target_on(out)->cx, target_on(expected)->cx);
    EXPECT_EQ(target_on(out)->semi_major, target_on(expected)->semi_major);
    std::map<std::size_t, int> visits;
    for (const std::size_t row : rows) ++visits[row];
    for (const auto& [row, count] : visits) {
      EXPECT_LT(row, std::size_t{kFrameHeight}) << "chroma";
      EXPECT_LE(count, 3) << row;
    }
    if (i == 0) {
      EXPECT_EQ(rows, all_rows());
    }
    in_order += std::is_sorted(rows.begin(), rows.end(), std::less_equal<>()) ? 1 : 0;
    EXPECT_GT(rows.size(), 70U);  // the ring is 80 px high
  }
  EXPECT_GE(in_order, 16);
}

INSTANTIATE_TEST_SUITE_P(Tracking,
                         EachTracking,
                         testing::Values("none", "redetect", "edges"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
