// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/folder_source.hpp"

#include <gst/gst.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "examples/live/ref.hpp"

namespace live {
namespace {

namespace fs = std::filesystem;

// Temporary folder of links named 000001.png, 000002.png ..., for imagesequencesrc. Numbers start
// at 1 because imagesequencesrc 1.22 does not stop at stop-index 0.
class NumberedFolder {
 public:
  NumberedFolder() {
    const Ref<gchar> path(g_dir_make_tmp("ellipse-live-XXXXXX", nullptr));
    if (!path) throw std::runtime_error("cannot create a temporary folder");
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

// The pictures of the more frequent type (.png or .jpg), in natural order of their names: 9 before
// 10.
std::vector<fs::path> pictures_in(const std::string& text) {
  std::map<std::string, std::vector<fs::path>> by_extension;
  for (const fs::directory_entry& entry : fs::directory_iterator(text)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), g_ascii_tolower);
    if (extension == ".jpeg") extension = ".jpg";
    if (extension == ".png" || extension == ".jpg") by_extension[extension].push_back(entry.path());
  }
  if (by_extension.empty()) {
    throw std::invalid_argument("source \"" + text + "\": no .png or .jpg in this folder");
  }
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

/* Patterns for imagesequencesrc */

struct Numbered {
  std::string pattern;  // path with one %d or %06d
  std::size_t first = 1;
};

std::string source_of(const Numbered& pictures, std::size_t count, bool is_png, FrameRate rate) {
  return "imagesequencesrc framerate=" + std::to_string(rate.n) + "/" + std::to_string(rate.d) +
         " start-index=" + std::to_string(pictures.first) +
         " stop-index=" + std::to_string(pictures.first + count - 1) +
         " location=" + quoted(pictures.pattern) + (is_png ? " ! pngdec" : " ! jpegdec");
}

std::string with_percents(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '%' ? std::string("%%") : std::string(1, c);
  return result;
}

// The last run of digits in the name, as [begin, end).
std::pair<std::size_t, std::size_t> number_in(const std::string& name) {
  std::size_t end = name.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) == 0) --end;
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  return {begin, end};
}

// Whether the names differ only in their number, and the numbers are consecutive.
bool are_numbered(const std::vector<fs::path>& pictures, std::size_t first, int digits) {
  const std::string name = pictures.front().filename();
  const auto [begin, end] = number_in(name);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    std::array<char, 32> number;
    std::snprintf(number.data(), number.size(), "%0*zu", digits, first + i);
    if (pictures[i].filename() != name.substr(0, begin) + number.data() + name.substr(end)) {
      return false;
    }
  }
  return true;
}

// The pattern of the file names; nullopt if imagesequencesrc cannot read them by a pattern.
std::optional<Numbered> pattern_of(const std::vector<fs::path>& pictures) {
  constexpr std::size_t kMaxDigits = 9;
  const std::string name = pictures.front().filename();
  const auto [begin, end] = number_in(name);
  if (begin == end || end - begin > kMaxDigits) return std::nullopt;
  const std::size_t first = std::stoul(name.substr(begin, end - begin));
  const bool stops = first + pictures.size() > 1;  // see NumberedFolder
  for (const int digits : {1, static_cast<int>(end - begin)}) {
    if (!stops || !are_numbered(pictures, first, digits)) continue;
    const std::string number = digits == 1 ? "%d" : "%0" + std::to_string(digits) + "d";
    const fs::path folder = fs::absolute(pictures.front()).parent_path();
    return Numbered{with_percents((folder / name.substr(0, begin)).string()) + number +
                        with_percents(name.substr(end)),
                    first};
  }
  return std::nullopt;
}

// Shell commands that create links with numbered names in a temporary folder and change to it.
std::string linking(const fs::path& folder, bool is_png) {
  const Ref<gchar> where(g_shell_quote(fs::absolute(folder).lexically_normal().c_str()));
  const std::string names = is_png ? "-iname '*.png'" : "'(' -iname '*.jpg' -o -iname '*.jpeg' ')'";
  return "cd \"$(mktemp -d)\" && find " + std::string(where.get()) + " -maxdepth 1 " + names +
         " | sort -V | (n=0; while IFS= read -r file; do n=$((n + 1)); ln -s \"$file\" "
         "\"$(printf %06d $n)" +
         (is_png ? ".png" : ".jpg") + "\"; done)";
}

}  // namespace

SourceSpec folder_source(const std::string& text, FrameRate rate) {
  const std::vector<fs::path> pictures = pictures_in(text);
  const bool is_png = g_ascii_strcasecmp(pictures.front().extension().c_str(), ".png") == 0;
  const std::string extension = is_png ? ".png" : ".jpg";
  const auto folder = std::make_shared<NumberedFolder>();
  for (std::size_t i = 0; i < pictures.size(); ++i) folder->add(i + 1, pictures[i], extension);
  SourceSpec spec{.kind = SourceKind::kFolder, .text = text};
  const auto source = [&](const Numbered& numbered) {
    return source_of(numbered, pictures.size(), is_png, rate);
  };
  spec.description = source({(folder->path() / ("%06d" + extension)).string()});
  if (const std::optional<Numbered> own = pattern_of(pictures)) {
    spec.launch = source(*own);
  } else {
    spec.launch = source({"%06d" + extension});
    spec.preparation = linking(text, is_png);
  }
  spec.numbered = std::shared_ptr<const fs::path>(folder, &folder->path());
  return spec;
}

}  // namespace live
