// SPDX-License-Identifier: MIT
#include "gst/track/video_view.hpp"

#include <string>

// Bayer mosaics in all four arrangements.
static constexpr char kMosaicCaps[] =
    "video/x-bayer, format=(string){ bggr, gbrg, grbg, rggb }, width=(int)[ 1, max ], "
    "height=(int)[ 1, max ], framerate=(fraction)[ 0, max ]";

static constexpr const char* kVideoFormats[] = {
    "GRAY8", "I420",      "YV12",      "NV12",        "NV21",        "NV16",      "Y41B",
    "Y42B",  "Y444",      "YUY2",      "UYVY",        "YVYU",        "RGB",       "BGR",
    "RGBx",  "BGRx",      "xRGB",      "xBGR",        "RGBA",        "BGRA",      "ARGB",
    "ABGR",  "GRAY16_LE", "GRAY16_BE", "GRAY10_LE16", "GRAY10_LE32", "I420_10LE", "P010_10LE"};

// The raw formats that this version of GStreamer supports: 1.22 does not have GRAY10_LE16.
static GstCaps* video_caps() {
  GstCaps* caps = gst_caps_from_string(GST_VIDEO_CAPS_MAKE("GRAY8"));
  GValue formats = G_VALUE_INIT;
  g_value_init(&formats, GST_TYPE_LIST);
  for (const char* name : kVideoFormats) {
    if (gst_video_format_from_string(name) == GST_VIDEO_FORMAT_UNKNOWN) continue;
    GValue format = G_VALUE_INIT;
    g_value_init(&format, G_TYPE_STRING);
    g_value_set_static_string(&format, name);
    gst_value_list_append_and_take_value(&formats, &format);
  }
  gst_caps_set_value(caps, "format", &formats);
  g_value_unset(&formats);
  return caps;
}

static GstCaps* composing_caps() {
  GstCaps* caps = video_caps();
  GstCaps* composed = gst_caps_copy(caps);
  gst_caps_set_features_simple(
      composed,
      gst_caps_features_new(GST_CAPS_FEATURE_MEMORY_SYSTEM_MEMORY,
                            GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION,
                            nullptr));
  gst_caps_append(caps, composed);
  return caps;
}

static void add_pad_templates(GstElementClass* element_class, GstCaps* caps) {
  gst_element_class_add_pad_template(
      element_class, gst_pad_template_new("sink", GST_PAD_SINK, GST_PAD_ALWAYS, caps));
  gst_element_class_add_pad_template(
      element_class, gst_pad_template_new("src", GST_PAD_SRC, GST_PAD_ALWAYS, caps));
  gst_caps_unref(caps);
}

void add_video_pad_templates(GstElementClass* element_class) {
  GstCaps* caps = video_caps();
  gst_caps_append(caps, gst_caps_from_string(kMosaicCaps));
  add_pad_templates(element_class, caps);
}

void add_composing_pad_templates(GstElementClass* element_class) {
  add_pad_templates(element_class, composing_caps());
}

// The formats of the caps, separated by commas.
static std::string formats_of(const GstCaps* caps) {
  std::string formats;
  for (guint i = 0; i < gst_caps_get_size(caps); ++i) {
    const GValue* list = gst_structure_get_value(gst_caps_get_structure(caps, i), "format");
    for (guint k = 0; k < gst_value_list_get_size(list); ++k) {
      formats += formats.empty() ? "" : ", ";
      formats += g_value_get_string(gst_value_list_get_value(list, k));
    }
  }
  return formats;
}

