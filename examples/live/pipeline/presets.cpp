// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/presets.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "examples/live/json_writer.hpp"
#include "examples/live/ref.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxNameLength = 64;
constexpr char kOrigin[] = "origin";
constexpr char kOwn[] = "ellipse-live";

std::vector<std::string> names_of(GstElement* tracker) {
  gchar** names = gst_preset_get_preset_names(GST_PRESET(tracker));
  std::vector<std::string> result;
  for (gchar** name = names; name != nullptr && *name != nullptr; ++name) result.push_back(*name);
  g_strfreev(names);
  return result;
}

// The name becomes a group name in a key file.
void check_name(const std::string& name) {
  const bool is_invalid =
      name.empty() || name.size() > kMaxNameLength || name.starts_with('_') ||
      !g_utf8_validate(name.data(), static_cast<gssize>(name.size()), nullptr) ||
      std::any_of(name.begin(), name.end(), [](unsigned char c) {
        return c < 0x20 || c == 0x7f || c == '[' || c == ']' || c == '/';
      });
  if (is_invalid) throw std::invalid_argument("invalid preset name \"" + name + "\"");
}

void check_exists(GstElement* tracker, const std::string& name) {
  const std::vector<std::string> names = names_of(tracker);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw std::invalid_argument("no such preset: \"" + name + "\"");
}

// GStreamer copies system presets into the user's file, so only this metadata identifies presets
// created here.
bool is_own(GstElement* tracker, const std::string& name) {
  gchar* origin = nullptr;
  gst_preset_get_meta(GST_PRESET(tracker), name.c_str(), kOrigin, &origin);
  const Ref<gchar> owned(origin);
  return g_strcmp0(origin, kOwn) == 0;
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
        .member("is_own", is_own(tracker, name))
        .end_object();
  }
  return json.end_array().text() + "\n";
}

void save_preset(GstElement* tracker, const std::string& name) {
  check_name(name);
  const std::vector<std::string> names = names_of(tracker);
  const bool is_there = std::find(names.begin(), names.end(), name) != names.end();
  if (is_there && !is_own(tracker, name)) {
    throw std::invalid_argument("the preset \"" + name +
                                "\" was not created by ellipse-live: choose another name");
  }
  if (!gst_preset_save_preset(GST_PRESET(tracker), name.c_str()) ||
      !gst_preset_set_meta(GST_PRESET(tracker), name.c_str(), kOrigin, kOwn)) {
    throw std::runtime_error("the preset \"" + name + "\" cannot be written");
  }
}

void load_preset(GstElement* tracker, const std::string& name) {
  check_exists(tracker, name);
  if (!gst_preset_load_preset(GST_PRESET(tracker), name.c_str())) {
    throw std::invalid_argument("the values of the preset \"" + name + "\" are inconsistent");
  }
}

void delete_preset(GstElement* tracker, const std::string& name) {
  check_exists(tracker, name);
  if (!is_own(tracker, name)) {
    throw std::invalid_argument("the preset \"" + name + "\" was not created by ellipse-live");
  }
  if (!gst_preset_delete_preset(GST_PRESET(tracker), name.c_str())) {
    throw std::runtime_error("the preset \"" + name + "\" cannot be deleted");
  }
}

}  // namespace live
