// SPDX-License-Identifier: MIT
#include "gst/track/video_view.hpp"

#define VIDEO_CAPS GST_VIDEO_CAPS_MAKE(GST_ELLIPSE_VIDEO_FORMATS)
#define COMPOSING_CAPS                                          \
  VIDEO_CAPS ";" GST_VIDEO_CAPS_MAKE_WITH_FEATURES(             \
      GST_CAPS_FEATURE_MEMORY_SYSTEM_MEMORY                     \
      ", " GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION, \
      GST_ELLIPSE_VIDEO_FORMATS)

static void add_pad_templates(GstElementClass* element_class, const char* description) {
  GstCaps* caps = gst_caps_from_string(description);
  gst_element_class_add_pad_template(
      element_class, gst_pad_template_new("sink", GST_PAD_SINK, GST_PAD_ALWAYS, caps));
  gst_element_class_add_pad_template(
      element_class, gst_pad_template_new("src", GST_PAD_SRC, GST_PAD_ALWAYS, caps));
  gst_caps_unref(caps);
}

void add_video_pad_templates(GstElementClass* element_class) {
  add_pad_templates(element_class, VIDEO_CAPS);
}

void add_composing_pad_templates(GstElementClass* element_class) {
  add_pad_templates(element_class, COMPOSING_CAPS);
}

MappedFrame::MappedFrame(const GstVideoInfo& info, GstBuffer* buffer, GstMapFlags access)
    : is_mapped_(gst_video_frame_map(
          &frame_,
          &info,
          buffer,
          static_cast<GstMapFlags>(static_cast<int>(access) |
                                   static_cast<int>(GST_VIDEO_FRAME_MAP_FLAG_NO_REF)))) {}

MappedFrame::~MappedFrame() {
  if (is_mapped_) gst_video_frame_unmap(&frame_);
}

ellipse::PixelView pixel_view_of(const GstVideoFrame& frame) {
  const GstVideoFormatInfo* format = frame.info.finfo;
  ellipse::PixelLayout layout;
  layout.pixel_stride = GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0);
  const auto* first = static_cast<const std::uint8_t*>(GST_VIDEO_FRAME_COMP_DATA(&frame, 0));
  if (GST_VIDEO_FORMAT_INFO_IS_RGB(format)) {
    layout.kind = ellipse::PixelLayout::Kind::kRgb;
    layout.red = GST_VIDEO_FORMAT_INFO_POFFSET(format, 0);
    layout.green = GST_VIDEO_FORMAT_INFO_POFFSET(format, 1);
    layout.blue = GST_VIDEO_FORMAT_INFO_POFFSET(format, 2);
    first -= layout.red;
  }
  return {first,
          GST_VIDEO_FRAME_WIDTH(&frame),
          GST_VIDEO_FRAME_HEIGHT(&frame),
          GST_VIDEO_FRAME_COMP_STRIDE(&frame, 0),
          layout};
}
