#pragma once  // SPDX-License-Identifier: MIT

#include <gst/check/gstharness.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <json-glib/json-glib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "gst/ellipse/gstellipsemeta.h"
#include "tests/support/picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace support {

struct Unref {
  void operator()(GstHarness* h) const { gst_harness_teardown(h); }
  void operator()(GstElement* e) const { gst_object_unref(e); }
  void operator()(GstBuffer* b) const { gst_buffer_unref(b); }
  void operator()(GstMessage* m) const { gst_message_unref(m); }
  void operator()(GstStructure* s) const { gst_structure_free(s); }
  void operator()(JsonParser* p) const { g_object_unref(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

/// Timeout for a pipeline that should end by itself.
inline constexpr GstClockTime kPatience = 60 * GST_SECOND;

/// The formats of the pads of ellipsetrack and ellipseoverlay: planar luma, then packed YUV and
/// RGB.
inline constexpr std::array kPlanarFormats{
    "GRAY8", "I420", "YV12", "NV12", "NV21", "NV16", "Y41B", "Y42B", "Y444"};
inline constexpr std::array kPackedFormats{"YUY2",
                                           "UYVY",
                                           "YVYU",
                                           "RGB",
                                           "BGR",
                                           "RGBx",
                                           "BGRx",
                                           "xRGB",
                                           "xBGR",
                                           "RGBA",
                                           "BGRA",
                                           "ARGB",
                                           "ABGR"};
/// Formats with more than 8 bits.
inline constexpr std::array kDeepFormats{
    "GRAY16_LE", "GRAY16_BE", "GRAY10_LE16", "GRAY10_LE32", "I420_10LE", "P010_10LE"};
/// Bayer mosaics, which ellipsetrack alone reads.
inline constexpr std::array kMosaics{"bggr", "gbrg", "grbg", "rggb"};

/// Formats with one byte per sample.
inline std::vector<const char*> byte_formats() {
  std::vector<const char*> all(kPlanarFormats.begin(), kPlanarFormats.end());
  all.insert(all.end(), kPackedFormats.begin(), kPackedFormats.end());
  return all;
}
/// Raw formats that this GStreamer supports.
inline std::vector<const char*> raw_formats() {
  std::vector<const char*> all = byte_formats();
  for (const char* format : kDeepFormats) {
    if (gst_video_format_from_string(format) != GST_VIDEO_FORMAT_UNKNOWN) all.push_back(format);
  }
  return all;
}
inline std::vector<const char*> all_formats() {
  std::vector<const char*> all = raw_formats();
  all.insert(all.end(), kMosaics.begin(), kMosaics.end());
  return all;
}

inline bool is_mosaic(const std::string& format) {
  return std::find(kMosaics.begin(), kMosaics.end(), format) != kMosaics.end();
}

inline std::string caps_of(const std::string& format, int width, int height) {
  return (is_mosaic(format) ? "video/x-bayer,format=" : "video/x-raw,format=") + format +
         ",width=" + std::to_string(width) + ",height=" + std::to_string(height) +
         ",framerate=30/1";
}

/// For a mosaic: that of GRAY8, which has the same bytes.
inline GstVideoInfo info_of(const std::string& format, int width, int height) {
  GstVideoInfo info;
  const std::string caps_text = caps_of(is_mosaic(format) ? "GRAY8" : format, width, height);
  GstCaps* caps = gst_caps_from_string(caps_text.c_str());
  gst_video_info_from_caps(&info, caps);
  gst_caps_unref(caps);
  return info;
}

/// The first sample of a component. GStreamer 1.22 is one byte off for V of P010.
inline guint8* samples_of(GstVideoFrame& frame, guint component) {
  auto* plane = static_cast<guint8*>(
      GST_VIDEO_FRAME_PLANE_DATA(&frame, GST_VIDEO_FORMAT_INFO_PLANE(frame.info.finfo, component)));
  const int offset = GST_VIDEO_FORMAT_INFO_POFFSET(frame.info.finfo, component);
  const bool is_deep = GST_VIDEO_FORMAT_INFO_DEPTH(frame.info.finfo, component) > 8;
  return plane + (is_deep ? (offset + 1) / 2 * 2 : offset);
}

/// Sets a sample in a frame of any depth; `level` is its 8 most significant bits.
inline void set_sample(GstVideoFrame& frame, guint component, int x, int y, guint8 level) {
  const GstVideoFormatInfo* format = frame.info.finfo;
  guint8* row = samples_of(frame, component) +
                std::ptrdiff_t{y} * GST_VIDEO_FRAME_COMP_STRIDE(&frame, component);
  guint8* at = row + std::ptrdiff_t{x} * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, component);
  const guint depth = GST_VIDEO_FORMAT_INFO_DEPTH(format, component);
  const guint value = (guint{level} << (depth - 8U))
                      << GST_VIDEO_FORMAT_INFO_SHIFT(format, component);
  if (GST_VIDEO_FORMAT_INFO_FORMAT(format) == GST_VIDEO_FORMAT_GRAY10_LE32) {
    at = row + std::ptrdiff_t{x / 3} * 4;
    const guint shift = static_cast<guint>(x % 3) * 10U;
    const guint32 others = GST_READ_UINT32_LE(at) & ~(1023U << shift);
    GST_WRITE_UINT32_LE(at, others | guint{level} << (shift + 2U));
  } else if (depth == 8) {
    *at = level;
  } else if (GST_VIDEO_FORMAT_INFO_IS_LE(format)) {
    GST_WRITE_UINT16_LE(at, static_cast<guint16>(value));
  } else {
    GST_WRITE_UINT16_BE(at, static_cast<guint16>(value));
  }
}

/// A buffer of any format with a grey picture.
inline Owned<GstBuffer> buffer_of(const GrayPicture& picture, const GstVideoInfo& info) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  const guint8 neutral = GST_VIDEO_INFO_IS_RGB(&info) ? 255 : 128;  // alpha, or chroma
  gst_buffer_memset(buffer, 0, neutral, GST_VIDEO_INFO_SIZE(&info));
  GstVideoFrame frame;
  gst_video_frame_map(&frame, &info, buffer, GST_MAP_WRITE);
  const guint components = GST_VIDEO_FORMAT_INFO_IS_RGB(info.finfo) ? 3 : 1;
  for (guint c = 0; c < components; ++c) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        set_sample(frame, c, x, y, picture.view().row(y)[x]);
      }
    }
  }
  for (guint c = components; c < GST_VIDEO_INFO_N_COMPONENTS(&info); ++c) {
    if (GST_VIDEO_INFO_COMP_DEPTH(&info, c) == 8) continue;
    for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c); ++y) {
      for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&frame, c); ++x) {
        set_sample(frame, c, x, y, neutral);
      }
    }
  }
  gst_video_frame_unmap(&frame);
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = GST_SECOND / 30;
  return Owned<GstBuffer>(buffer);
}

