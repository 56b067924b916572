#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "core/image/luma.hpp"

/// The raw formats whose luma is read where it lies, or computed from 8-bit red, green and blue.
#define GST_ELLIPSE_VIDEO_FORMATS                                                               \
  "{ GRAY8, I420, YV12, NV12, NV21, NV16, Y41B, Y42B, Y444, YUY2, UYVY, YVYU, RGB, BGR, RGBx, " \
  "BGRx, xRGB, xBGR, RGBA, BGRA, ARGB, ABGR }"

/// Gives an element class a sink and a source pad for these formats.
void add_video_pad_templates(GstElementClass* element_class);

/// The same, for an element that also knows pictures with an overlay beside their pixels.
void add_composing_pad_templates(GstElementClass* element_class);

/// A video buffer mapped while this lives. Takes no reference, so that metadata can be attached to
/// the buffer meanwhile.
class MappedFrame {
 public:
  MappedFrame(const GstVideoInfo& info, GstBuffer* buffer, GstMapFlags access);
  ~MappedFrame();
  MappedFrame(const MappedFrame&) = delete;
  MappedFrame& operator=(const MappedFrame&) = delete;

  /// False where the buffer cannot be mapped, such as when it is too small for its caps.
  [[nodiscard]] bool is_mapped() const { return is_mapped_; }
  [[nodiscard]] GstVideoFrame& frame() { return frame_; }

 private:
  GstVideoFrame frame_{};
  bool is_mapped_;
};

/// A mapped frame of one of these formats as the core sees it. Copies no pixel; valid while mapped.
[[nodiscard]] ellipse::PixelView pixel_view_of(const GstVideoFrame& frame);
