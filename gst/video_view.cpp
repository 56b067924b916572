// SPDX-License-Identifier: MIT
#include "gst/video_view.hpp"

#define VIDEO_CAPS GST_VIDEO_CAPS_MAKE(GST_ELLIPSE_VIDEO_FORMATS)

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));

void add_video_pad_templates(GstElementClass* element_class) {
  gst_element_class_add_static_pad_template(element_class, &sink_template);
  gst_element_class_add_static_pad_template(element_class, &src_template);
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