inline Owned<GstBuffer> gray_buffer_of(const GrayPicture& picture) {
  return buffer_of(picture, info_of("GRAY8", picture.width, picture.height));
}

/// One element or several in sequence, between two test pads.
inline Owned<GstHarness> harness_of(const std::string& element,
                                    const std::string& in,
                                    const std::string& out) {
  Owned<GstHarness> harness(gst_harness_new_parse(element.c_str()));
  gst_harness_set_caps_str(harness.get(), in.c_str(), out.c_str());
  return harness;
}

/// Adds a tracked target.
inline void add_circle(GstBuffer* buffer, double cx, double cy, double radius) {
  GstEllipseMeta* meta = gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  meta->id = 1;
  meta->state = GST_ELLIPSE_STATE_TRACKED;
  meta->cx = cx;
  meta->cy = cy;
  meta->semi_major = radius;
  meta->semi_minor = radius;
  meta->roi_width = 10;
  meta->roi_height = 10;
}

/// Makes downstream accept any picture, and overlay compositions beside it.
inline void offer_composition(GstHarness* harness) {
  gst_harness_set_sink_caps_str(
      harness, "video/x-raw(memory:SystemMemory, meta:GstVideoOverlayComposition); video/x-raw");
  gst_harness_add_propose_allocation_meta(
      harness, GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE, nullptr);
}

/// The first component of a buffer: its luma, or one colour of a grey picture.
inline GrayPicture picture_of(GstBuffer* buffer, const GstVideoInfo& info) {
  GrayPicture picture(GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info));
  GstVideoFrame frame;
  if (!gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ)) return picture;
  for (int y = 0; y < picture.height; ++y) {
    const auto* row = static_cast<const guint8*>(GST_VIDEO_FRAME_COMP_DATA(&frame, 0)) +
                      std::ptrdiff_t{y} * GST_VIDEO_FRAME_COMP_STRIDE(&frame, 0);
    for (int x = 0; x < picture.width; ++x) {
      picture.at(x, y) = row[x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0)];
    }
  }
  gst_video_frame_unmap(&frame);
  return picture;
}

