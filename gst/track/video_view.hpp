#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "core/image/luma.hpp"

/// Raw formats whose luma is read in place or computed from 8-bit red, green and blue.
#define GST_ELLIPSE_VIDEO_FORMATS                                                               \
  "{ GRAY8, I420, YV12, NV12, NV21, NV16, Y41B, Y42B, Y444, YUY2, UYVY, YVYU, RGB, BGR, RGBx, " \
  "BGRx, xRGB, xBGR, RGBA, BGRA, ARGB, ABGR }"

/// Adds sink and source pad templates for these formats to an element class.
void add_video_pad_templates(GstElementClass* element_class);

/// Adds pad templates that also accept the caps feature meta:GstVideoOverlayComposition.
void add_composing_pad_templates(GstElementClass* element_class);

/// Maps a video buffer for its lifetime. Takes no reference, so that metadata can be attached to
/// the mapped buffer.
class MappedFrame {
 public:
  MappedFrame(const GstVideoInfo& info, GstBuffer* buffer, GstMapFlags access);
  ~MappedFrame();
  MappedFrame(const MappedFrame&) = delete;
  MappedFrame& operator=(const MappedFrame&) = delete;

  /// False if the buffer cannot be mapped, such as one that is too small for its caps.
  [[nodiscard]] bool is_mapped() const { return is_mapped_; }
  [[nodiscard]] GstVideoFrame& frame() { return frame_; }

 private:
  GstVideoFrame frame_{};
  bool is_mapped_;
};

/// A view of a mapped frame in one of these formats. Copies no pixel; valid while it is mapped.
[[nodiscard]] ellipse::PixelView pixel_view_of(const GstVideoFrame& frame);
