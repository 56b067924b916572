#pragma once  // SPDX-License-Identifier: MIT

#include <gst/check/gstharness.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <json-glib/json-glib.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gst/ellipse/gstellipsemeta.h"
#include "tests/support/picture.hpp"

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

inline std::string caps_of(const std::string& format, int width, int height) {
  return "video/x-raw,format=" + format + ",width=" + std::to_string(width) +
         ",height=" + std::to_string(height) + ",framerate=30/1";
}

inline GstVideoInfo info_of(const std::string& format, int width, int height) {
  GstVideoInfo info;
  GstCaps* caps = gst_caps_from_string(caps_of(format, width, height).c_str());
  gst_video_info_from_caps(&info, caps);
  gst_caps_unref(caps);
  return info;
}

/// A buffer of any 8-bit format that shows a grey picture.
inline Owned<GstBuffer> buffer_of(const Picture& picture, const GstVideoInfo& info) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  gst_buffer_memset(buffer, 0, 128, GST_VIDEO_INFO_SIZE(&info));
  GstVideoFrame frame;
  gst_video_frame_map(&frame, &info, buffer, GST_MAP_WRITE);
  const guint components = GST_VIDEO_FORMAT_INFO_IS_RGB(info.finfo) ? 3 : 1;
  for (guint c = 0; c < components; ++c) {
    for (int y = 0; y < picture.height; ++y) {
      auto* row = static_cast<guint8*>(GST_VIDEO_FRAME_COMP_DATA(&frame, c)) +
                  std::ptrdiff_t{y} * GST_VIDEO_FRAME_COMP_STRIDE(&frame, c);
      for (int x = 0; x < picture.width; ++x) {
        row[x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c)] = picture.view().row(y)[x];
      }
    }
  }
  gst_video_frame_unmap(&frame);
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = GST_SECOND / 30;
  return Owned<GstBuffer>(buffer);
}

inline Owned<GstBuffer> gray_buffer_of(const Picture& picture) {
  return buffer_of(picture, info_of("GRAY8", picture.width, picture.height));
}

/// The first component of a buffer, its luma or a colour of a grey picture.
inline Picture picture_of(GstBuffer* buffer, const GstVideoInfo& info) {
  Picture picture(GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info));
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

/// One message of a type from an element that has a bus of its own, or nothing.
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

/// Runs a pipeline until EOS or an error. @return the error's text, empty where it came to EOS.
inline std::string run_pipeline(const std::string& description,
                                const std::function<void(GstElement*)>& prepare = {}) {
  GError* error = nullptr;
  Owned<GstElement> pipeline(gst_parse_launch(description.c_str(), &error));
  if (error != nullptr) {
    std::string text = error->message;
    g_error_free(error);
    return text;
  }
  if (prepare) prepare(pipeline.get());
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline.get());
  Owned<GstMessage> message(gst_bus_timed_pop_filtered(
      bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
  std::string text = message ? "" : "timed out";
  if (message && GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message.get(), &error, nullptr);
    text = error->message;
    g_error_free(error);
  }
  gst_object_unref(bus);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return text;
}

/// The lines of an NDJSON file, parsed; fails to a null root where a line is no JSON.
inline std::vector<Owned<JsonParser>> read_ndjson(const std::string& file) {
  std::vector<Owned<JsonParser>> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    Owned<JsonParser> parser(json_parser_new());
    json_parser_load_from_data(parser.get(), line.c_str(), -1, nullptr);
    lines.push_back(std::move(parser));
  }
  return lines;
}

inline JsonObject* object_of(const Owned<JsonParser>& line) {
  JsonNode* root = json_parser_get_root(line.get());
  return root != nullptr ? json_node_get_object(root) : nullptr;
}

/// A file name in a folder of its own, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    gchar* path = g_dir_make_tmp("gst-ellipse-XXXXXX", nullptr);
    path_ = path;
    g_free(path);
  }
  ~TemporaryFolder() {
    const std::string command = "rm -rf '" + path_ + "'";
    if (std::system(command.c_str()) != 0) std::perror("rm");
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace support
