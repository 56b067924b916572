// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/source_spec.hpp"

#include <gst/gst.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "examples/live/pipeline/folder_source.hpp"
#include "examples/live/ref.hpp"

namespace live {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument("source \"" + text + "\": " + why);
}

std::string scene_names(GEnumClass* scenes) {
  std::string names;
  for (guint i = 0; i < scenes->n_values; ++i) {
    names += (i > 0 ? ", " : "") + std::string(scenes->values[i].value_nick);
  }
  return names;
}

std::string test_description(const std::string& text, const std::string& scene) {
  const Ref<GstElement> element(gst_element_factory_make("ellipsetestsrc", nullptr));
  if (!element) refuse(text, "the element ellipsetestsrc is not installed");
  gst_object_ref_sink(element.get());
  const GParamSpec* property =
      g_object_class_find_property(G_OBJECT_GET_CLASS(element.get()), "scene");
  GEnumClass* scenes = G_PARAM_SPEC_ENUM(property)->enum_class;
  if (g_enum_get_value_by_nick(scenes, scene.c_str()) == nullptr) {
    refuse(text, "no such scene; available: " + scene_names(scenes));
  }
  return "ellipsetestsrc is-live=true scene=" + scene;
}

void check_readable(const std::string& text, const std::string& path, const std::string& what) {
  if (!fs::exists(path)) refuse(text, "no such " + what);
  if (access(path.c_str(), R_OK) != 0) refuse(text, "no permission to read this " + what);
}

SourceSpec uri_source(const std::string& text) {
  SourceSpec spec{.kind = SourceKind::kUri, .text = text};
  const Ref<gchar> scheme(g_uri_parse_scheme(text.c_str()));
  if (!scheme) refuse(text, "not a URI");
  const std::string name = scheme.get();
  if (!gst_uri_protocol_is_supported(GST_URI_SRC, name.c_str())) {
    refuse(text, "no installed element reads " + name + "://");
  }
  spec.is_live = name == "rtsp" || name == "rtsps" || name == "udp" || name == "rtp" ||
                 name == "srt" || name == "tcp";
  spec.description =
      name.starts_with("rtsp")
          ? "rtspsrc latency=50 drop-on-latency=true location=" + quoted(text) +
                " ! application/x-rtp,media=video ! decodebin"
          : "uridecodebin caps=\"video/x-raw(ANY)\" expose-all-streams=false uri=" + quoted(text);
  return spec;
}

SourceSpec file_source(const std::string& text) {
  check_readable(text, text, "file");
  if (!fs::is_regular_file(text)) refuse(text, "not a regular file");
  const Ref<gchar> uri(gst_filename_to_uri(text.c_str(), nullptr));
  return {.kind = SourceKind::kFile,
          .text = text,
          .description = "uridecodebin caps=\"video/x-raw(ANY)\" expose-all-streams=false uri=" +
                         quoted(uri.get())};
}

SourceSpec fragment_source(const std::string& text) {
  const std::string inside = text.substr(1, text.size() - 2);
  GError* problem = nullptr;
  const Ref<GstElement> bin(gst_parse_bin_from_description_full(
      (inside + " ! videoconvert").c_str(), FALSE, nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &problem));
  const Ref<GError> error(problem);
  if (bin) gst_object_ref_sink(bin.get());
  if (error) refuse(text, error->message);
  return {.kind = SourceKind::kFragment, .text = text, .description = inside};
}

}  // namespace

const char* nick_of(SourceKind kind) {
  switch (kind) {
    case SourceKind::kTest:
      return "test";
    case SourceKind::kFile:
      return "file";
    case SourceKind::kDevice:
      return "device";
    case SourceKind::kUri:
      return "uri";
    case SourceKind::kFolder:
      return "folder";
    case SourceKind::kFragment:
      return "fragment";
  }
  return "unknown";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

FrameRate parse_rate(const std::string& text) {
  constexpr double kFastest = 1000.0;
  FrameRate rate{.n = 0, .d = 1};
  const char* end = text.data() + text.size();
  const auto whole = std::from_chars(text.data(), end, rate.n);
  if (whole.ec == std::errc{} && whole.ptr != end && *whole.ptr == '/') {
    const auto part = std::from_chars(whole.ptr + 1, end, rate.d);
    if (part.ec != std::errc{} || part.ptr != end) rate.n = 0;
  } else {
    double number = 0.0;
    const auto all = std::from_chars(text.data(), end, number);
    const bool is_one =
        all.ec == std::errc{} && all.ptr == end && number > 0.0 && number <= kFastest;
    rate = {.n = 0, .d = 1};
    if (is_one) gst_util_double_to_fraction(number, &rate.n, &rate.d);
  }
  if (rate.n > 0 && rate.d > 0 && rate.n <= kFastest * rate.d) return rate;
  throw std::invalid_argument("\"" + text + "\" is not a frame rate such as 10 or 30000/1001");
}

SourceSpec parse_source(const std::string& text, std::optional<FrameRate> rate) {
  if (text.empty()) refuse(text, "empty");
  std::error_code ignored;  // unreadable paths are reported below
  const bool is_folder = text.find("://") == std::string::npos && fs::is_directory(text, ignored);
  if (rate && !is_folder) refuse(text, "a frame rate applies to a folder of pictures only");
  if (text.starts_with('[') && text.ends_with(']')) return fragment_source(text);
  if (text.starts_with("test:")) {
    return {.kind = SourceKind::kTest,
            .text = text,
            .description = test_description(text, text.substr(5)),
            .is_live = true};
  }
  if (text.starts_with("/dev/")) {
    check_readable(text, text, "camera");
    return {.kind = SourceKind::kDevice,
            .text = text,
            .description = "v4l2src device=" + quoted(text) + " ! decodebin",
            .is_live = true};
  }
  if (text.find("://") != std::string::npos) return uri_source(text);
  check_readable(text, text, "file or folder");
  return is_folder ? folder_source(text, rate.value_or(FrameRate{})) : file_source(text);
}

}  // namespace live