inline std::string bytes_of(GstBuffer* buffer) {
  GstMapInfo map;
  if (!gst_buffer_map(buffer, &map, GST_MAP_READ)) return {};
  std::string bytes(reinterpret_cast<const char*>(map.data), map.size);
  gst_buffer_unmap(buffer, &map);
  return bytes;
}

/// Receives the messages of one element on a bus of its own.
class BusTap {
 public:
  explicit BusTap(GstElement* element) : bus_(gst_bus_new()) { gst_element_set_bus(element, bus_); }
  ~BusTap() { gst_object_unref(bus_); }
  BusTap(const BusTap&) = delete;
  BusTap& operator=(const BusTap&) = delete;

  Owned<GstMessage> pop(GstMessageType type) {
    return Owned<GstMessage>(gst_bus_pop_filtered(bus_, type));
  }

 private:
  GstBus* bus_;
};

/// A pipeline from a description; its state is NULL at first and at the end.
class Pipeline {
 public:
  explicit Pipeline(const std::string& description) {
    GError* error = nullptr;
    pipeline_.reset(gst_parse_launch(description.c_str(), &error));
    if (error == nullptr) return;
    if (g_error_matches(error, GST_PARSE_ERROR, GST_PARSE_ERROR_NO_SUCH_ELEMENT)) {
      failure_ = kNotInstalled;
    }
    failure_ += text_of(error);
  }
  ~Pipeline() {
    if (pipeline_) gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  [[nodiscard]] GstElement* get() const { return pipeline_.get(); }
  /// The error in the description; empty if valid. Begins with kNotInstalled if an element is
  /// missing.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  static constexpr char kNotInstalled[] = "not installed: ";
  [[nodiscard]] Owned<GstElement> element(const std::string& name) const {
    return Owned<GstElement>(gst_bin_get_by_name(GST_BIN(pipeline_.get()), name.c_str()));
  }
  /// Waits until the first buffer is at the sink.
  void pause() {
    gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
    gst_element_get_state(pipeline_.get(), nullptr, nullptr, 60 * GST_SECOND);
  }
  void play() { gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING); }
  /// Discards the messages on the bus.
  void clear_messages() {
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    while (Owned<GstMessage>(gst_bus_pop(bus))) continue;
    gst_object_unref(bus);
  }
  /// @return The error's text; empty at EOS.
  [[nodiscard]] std::string wait_for_end(GstClockTime patience = kPatience) {
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    const Owned<GstMessage> message(gst_bus_timed_pop_filtered(
        bus, patience, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
    gst_object_unref(bus);
    if (!message) return "timed out";
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return "";
    GError* error = nullptr;
    gst_message_parse_error(message.get(), &error, nullptr);
    return text_of(error);
  }

 private:
  static std::string text_of(GError* error) {
    std::string text = error->message;
    g_error_free(error);
    return text;
  }

  Owned<GstElement> pipeline_;
  std::string failure_;
};

/// Runs a pipeline until EOS or an error. @return the error's text; empty at EOS.
inline std::string run_pipeline(const std::string& description,
                                const std::function<void(GstElement*)>& prepare = {},
                                GstClockTime patience = kPatience) {
  Pipeline pipeline(description);
  if (!pipeline.failure().empty()) return pipeline.failure();
  if (prepare) prepare(pipeline.get());
  pipeline.play();
  return pipeline.wait_for_end(patience);
}

/// Parses the lines of NDJSON; fails the test with a null root at a line that is not JSON.
inline std::vector<Owned<JsonParser>> parse_ndjson(std::istream&& in) {
  std::vector<Owned<JsonParser>> lines;
  for (std::string line; std::getline(in, line);) {
    Owned<JsonParser> parser(json_parser_new());
    json_parser_load_from_data(parser.get(), line.c_str(), -1, nullptr);
    lines.push_back(std::move(parser));
  }
  return lines;
}

inline std::vector<Owned<JsonParser>> read_ndjson(const std::string& file) {
  return parse_ndjson(std::ifstream(file));
}

inline JsonObject* object_of(const Owned<JsonParser>& line) {
  JsonNode* root = json_parser_get_root(line.get());
  return root != nullptr ? json_node_get_object(root) : nullptr;
}

}  // namespace support
