#pragma once  // SPDX-License-Identifier: MIT

#include <gst/base/gstbasetransform.h>
#include <gst/video/video.h>

#include "core/image/luma.hpp"

/// Adds sink and source pad templates for the formats whose luma can be read to an element class:
/// raw video, and the mosaics of Bayer sensors.
void add_video_pad_templates(GstElementClass* element_class);

/// Adds pad templates for raw video that also accept the caps feature
/// meta:GstVideoOverlayComposition.
void add_composing_pad_templates(GstElementClass* element_class);

/// Posts an error with these caps and the formats of the sink pad, if a stream begins with the
/// caps. Does nothing for the caps of a query.
void report_unsupported_caps(GstBaseTransform* element, GstCaps* caps);

/// Whether these are the caps of a Bayer mosaic of 8 bits.
[[nodiscard]] bool is_mosaic(const GstCaps* caps);

/// Describes a mosaic as a GRAY8 frame with the same bytes. @return False if the caps have no size.
[[nodiscard]] bool set_mosaic_info(GstVideoInfo* info, const GstCaps* caps);

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
/// Memory other than system memory is treated as slow to read.
[[nodiscard]] ellipse::PixelView pixel_view_of(const GstVideoFrame& frame, bool is_mosaic = false);