void report_unsupported_caps(GstBaseTransform* element, GstCaps* caps) {
  GstPad* sink = GST_BASE_TRANSFORM_SINK_PAD(element);
  GstPad* peer = gst_pad_get_peer(sink);
  if (peer == nullptr) return;
  // The current caps of the peer are those of its stream, even before it has sent them.
  GstCaps* begun = gst_pad_get_current_caps(peer);
  gst_object_unref(peer);
  const bool is_stream = begun != nullptr && gst_caps_is_equal(begun, caps) != FALSE;
  gst_clear_caps(&begun);
  if (!is_stream) return;
  GstCaps* served = gst_pad_get_pad_template_caps(sink);
  gchar* caps_text = gst_caps_to_string(caps);
  GST_ELEMENT_ERROR(
      element,
      STREAM,
      FORMAT,
      ("Cannot read %s. Put videoconvert upstream, or use one of %s, in system memory.",
       caps_text,
       formats_of(served).c_str()),
      (nullptr));
  g_free(caps_text);
  gst_caps_unref(served);
}

bool is_mosaic(const GstCaps* caps) {
  return gst_structure_has_name(gst_caps_get_structure(caps, 0), "video/x-bayer") != FALSE;
}

bool set_mosaic_info(GstVideoInfo* info, const GstCaps* caps) {
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  gint width = 0;
  gint height = 0;
  if (!gst_structure_get_int(structure, "width", &width) ||
      !gst_structure_get_int(structure, "height", &height) ||
      !gst_video_info_set_format(
          info, GST_VIDEO_FORMAT_GRAY8, static_cast<guint>(width), static_cast<guint>(height))) {
    return false;
  }
  gst_structure_get_fraction(structure, "framerate", &info->fps_n, &info->fps_d);
  return true;
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

// The layout of the luma, or of red, green and blue.
static ellipse::PixelLayout layout_of(const GstVideoFrame& frame) {
  using Kind = ellipse::PixelLayout::Kind;
  const GstVideoFormatInfo* format = frame.info.finfo;
  ellipse::PixelLayout layout;
  layout.pixel_stride = GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0);
  if (GST_VIDEO_FORMAT_INFO_IS_RGB(format)) {
    layout.kind = Kind::kRgb;
    layout.red = GST_VIDEO_FORMAT_INFO_POFFSET(format, 0);
    layout.green = GST_VIDEO_FORMAT_INFO_POFFSET(format, 1);
    layout.blue = GST_VIDEO_FORMAT_INFO_POFFSET(format, 2);
    return layout;
  }
  layout.luma = GST_VIDEO_FORMAT_INFO_POFFSET(format, 0);
  const int unread_bits = static_cast<int>(GST_VIDEO_FORMAT_INFO_SHIFT(format, 0) +
                                           GST_VIDEO_FORMAT_INFO_DEPTH(format, 0)) -
                          8;
  if (GST_VIDEO_FORMAT_INFO_FORMAT(format) == GST_VIDEO_FORMAT_GRAY10_LE32) {
    layout.kind = Kind::kPacked;
  } else if (unread_bits == 8 && GST_VIDEO_FORMAT_INFO_IS_LE(format)) {
    layout.luma += 1;
  } else if (unread_bits > 0 && unread_bits < 8) {
    layout.kind = Kind::kWord;
    layout.shift = unread_bits;
  }
  return layout;
}

ellipse::PixelView pixel_view_of(const GstVideoFrame& frame, bool is_mosaic) {
  ellipse::PixelLayout layout = layout_of(frame);
  if (is_mosaic) layout.kind = ellipse::PixelLayout::Kind::kMosaic;
  const GstVideoFormatInfo* format = frame.info.finfo;
  ellipse::PixelView view(static_cast<const std::uint8_t*>(GST_VIDEO_FRAME_COMP_DATA(&frame, 0)) -
                              GST_VIDEO_FORMAT_INFO_POFFSET(format, 0),
                          GST_VIDEO_FRAME_WIDTH(&frame),
                          GST_VIDEO_FRAME_HEIGHT(&frame),
                          GST_VIDEO_FRAME_COMP_STRIDE(&frame, 0),
                          layout);
  const GstMemory* memory = frame.map[0].memory;
  view.is_slow = memory != nullptr && memory->allocator != nullptr &&
                 g_strcmp0(memory->allocator->mem_type, GST_ALLOCATOR_SYSMEM) != 0;
  return view;
}
