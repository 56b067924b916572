// SPDX-License-Identifier: MIT
#include "examples/live/presets.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "examples/live/json_writer.hpp"
#include "examples/live/ref.hpp"

namespace live {
namespace {

constexpr std::size_t kLongestName = 64;

std::vector<std::string> names_of(GstElement* tracker) {
  gchar** names = gst_preset_get_preset_names(GST_PRESET(tracker));
  std::vector<std::string> result;
  for (gchar** name = names; name != nullptr && *name != nullptr; ++name) result.push_back(*name);
  g_strfreev(names);
  return result;
}

// It becomes the name of a group in a key file.
void check_name(const std::string& name) {
  const bool is_odd = name.empty() || name.size() > kLongestName || name.starts_with('_') ||
                      !g_utf8_validate(name.data(), static_cast<gssize>(name.size()), nullptr) ||
                      std::any_of(name.begin(), name.end(), [](unsigned char c) {
                        return c < 0x20 || c == 0x7f || c == '[' || c == ']' || c == '/';
                      });
  if (is_odd) throw std::invalid_argument("a preset cannot have the name \"" + name + "\"");
}

void check_exists(GstElement* tracker, const std::string& name) {
  const std::vector<std::string> names = names_of(tracker);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw std::invalid_argument("there is no preset \"" + name + "\"");
}

// Presets that came with the plugin, or with the system, are read and stay as they are.
bool is_own(const std::string& name) {
  const Ref<gchar> file(g_build_filename(
      g_get_user_data_dir(), "gstreamer-1.0", "presets", "GstEllipseTrack.prs", nullptr));
  GKeyFile* keys = g_key_file_new();
  const bool is_there = g_key_file_load_from_file(keys, file.get(), G_KEY_FILE_NONE, nullptr) &&
                        g_key_file_has_group(keys, name.c_str());
  g_key_file_unref(keys);
  return is_there;
}

}  // namespace

std::string presets_json(GstElement* tracker) {
  JsonWriter json;
  json.begin_array();
  for (const std::string& name : names_of(tracker)) {
    gchar* comment = nullptr;
    gst_preset_get_meta(GST_PRESET(tracker), name.c_str(), "comment", &comment);
    const Ref<gchar> owned(comment);
    json.begin_object()
        .member("name", name)
        .member("comment", comment != nullptr ? comment : "")
        .member("is_own", is_own(name))
        .end_object();
  }
  return json.end_array().text() + "\n";
}

void save_preset(GstElement* tracker, const std::string& name) {
  check_name(name);
  if (!gst_preset_save_preset(GST_PRESET(tracker), name.c_str())) {
    throw std::runtime_error("the preset \"" + name + "\" cannot be written");
  }
}

void load_preset(GstElement* tracker, const std::string& name) {
  check_exists(tracker, name);
  if (!gst_preset_load_preset(GST_PRESET(tracker), name.c_str())) {
    throw std::invalid_argument("the values of the preset \"" + name + "\" do not fit together");
  }
}

void delete_preset(GstElement* tracker, const std::string& name) {
  check_exists(tracker, name);
  if (!is_own(name)) throw std::invalid_argument("the preset \"" + name + "\" is not yours");
  if (!gst_preset_delete_preset(GST_PRESET(tracker), name.c_str())) {
    throw std::runtime_error("the preset \"" + name + "\" cannot be deleted");
  }
}

}  // namespace live
