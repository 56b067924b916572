// SPDX-License-Identifier: MIT
#include "examples/live/http/page_files.hpp"

#include <gio/gio.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "examples/live/ref.hpp"

namespace live {
namespace {

struct Type {
  std::string_view extension;
  const char* type;
};

constexpr std::array kTypes = {
    Type{".html", "text/html; charset=utf-8"},
    Type{".css", "text/css; charset=utf-8"},
    Type{".js", "text/javascript; charset=utf-8"},
    Type{".mjs", "text/javascript; charset=utf-8"},
    Type{".svg", "image/svg+xml"},
    Type{".png", "image/png"},
    Type{".json", "application/json"},
    Type{".txt", "text/plain; charset=utf-8"},
    Type{".md", "text/plain; charset=utf-8"},
};

const char* type_of(std::string_view name) {
  for (const Type& type : kTypes) {
    if (name.ends_with(type.extension)) return type.type;
  }
  return nullptr;
}

bool is_plain_name(std::string_view name) {
  return !name.empty() && !name.starts_with('.') &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return g_ascii_isalnum(c) || c == '.' || c == '-' || c == '_';
         });
}

}  // namespace

std::optional<std::string> PageFiles::content(const std::string& name) const {
  if (folder_.empty()) {
    const Ref<GBytes> bytes(g_resources_lookup_data(
        ("/org/gst-ellipse/live/" + name).c_str(), G_RESOURCE_LOOKUP_FLAGS_NONE, nullptr));
    if (!bytes) return std::nullopt;
    gsize size = 0;
    const auto* data = static_cast<const char*>(g_bytes_get_data(bytes.get(), &size));
    return std::string(data, size);
  }
  const std::filesystem::path file = std::filesystem::path(folder_) / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, ignored))) {
    return std::nullopt;
  }
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

Reply PageFiles::get(const std::string& name) const {
  const char* type = type_of(name);
  if (type == nullptr || !is_plain_name(name)) return error_reply(404, "no such file");
  std::optional<std::string> bytes = content(name);
  if (!bytes) return error_reply(404, "no such file");
  return {.type = type, .body = std::move(*bytes)};
}

}  // namespace live
