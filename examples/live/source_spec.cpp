// SPDX-License-Identifier: MIT
#include "examples/live/source_spec.hpp"

#include <glib/gstdio.h>
#include <gst/gst.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <vector>

#include "examples/live/ref.hpp"

namespace live {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument("source \"" + text + "\": " + why);
}

// As a value in a gst-launch line.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
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
    refuse(text, "there is no such scene; there are " + scene_names(scenes));
  }
  return "ellipsetestsrc is-live=true scene=" + scene;
}

void check_readable(const std::string& text, const std::string& path, const std::string& what) {
  if (!fs::exists(path)) refuse(text, "there is no such " + what);
  if (access(path.c_str(), R_OK) != 0) refuse(text, "this " + what + " may not be read");
}

// So that an extension finds its pictures whatever their names: 000001.png, 000002.png ...
// Not from 0: imagesequencesrc 1.22 does not stop behind a stop-index of 0.
class NumberedFolder {
 public:
  NumberedFolder() {
    const Ref<gchar> path(g_dir_make_tmp("ellipse-live-XXXXXX", nullptr));
    if (!path) throw std::runtime_error("a temporary folder cannot be made");
    path_ = path.get();
  }
  ~NumberedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  NumberedFolder(const NumberedFolder&) = delete;
  NumberedFolder& operator=(const NumberedFolder&) = delete;

  void add(std::size_t number, const fs::path& picture, const std::string& extension) const {
    std::array<char, 32> name;
    std::snprintf(name.data(), name.size(), "%06zu", number);
    fs::create_symlink(fs::absolute(picture), path_ / (name.data() + extension));
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// The pictures of the kind that most of them are, in the order of their names, 9 before 10.
std::vector<fs::path> pictures_in(const std::string& text) {
  std::map<std::string, std::vector<fs::path>> by_extension;
  for (const fs::directory_entry& entry : fs::directory_iterator(text)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), g_ascii_tolower);
    if (extension == ".jpeg") extension = ".jpg";
    if (extension == ".png" || extension == ".jpg") by_extension[extension].push_back(entry.path());
  }
  if (by_extension.empty()) refuse(text, "there is no .png and no .jpg in this folder");
  auto& pictures =
      std::max_element(by_extension.begin(), by_extension.end(), [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
      })->second;
  std::sort(pictures.begin(), pictures.end(), [](const fs::path& a, const fs::path& b) {
    const Ref<gchar> left(g_utf8_collate_key_for_filename(a.filename().c_str(), -1));
    const Ref<gchar> right(g_utf8_collate_key_for_filename(b.filename().c_str(), -1));
    return std::string_view(left.get()) < std::string_view(right.get());
  });
  return pictures;
}

SourceSpec folder_source(const std::string& text) {
  const std::vector<fs::path> pictures = pictures_in(text);
  const bool is_png = pictures.front().extension().string().ends_with("ng") ||
                      pictures.front().extension().string().ends_with("NG");
  const std::string extension = is_png ? ".png" : ".jpg";
  const auto folder = std::make_shared<NumberedFolder>();
  for (std::size_t i = 0; i < pictures.size(); ++i) folder->add(i + 1, pictures[i], extension);
  SourceSpec spec{.kind = SourceKind::kFolder, .text = text};
  spec.description = "imagesequencesrc framerate=30/1 start-index=1 stop-index=" +
                     std::to_string(pictures.size()) +
                     " location=" + quoted((folder->path() / ("%06d" + extension)).string()) +
                     (is_png ? " ! pngdec" : " ! jpegdec");
  spec.numbered = std::shared_ptr<const fs::path>(folder, &folder->path());
  return spec;
}

SourceSpec uri_source(const std::string& text) {
  SourceSpec spec{.kind = SourceKind::kUri, .text = text};
  const Ref<gchar> scheme(g_uri_parse_scheme(text.c_str()));
  if (!scheme) refuse(text, "is no URI");
  const std::string name = scheme.get();
  if (!gst_uri_protocol_is_supported(GST_URI_SRC, name.c_str())) {
    refuse(text, "nothing that is installed reads " + name + "://");
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
  if (!fs::is_regular_file(text)) refuse(text, "is no file that can be played");
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

SourceSpec parse_source(const std::string& text) {
  if (text.empty()) refuse(text, "is empty");
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
  return fs::is_directory(text) ? folder_source(text) : file_source(text);
}

}  // namespace live
